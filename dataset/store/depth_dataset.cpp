#include "dataset/store/depth_dataset.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "foundation/errors.hpp"

namespace alight {
namespace {

torch::Tensor transform_to_tensor(const Eigen::Isometry3d& T) {
  const Eigen::Matrix<float, 4, 4, Eigen::RowMajor> values = T.matrix().cast<float>();
  return torch::from_blob(const_cast<float*>(values.data()), {4, 4}, torch::kFloat32).clone();
}

std::vector<std::size_t> chosen_flights(const DatasetInfo& info, const std::vector<std::string>& names,
                                        const std::string& dir) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; names.empty() && i < info.flights.size(); ++i) chosen.push_back(i);
  for (const std::string& name : names) {
    const auto found = std::find_if(info.flights.begin(), info.flights.end(),
                                    [&](const FlightEntry& flight) { return flight.name == name; });
    if (found == info.flights.end()) {
      std::string known;
      for (const FlightEntry& flight : info.flights) known += (known.empty() ? "" : ", ") + flight.name;
      throw DataError(dir + ": has no flight \"" + name + "\"; it has " + known);
    }
    chosen.push_back(static_cast<std::size_t>(found - info.flights.begin()));
  }
  return chosen;
}

}  // namespace

torch::Tensor image_to_tensor(const cv::Mat& image) {
  if (image.type() != CV_8UC1 && image.type() != CV_8UC3) {
    throw std::invalid_argument("image_to_tensor: expected CV_8UC1 or CV_8UC3");
  }
  torch::Tensor tensor = torch::empty({3, image.rows, image.cols}, torch::kFloat32);
  auto* out = tensor.data_ptr<float>();
  const std::int64_t plane = static_cast<std::int64_t>(image.rows) * image.cols;
  const int channels = image.channels();
  for (int v = 0; v < image.rows; ++v) {
    const std::uint8_t* row = image.ptr<std::uint8_t>(v);
    for (int u = 0; u < image.cols; ++u, ++out) {
      for (int c = 0; c < 3; ++c) {
        out[c * plane] =
            static_cast<float>(row[u * channels + (channels == 3 ? 2 - c : 0)]) * (1.0F / 255.0F);
      }
    }
  }
  return tensor;
}

cv::Mat tensor_to_image(const torch::Tensor& image) {
  if (image.dim() != 3 || image.size(0) != 3 || image.scalar_type() != torch::kFloat32) {
    throw std::invalid_argument("tensor_to_image: expected [3,H,W] float32");
  }
  const torch::Tensor bytes = (image.detach().cpu() * 255).round().clamp(0, 255).to(torch::kUInt8);
  const torch::Tensor packed = bytes.flip(0).permute({1, 2, 0}).contiguous();
  return cv::Mat(static_cast<int>(packed.size(0)), static_cast<int>(packed.size(1)), CV_8UC3,
                 packed.data_ptr<std::uint8_t>())
      .clone();
}

torch::Tensor depth_to_tensor(const cv::Mat& depth_m) {
  if (depth_m.type() != CV_32FC1) throw std::invalid_argument("depth_to_tensor: expected CV_32FC1");
  torch::Tensor tensor = torch::empty({1, depth_m.rows, depth_m.cols}, torch::kFloat32);
  depth_m.copyTo(cv::Mat(depth_m.size(), CV_32FC1, tensor.data_ptr<float>()));
  return tensor;
}

cv::Mat tensor_to_depth(const torch::Tensor& depth_m) {
  const torch::Tensor map = depth_m.dim() == 3 ? depth_m.squeeze(0) : depth_m;
  if (map.dim() != 2 || map.scalar_type() != torch::kFloat32) {
    throw std::invalid_argument("tensor_to_depth: expected [1,H,W] or [H,W] float32");
  }
  const torch::Tensor packed = map.detach().cpu().contiguous();
  return cv::Mat(static_cast<int>(packed.size(0)), static_cast<int>(packed.size(1)), CV_32FC1,
                 packed.data_ptr<float>())
      .clone();
}

DepthDataset::DepthDataset(std::filesystem::path dir, DepthDatasetOptions options)
    : dir_(std::move(dir)),
      options_(std::move(options)),
      info_(read_dataset_info(dir_)),
      rows_(info_.flights.size()) {
  for (const std::size_t flight : chosen_flights(info_, options_.flights, dir_.string())) {
    rows_[flight] = read_samples(dir_, info_.flights[flight].name);
    for (std::size_t row = 0; row < rows_[flight].size(); ++row) places_.push_back({flight, row});
  }
  if (places_.empty()) throw DataError(dir_.string() + ": has no sample in the chosen flights");
}

const FlightEntry& DepthDataset::flight(std::size_t index) const {
  return info_.flights[places_.at(index).flight];
}

const SampleRow& DepthDataset::row(std::size_t index) const {
  const Place& place = places_.at(index);
  return rows_[place.flight][place.row];
}

DepthSample DepthDataset::get(std::size_t index) {
  const FlightEntry& entry = flight(index);
  const SampleRow& line = row(index);
  const std::vector<SampleRow>& rows = rows_[places_.at(index).flight];
  const Sample sample = read_sample(dir_, entry, line, options_.with_dense);
  const PinholeIntrinsics& k = info_.rig.intrinsics;
  const auto checked = [&](const cv::Mat& image, int sample_index) {
    if (image.size() == k.size()) return image;
    throw DataError((dir_ / entry.name).string() + ": sample " + std::to_string(sample_index) + " has " +
                    std::to_string(image.cols) + "x" + std::to_string(image.rows) +
                    " pixels, dataset.yaml says " + std::to_string(k.width_px) + "x" +
                    std::to_string(k.height_px));
  };

  DepthSample out;
  out.left = image_to_tensor(checked(sample.left, line.index));
  out.has_right = entry.has_right;
  out.right = out.has_right ? image_to_tensor(sample.right) : torch::zeros_like(out.left);
  const auto neighbour = [&](int neighbour_index, bool& there, torch::Tensor& image,
                             torch::Tensor& T_neighbour) {
    there = neighbour_index >= 0;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    if (there)
      T = rows[static_cast<std::size_t>(neighbour_index)].T_world_camera.inverse() * line.T_world_camera;
    image = there ? image_to_tensor(checked(read_left(dir_, entry, neighbour_index), neighbour_index))
                  : torch::zeros_like(out.left);
    T_neighbour = transform_to_tensor(T);
  };
  neighbour(line.previous, out.has_previous, out.previous, out.T_previous_camera);
  neighbour(line.next, out.has_next, out.next, out.T_next_camera);

  cv::Mat offset_s;
  sample.sparse.offset_us.convertTo(offset_s, CV_32FC1, 1e-6);
  out.sparse = depth_to_tensor(sample.sparse.depth_m);
  out.offset_s = depth_to_tensor(offset_s);
  if (!sample.dense_m.empty()) out.dense = depth_to_tensor(sample.dense_m);
  out.intrinsics = torch::tensor({k.fx_px, k.fy_px, k.cx_px, k.cy_px}, torch::kFloat32);
  const Eigen::Vector3f down =
      (line.T_world_camera.linear().transpose() * -Eigen::Vector3d::UnitZ()).cast<float>();
  out.down_camera = torch::tensor({down.x(), down.y(), down.z()});
  out.baseline_m = info_.rig.baseline_m;
  out.height_m = line.height_m;
  out.index = static_cast<std::int64_t>(index);
  return out;
}

}  // namespace alight
