#include "dataset/store/sample_store.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "foundation/csv_line.hpp"
#include "foundation/errors.hpp"
#include "geometry/depth_map.hpp"
#include "pictures/picture_file.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

constexpr int kOffsetZero = 32768;  // of the 16-bit file: no offset
constexpr const char* kSamplesHeader =
    "index,t_ns,x_m,y_m,z_m,qw,qx,qy,qz,previous,next,points,pixels,height_m";

fs::path picture_path(const fs::path& dir, const FlightEntry& flight, const char* folder, int index) {
  return dir / flight.name / folder / fmt::format("{:06}.png", index);
}

/// An 8-bit grey or colour picture (type CV_8U) or a 16-bit map (CV_16U) of the data set's size.
cv::Mat read_picture(const fs::path& path, int depth) {
  std::error_code code;
  if (!fs::is_regular_file(path, code))
    throw DataError(path.string() + ": is missing; build the data set again");
  cv::Mat picture;
  try {
    picture = cv::imread(path.string(), cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    picture.release();
  }
  if (picture.empty()) throw DataError(path.string() + ": is no PNG or cut off; build the data set again");
  const bool channels_ok = picture.channels() == 1 || (depth == CV_8U && picture.channels() == 3);
  if (picture.depth() != depth || !channels_ok) {
    throw DataError(path.string() + ": has the wrong pixel type, expected " +
                    (depth == CV_8U ? "8-bit" : "16-bit") + (depth == CV_8U ? " grey or colour" : " grey"));
  }
  return picture;
}

void expect_size(const cv::Mat& picture, cv::Size size, const fs::path& path) {
  if (picture.size() == size) return;
  throw DataError(path.string() + ": is " + std::to_string(picture.cols) + "x" +
                  std::to_string(picture.rows) + " pixels, the left image is " + std::to_string(size.width) +
                  "x" + std::to_string(size.height));
}

std::string format_row(const SampleRow& row) {
  const Eigen::Vector3d p = row.T_world_camera.translation();
  const Eigen::Quaterniond q(row.T_world_camera.linear());
  return fmt::format("{},{},{:.6f},{:.6f},{:.6f},{:.12f},{:.12f},{:.12f},{:.12f},{},{},{},{},{}\n", row.index,
                     row.t_ns, p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), row.previous, row.next,
                     row.points, row.pixels,
                     std::isnan(row.height_m) ? "nan" : fmt::format("{:.3f}", row.height_m));
}

SampleRow parse_row(CsvLine line) {
  SampleRow row;
  row.index = line.integer<int>("index");
  row.t_ns = line.integer<std::int64_t>("t_ns");
  for (int axis = 0; axis < 3; ++axis) row.T_world_camera.translation()[axis] = line.number("position");
  std::array<double, 4> q{};
  for (double& value : q) value = line.number("quaternion");
  const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
  if (!(std::abs(rotation.norm() - 1) < 1e-3)) line.fail("the quaternion is not of unit length");
  row.T_world_camera.linear() = rotation.normalized().toRotationMatrix();
  row.previous = line.integer<int>("previous");
  row.next = line.integer<int>("next");
  row.points = line.integer<int>("points");
  row.pixels = line.integer<int>("pixels");
  row.height_m = line.number_or_nan("height_m");
  line.expect_end();
  return row;
}

void check_rows(const std::vector<SampleRow>& rows, const fs::path& path) {
  const int count = static_cast<int>(rows.size());
  for (int i = 0; i < count; ++i) {
    const SampleRow& row = rows[static_cast<std::size_t>(i)];
    const bool neighbours_ok =
        row.previous >= -1 && row.previous < i && row.next < count && (row.next == -1 || row.next > i);
    if (row.index == i && neighbours_ok) continue;
    throw DataError(path.string() + ":" + std::to_string(i + 2) +
                    ": index or neighbours are out of order; build the data set again");
  }
}

}  // namespace

cv::Mat encode_offset(const SparseDepth& sparse) {
  cv::Mat encoded = cv::Mat::zeros(sparse.depth_m.size(), CV_16UC1);
  for (int v = 0; v < encoded.rows; ++v) {
    for (int u = 0; u < encoded.cols; ++u) {
      if (sparse.depth_m.at<float>(v, u) == 0) continue;
      const double offset_ms = std::round(sparse.offset_us.at<std::int32_t>(v, u) / 1000.0);
      encoded.at<std::uint16_t>(v, u) =
          cv::saturate_cast<std::uint16_t>(std::max(1.0, offset_ms + kOffsetZero));
    }
  }
  return encoded;
}

