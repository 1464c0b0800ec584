#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "train/distributed/process_group.hpp"

namespace alight::test {

/// Threads in place of processes.
class ThreadMeeting {
 public:
  explicit ThreadMeeting(int size) : tensors_(static_cast<std::size_t>(size)) {}

  /// Every thread gives a tensor; the last to come makes a result of them all. @returns the result
  torch::Tensor meet(int rank, const torch::Tensor& given,
                     const std::function<torch::Tensor(const std::vector<torch::Tensor>&)>& combine) {
    std::unique_lock<std::mutex> lock(mutex_);
    const int round = round_;
    tensors_[static_cast<std::size_t>(rank)] = given.clone();
    if (++come_ == static_cast<int>(tensors_.size())) {
      result_ = combine(tensors_);
      come_ = 0;
      ++round_;
      all_.notify_all();
    }
    all_.wait(lock, [&] { return round_ != round; });
    return result_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable all_;
  std::vector<torch::Tensor> tensors_;
  torch::Tensor result_;
  int come_ = 0;
  int round_ = 0;
};

class ThreadCollectives : public Collectives {
 public:
  ThreadCollectives(ThreadMeeting& meeting, int rank) : meeting_(meeting), rank_(rank) {}
  torch::Device device() const override { return torch::kCPU; }
  void sum(torch::Tensor& flat) override {
    flat.copy_(meeting_.meet(rank_, flat, [](const auto& all) { return torch::stack(all).sum(0); }));
  }
  void broadcast(torch::Tensor& flat) override {
    flat.copy_(meeting_.meet(rank_, flat, [](const auto& all) { return all.front(); }));
  }

 private:
  ThreadMeeting& meeting_;
  int rank_;
};

/// Runs `body` in `size` threads, each with its place in a group; rethrows what the first of them threw.
inline void in_group(int size, const std::function<void(const ProcessGroup&)>& body) {
  ThreadMeeting meeting(size);
  std::vector<std::exception_ptr> errors(static_cast<std::size_t>(size));
  std::vector<std::thread> threads;
  for (int rank = 0; rank < size; ++rank) {
    threads.emplace_back([&, rank] {
      ProcessPlace place;
      place.rank = rank;
      place.size = size;
      try {
        body(ProcessGroup(place, std::make_shared<ThreadCollectives>(meeting, rank)));
      } catch (...) {
        errors[static_cast<std::size_t>(rank)] = std::current_exception();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace alight::test
