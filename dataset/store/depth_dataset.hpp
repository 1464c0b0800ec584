#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <torch/data/datasets/base.h>
#include <torch/types.h>

#include "dataset/store/sample_store.hpp"
#include "foundation/errors.hpp"

namespace alight {

/// One training sample. Images are RGB in 0..1 (a grey log gives three equal channels); H, W of the cropped
/// rig.
struct DepthSample {
  torch::Tensor left;      ///< [3,H,W] float32
  torch::Tensor right;     ///< [3,H,W] float32; zeros if !has_right
  torch::Tensor previous;  ///< [3,H,W] float32, the left image before; zeros if !has_previous
  torch::Tensor next;      ///< [3,H,W] float32, the left image after; zeros if !has_next
  torch::Tensor sparse;    ///< [1,H,W] float32, plane depth in metres of the full window, 0 = missing
  torch::Tensor offset_s;  ///< [1,H,W] float32, t_point - t_image in seconds; 0 where missing
  torch::Tensor dense;  ///< [1,H,W] float32, true plane depth, 0 = none; undefined unless asked for and there
  torch::Tensor
      T_previous_camera;  ///< [4,4] float32, left camera now -> left camera of `previous`; identity if none
  torch::Tensor T_next_camera;  ///< [4,4] float32
  torch::Tensor intrinsics;     ///< [4] float32: fx fy cx cy in pixels
  torch::Tensor
      down_camera;  ///< [3] float32: the world's down in camera coordinates, unit length (the attitude)
  bool has_right = false;
  bool has_previous = false;
  bool has_next = false;
  double baseline_m = 0;   ///< 0: mono
  double height_m = 0;     ///< above take-off, NaN: unknown
  std::int64_t index = 0;  ///< of the dataset
};

/// Which flights are read, and what of each sample.
struct DepthDatasetOptions {
  std::vector<std::string> flights;  ///< names; empty: all
  bool with_dense = false;           ///< evaluation only: the true depth of simulated flights
};

/// The samples of chosen flights, in the order of the flights and of time. Reads from disk at every get(), so
/// that data loader workers share the work; holds only the tables in memory.
class DepthDataset : public torch::data::datasets::Dataset<DepthDataset, DepthSample> {
 public:
  /// @throws DataError if the folder is no data set, a named flight is not in it or there is no sample
  explicit DepthDataset(std::filesystem::path dir, DepthDatasetOptions options = {});

  /// @throws DataError naming the file of a sample that cannot be read
  DepthSample get(std::size_t index) override;
  torch::optional<std::size_t> size() const override { return places_.size(); }

  const DatasetInfo& info() const { return info_; }
  /// Flight and line of a sample, for messages and tables.
  const FlightEntry& flight(std::size_t index) const;
  const SampleRow& row(std::size_t index) const;

 private:
  struct Place {
    std::size_t flight;
    std::size_t row;
  };

  std::filesystem::path dir_;
  DepthDatasetOptions options_;
  DatasetInfo info_;
  std::vector<std::vector<SampleRow>> rows_;  // [flight of info_.flights][line]
  std::vector<Place> places_;                 // [index]
};

/// CV_8UC1 or CV_8UC3 BGR -> [3,H,W] float32 RGB in 0..1.
torch::Tensor image_to_tensor(const cv::Mat& image);
/// [3,H,W] float32 RGB in 0..1 -> CV_8UC3 BGR.
cv::Mat tensor_to_image(const torch::Tensor& image);
/// CV_32FC1 -> [1,H,W] float32 (a copy).
torch::Tensor depth_to_tensor(const cv::Mat& depth_m);
/// [1,H,W] or [H,W] float32 -> CV_32FC1 (a copy).
cv::Mat tensor_to_depth(const torch::Tensor& depth_m);

}  // namespace alight
