#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "train/train_config.hpp"

namespace alight::test {

/// Writes a data set of one flight: stereo views of a few blocks on the ground, 40 x 40 pixels.
void write_tiny_dataset(const std::filesystem::path& dir, int samples);

/// A few steps of a tiny network with batch normalisation, augmentation and everything that draws lots.
TrainConfig tiny_run_config(const std::filesystem::path& dataset);

/// alight-train as process `rank` of two. @param arguments of alight-train, separated by spaces
std::vector<std::string> rank_command(int rank, int port, const std::string& arguments);

}  // namespace alight::test
