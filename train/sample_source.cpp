#include "train/sample_source.hpp"

namespace alight {

DatasetSource::DatasetSource(const std::filesystem::path& dir, const std::vector<std::string>& flights,
                             bool with_dense)
    : dataset_(dir, DepthDatasetOptions{flights, with_dense}) {}

}  // namespace alight