cv::Mat decode_offset(const cv::Mat& offset_16) {
  cv::Mat offset_us = cv::Mat::zeros(offset_16.size(), CV_32SC1);
  for (int v = 0; v < offset_us.rows; ++v) {
    for (int u = 0; u < offset_us.cols; ++u) {
      const int stored = offset_16.at<std::uint16_t>(v, u);
      if (stored != 0) offset_us.at<std::int32_t>(v, u) = (stored - kOffsetZero) * 1000;
    }
  }
  return offset_us;
}

std::vector<SampleRow> read_samples(const fs::path& dir, const std::string& flight) {
  const fs::path path = dir / flight / "samples.csv";
  std::ifstream stream(path);
  if (!stream)
    throw DataError(path.string() + ": cannot be opened; is " + dir.string() + " a whole data set?");
  std::string text;
  if (!std::getline(stream, text) || text != kSamplesHeader) {
    throw DataError(path.string() + ":1: expected the columns " + kSamplesHeader);
  }
  std::vector<SampleRow> rows;
  while (std::getline(stream, text)) {
    rows.push_back(parse_row(CsvLine(text, path.string() + ":" + std::to_string(rows.size() + 2))));
  }
  check_rows(rows, path);
  return rows;
}

Sample read_sample(const fs::path& dir, const FlightEntry& flight, const SampleRow& row, bool with_dense) {
  Sample sample;
  sample.left = read_left(dir, flight, row.index);
  const auto read_alike = [&](const char* folder, int depth) {
    const fs::path path = picture_path(dir, flight, folder, row.index);
    const cv::Mat picture = read_picture(path, depth);
    expect_size(picture, sample.left.size(), path);
    return picture;
  };
  if (flight.has_right) sample.right = read_alike("right", CV_8U);
  sample.sparse.depth_m = decode_depth(read_alike("depth", CV_16U));
  sample.sparse.offset_us = decode_offset(read_alike("offset", CV_16U));
  if (with_dense && flight.has_dense) sample.dense_m = decode_depth(read_alike("dense", CV_16U));
  return sample;
}

cv::Mat read_left(const fs::path& dir, const FlightEntry& flight, int index) {
  return read_picture(picture_path(dir, flight, "left", index), CV_8U);
}

void create_flight_folders(const fs::path& dir, const FlightEntry& flight) {
  std::vector<std::string> folders = {"left", "depth", "offset"};
  if (flight.has_right) folders.emplace_back("right");
  if (flight.has_dense) folders.emplace_back("dense");
  for (const std::string& folder : folders) {
    std::error_code code;
    const fs::path path = dir / flight.name / folder;
    fs::create_directories(path, code);
    if (code) throw DataError(path.string() + ": cannot be created: " + code.message());
  }
}

void write_samples(const fs::path& dir, const std::string& flight, const std::vector<SampleRow>& rows) {
  const fs::path path = dir / flight / "samples.csv";
  std::ofstream stream(path, std::ios::binary);
  stream << kSamplesHeader << "\n";
  for (const SampleRow& row : rows) stream << format_row(row);
  stream.flush();
  if (!stream) throw DataError(path.string() + ": cannot be written; check the free space");
}

void write_sample(const fs::path& dir, const FlightEntry& flight, int index, const Sample& sample,
                  int png_compression) {
  const auto write = [&](const char* folder, const cv::Mat& picture) {
    write_picture(picture_path(dir, flight, folder, index), picture, png_compression);
  };
  write("left", sample.left);
  if (flight.has_right) write("right", sample.right);
  write("depth", encode_depth(sample.sparse.depth_m));
  write("offset", encode_offset(sample.sparse));
  if (flight.has_dense) write("dense", encode_depth(sample.dense_m));
}

void move_sample(const fs::path& dir, const FlightEntry& flight, int from, int to) {
  std::vector<const char*> folders = {"left", "depth", "offset"};
  if (flight.has_right) folders.push_back("right");
  if (flight.has_dense) folders.push_back("dense");
  for (const char* folder : folders)
    fs::rename(picture_path(dir, flight, folder, from), picture_path(dir, flight, folder, to));
}

}  // namespace alight
