#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include <sys/types.h>

#include "train/train_config.hpp"

namespace alight::test {

/// Writes a data set of one flight: stereo views of a few blocks on the ground, 40 x 40 pixels.
void write_tiny_dataset(const std::filesystem::path& dir, int samples);

/// A few steps of a tiny network with batch normalisation, augmentation and everything that draws lots.
TrainConfig tiny_run_config(const std::filesystem::path& dataset);

/// alight-train as process `rank` of two.
class RankProcess {
 public:
  /// @param arguments of alight-train, separated by spaces @param log where stdout and stderr go
  RankProcess(int rank, int port, const std::string& arguments, const std::filesystem::path& log);
  ~RankProcess();  // ends it if need be
  RankProcess(const RankProcess&) = delete;
  RankProcess& operator=(const RankProcess&) = delete;

  void send(int signal) const;
  /// @returns its exit code; -1 if it still runs then
  int wait(std::chrono::seconds longest);
  std::string said() const;

 private:
  pid_t pid_ = -1;
  std::filesystem::path log_;
};

}  // namespace alight::test
