#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <torch/torch.h>

#include "train/distributed/collectives.hpp"
#include "train/distributed/process_place.hpp"

namespace alight {

/// The processes that train together. All members are called by all of them in the same order; in a group of one they
/// do nothing. Those that talk to the others throw DataError when one of them is gone or does not answer in time.
/// Copies speak for the same process.
class ProcessGroup {
 public:
  /// A group of one.
  ProcessGroup() = default;
  ProcessGroup(ProcessPlace place, std::shared_ptr<Collectives> collectives);

  /// The group of read_process_place(). @param timeout the longest wait for another process
  /// @throws ConfigError as read_process_place and connect, DataError if somebody does not come
  static ProcessGroup from_environment(bool cuda, std::chrono::seconds timeout);

  int rank() const { return place_.rank; }
  int size() const { return place_.size; }
  const ProcessPlace& place() const { return place_; }

  /// In place, on any device and of any types; undefined tensors are left out, by all alike.
  void all_reduce_sum(const std::vector<torch::Tensor>& tensors) const;
  void all_reduce_mean(const std::vector<torch::Tensor>& tensors) const;
  /// Replaces the values by those of rank 0.
  void broadcast(const std::vector<torch::Tensor>& tensors) const;
  /// Returns when all have come here.
  void barrier() const;

  std::vector<double> mean(const std::vector<double>& values) const;
  double of_first_rank(double value) const;

  /// @throws DataError if rank 0 has another value. @param what names it in the message
  void expect_same(const std::string& what, std::int64_t value) const;

  /// Runs `work` on rank 0 while the others wait, longer than the timeout if need be: `work` calls what it is given
  /// again and again, more often than the timeout, and then they know that it lives.
  void on_first_rank(const std::function<void(const std::function<void()>& alive)>& work) const;

 private:
  template <class Operation>
  void exchange(const std::vector<torch::Tensor>& tensors, const char* what, Operation operation) const;

  ProcessPlace place_;
  std::shared_ptr<Collectives> collectives_;
};

}  // namespace alight
