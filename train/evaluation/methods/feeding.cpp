#include "train/evaluation/methods/feeding.hpp"

#include <fmt/format.h>

#include "train/data/density_sampling.hpp"

namespace alight {

std::string Feeding::name() const {
  return kind == Kind::kShare ? fmt::format("P={:g}", amount) : fmt::format("{:g} s", amount);
}

std::vector<Feeding> make_feedings(const std::vector<double>& shares, const std::vector<double>& windows_s) {
  std::vector<Feeding> feedings;
  for (const double share : shares) feedings.push_back({Feeding::Kind::kShare, share});
  for (const double window_s : windows_s) feedings.push_back({Feeding::Kind::kWindow, window_s});
  return feedings;
}

torch::Tensor feed(const DepthSample& sample, const Feeding& feeding, std::uint64_t seed) {
  if (feeding.kind == Feeding::Kind::kWindow) {
    return keep_window(sample.sparse, sample.offset_s, 0, torch::tensor(feeding.amount));
  }
  torch::Generator generator = at::detail::createCPUGenerator(seed);
  return keep_share(sample.sparse, torch::tensor(feeding.amount), generator);
}

}  // namespace alight
