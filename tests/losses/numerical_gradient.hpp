#pragma once

#include <functional>
#include <vector>

#include <torch/torch.h>

namespace alight::test {

using Loss = std::function<torch::Tensor(const torch::Tensor&)>;

/// Gradient of a scalar function by autograd.
inline torch::Tensor autograd_gradient(const Loss& loss, const torch::Tensor& x) {
  torch::Tensor leaf = x.detach().clone().requires_grad_(true);
  loss(leaf).backward();
  return leaf.grad();
}

/// Gradient of a scalar function by central differences, float64.
inline torch::Tensor central_differences(const Loss& loss, const torch::Tensor& x, double step = 1e-6) {
  torch::NoGradGuard no_grad;
  torch::Tensor gradient = torch::zeros_like(x);
  for (std::int64_t i = 0; i < x.numel(); ++i) {
    torch::Tensor above = x.clone();
    torch::Tensor below = x.clone();
    above.view(-1)[i] += step;
    below.view(-1)[i] -= step;
    gradient.view(-1)[i] = (loss(above) - loss(below)) / (2 * step);
  }
  return gradient;
}

/// Largest difference of the two, relative to the largest gradient.
inline double gradient_error(const Loss& loss, const torch::Tensor& x) {
  const torch::Tensor expected = central_differences(loss, x);
  return ((autograd_gradient(loss, x) - expected).abs().max() / expected.abs().max()).item<double>();
}

/// [1,1,rows,columns] float64 from a list, row by row.
inline torch::Tensor map64(std::vector<double> values, std::int64_t rows) {
  return torch::tensor(values, torch::kFloat64).view({1, 1, rows, -1});
}

}  // namespace alight::test
