#include "train/distributed/process_group.hpp"

#include <map>
#include <utility>

#include "foundation/errors.hpp"

namespace alight {
namespace {

constexpr std::chrono::seconds kSignOfLife{1};

[[noreturn]] void fail(const ProcessPlace& place, const std::string& what, const std::exception& e) {
  const std::string cause = e.what();  // torch appends a stack trace, line by line
  throw DataError(
      "process " + std::to_string(place.rank) + " of " + std::to_string(place.size) + ": " + what +
      " failed, another process is gone or does not answer (" + cause.substr(0, cause.find('\n')) +
      "); see what the others say, start all anew, and go on from the last checkpoint with --resume");
}

/// @returns [N] on `device`
torch::Tensor flatten(const std::vector<torch::Tensor>& tensors, torch::Device device) {
  std::vector<torch::Tensor> parts;
  for (const torch::Tensor& tensor : tensors) parts.push_back(tensor.detach().reshape(-1));
  return torch::cat(parts).to(device);
}

void unflatten(const torch::Tensor& flat, const std::vector<torch::Tensor>& tensors) {
  std::int64_t begin = 0;
  for (const torch::Tensor& tensor : tensors) {
    tensor.detach().copy_(flat.narrow(0, begin, tensor.numel()).view(tensor.sizes()));
    begin += tensor.numel();
  }
}

}  // namespace

ProcessGroup::ProcessGroup(ProcessPlace place, std::shared_ptr<Collectives> collectives)
    : place_(std::move(place)), collectives_(std::move(collectives)) {}

ProcessGroup ProcessGroup::from_environment(bool cuda, std::chrono::seconds timeout) {
  const ProcessPlace place = read_process_place();
  if (place.size == 1) return {};
  try {
    return {place, connect(place, cuda, timeout)};
  } catch (const ConfigError&) {
    throw;
  } catch (const std::exception& e) {
    fail(place, "meeting at " + place.master_address + ":" + std::to_string(place.master_port), e);
  }
}

/// One exchange a type: few long messages are much faster than many short ones.
template <class Operation>
void ProcessGroup::exchange(const std::vector<torch::Tensor>& tensors, const char* what,
                            Operation operation) const {
  if (size() == 1) return;
  std::map<torch::ScalarType, std::vector<torch::Tensor>> of_type;
  for (const torch::Tensor& tensor : tensors) {
    if (tensor.defined()) of_type[tensor.scalar_type()].push_back(tensor);
  }
  const torch::NoGradGuard no_grad;
  for (const auto& [type, members] : of_type) {
    torch::Tensor flat = flatten(members, collectives_->device());
    try {
      operation(flat);
    } catch (const std::exception& e) {
      fail(place_, what, e);
    }
    unflatten(flat, members);
  }
}

void ProcessGroup::all_reduce_sum(const std::vector<torch::Tensor>& tensors) const {
  exchange(tensors, "adding up with the others", [&](torch::Tensor& flat) { collectives_->sum(flat); });
}

void ProcessGroup::all_reduce_mean(const std::vector<torch::Tensor>& tensors) const {
  exchange(tensors, "averaging with the others", [&](torch::Tensor& flat) {
    collectives_->sum(flat);
    flat.div_(size());
  });
}

void ProcessGroup::broadcast(const std::vector<torch::Tensor>& tensors) const {
  exchange(tensors, "hearing from process 0", [&](torch::Tensor& flat) { collectives_->broadcast(flat); });
}

void ProcessGroup::barrier() const { mean({0}); }

std::vector<double> ProcessGroup::mean(const std::vector<double>& values) const {
  const torch::Tensor tensor = torch::tensor(values, torch::kFloat64);
  all_reduce_mean({tensor});
  const double* first = tensor.data_ptr<double>();
  return {first, first + values.size()};
}

double ProcessGroup::of_first_rank(double value) const {
  const torch::Tensor tensor = torch::full({}, value, torch::kFloat64);
  broadcast({tensor});
  return tensor.item<double>();
}

void ProcessGroup::expect_same(const std::string& what, std::int64_t value) const {
  const torch::Tensor first = torch::full({}, value, torch::kInt64);
  broadcast({first});
  if (first.item<std::int64_t>() == value) return;
  throw DataError("process " + std::to_string(rank()) + " of " + std::to_string(size()) + ": " + what +
                  " is " + std::to_string(value) + " here and " + std::to_string(first.item<std::int64_t>()) +
                  " for process 0; give all the same configuration, data set and run folder");
}

void ProcessGroup::on_first_rank(const std::function<void(const std::function<void()>& alive)>& work) const {
  using Clock = std::chrono::steady_clock;
  if (rank() > 0) {
    while (of_first_rank(0) > 0) {
    }
    return;
  }
  Clock::time_point last = Clock::now();
  work([&] {
    if (Clock::now() - last < kSignOfLife) return;
    of_first_rank(1);
    last = Clock::now();
  });
  of_first_rank(0);
}

}  // namespace alight
