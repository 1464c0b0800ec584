#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "dataset/store/dataset_info.hpp"
#include "foundation/errors.hpp"
#include "geometry/projection.hpp"
#include "geometry/rig/stereo_rectification.hpp"

/// The data set on disk, a folder:
///     dataset.yaml                 format version, cropped rig, depth scale, window, flights, configuration
///     <flight>/samples.csv         one line a sample: time, pose, neighbours, counts, height
///     <flight>/left/000000.png     rectified and cropped, grey or BGR; right/ the same where the rig is stereo
///     <flight>/depth/000000.png    16-bit plane depth in 1/256 m, 0 = missing (KITTI's convention)
///     <flight>/offset/000000.png   16-bit t_point - t_image in ms + 32768, 0 = missing
///     <flight>/dense/000000.png    simulated flights: true depth of every pixel, as depth/; for evaluation only
namespace alight {

/// One line of samples.csv.
struct SampleRow {
  int index = 0;
  std::int64_t t_ns = 0;  ///< exposure on the IMU's clock
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  int previous = -1;  ///< index of the sample before this one, -1 if there is none near in time
  int next = -1;
  int points = 0;                                              ///< LiDAR points that fell into the image
  int pixels = 0;                                              ///< pixels that have a depth
  double height_m = std::numeric_limits<double>::quiet_NaN();  ///< above take-off; NaN: unknown
};

/// One sample's pictures.
struct Sample {
  cv::Mat left;   ///< CV_8UC3 BGR or CV_8UC1
  cv::Mat right;  ///< empty for a mono flight
  SparseDepth sparse;
  cv::Mat dense_m;  ///< CV_32FC1; empty if there is none or it was not asked for
};

/// @throws DataError naming file and line
std::vector<SampleRow> read_samples(const std::filesystem::path& dir, const std::string& flight);

/// @param with_dense only evaluation asks for it; training never does. @throws DataError naming the file
Sample read_sample(const std::filesystem::path& dir, const FlightEntry& flight, const SampleRow& row,
                   bool with_dense);

/// The left image alone (a neighbour in time). @throws DataError naming the file
cv::Mat read_left(const std::filesystem::path& dir, const FlightEntry& flight, int index);

/// Makes the flight's folders.
void create_flight_folders(const std::filesystem::path& dir, const FlightEntry& flight);
void write_samples(const std::filesystem::path& dir, const std::string& flight,
                   const std::vector<SampleRow>& rows);
/// @param png_compression 0 (none) .. 9
void write_sample(const std::filesystem::path& dir, const FlightEntry& flight, int index,
                  const Sample& sample, int png_compression);

/// Gives a sample's pictures another index.
void move_sample(const std::filesystem::path& dir, const FlightEntry& flight, int from, int to);

/// 16-bit: milliseconds + 32768 where there is a depth, else 0. And back, to the millisecond.
cv::Mat encode_offset(const SparseDepth& sparse);
cv::Mat decode_offset(const cv::Mat& offset_16);

}  // namespace alight
