#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "dataset/depth_dataset.hpp"

namespace alight {

/// Where training and validation get their samples.
class SampleSource {
 public:
  virtual ~SampleSource() = default;
  virtual std::size_t size() const = 0;
  /// Called from several threads at once. @throws DataError naming the file
  virtual DepthSample get(std::size_t index) = 0;
  /// The world's down in camera coordinates, unit length: the attitude, for the altitude plane.
  virtual Eigen::Vector3d down_camera(std::size_t index) const = 0;
};

/// Samples of chosen flights of a data set on disk.
class DatasetSource : public SampleSource {
 public:
  /// @param with_dense for evaluation only. @throws DataError as DepthDataset
  DatasetSource(const std::filesystem::path& dir, const std::vector<std::string>& flights, bool with_dense);
  std::size_t size() const override { return *dataset_.size(); }
  DepthSample get(std::size_t index) override { return dataset_.get(index); }
  Eigen::Vector3d down_camera(std::size_t index) const override;
  const DepthDataset& dataset() const { return dataset_; }

 private:
  DepthDataset dataset_;
};

}  // namespace alight
