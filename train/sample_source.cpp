#include "train/sample_source.hpp"

namespace alight {

DatasetSource::DatasetSource(const std::filesystem::path& dir, const std::vector<std::string>& flights,
                             bool with_dense)
    : dataset_(dir, DepthDatasetOptions{flights, with_dense}) {}

Eigen::Vector3d DatasetSource::down_camera(std::size_t index) const {
  return dataset_.row(index).T_world_camera.linear().transpose() * -Eigen::Vector3d::UnitZ();
}

}  // namespace alight
