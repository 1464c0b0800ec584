#include <algorithm>
#include <string>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "dataset/messages/decoders.hpp"

namespace alight {
namespace {

constexpr std::uint32_t kMaxSidePx = 16384;
constexpr int kKeep = -1;

/// How one pixel encoding of sensor_msgs/image_encodings.h becomes grey or BGR.
struct PixelEncoding {
  const char* name;
  int channels;
  int conversion;  ///< cv::ColorConversionCodes
};

/// OpenCV names a Bayer pattern by its second row's second and third pixel, ROS by the first two rows from
/// the corner.
constexpr PixelEncoding kEncodings[] = {
    {"mono8", 1, kKeep},
    {"bgr8", 3, kKeep},
    {"rgb8", 3, cv::COLOR_RGB2BGR},
    {"bayer_rggb8", 1, cv::COLOR_BayerBG2BGR},
    {"bayer_bggr8", 1, cv::COLOR_BayerRG2BGR},
    {"bayer_gbrg8", 1, cv::COLOR_BayerGR2BGR},
    {"bayer_grbg8", 1, cv::COLOR_BayerGB2BGR},
};

const PixelEncoding& find_encoding(std::string_view name) {
  std::string known;
  for (const PixelEncoding& encoding : kEncodings) {
    if (name == encoding.name) return encoding;
    known += std::string(known.empty() ? "" : ", ") + encoding.name;
  }
  throw DecodeError("pixel encoding \"" + std::string(name.substr(0, 40)) + "\" is none of " + known);
}

bool starts_with(const std::uint8_t* data, std::size_t size, std::string_view magic) {
  return size >= magic.size() && std::memcmp(data, magic.data(), magic.size()) == 0;
}

/// libjpeg fills a cut-off picture with grey and only warns, so the end marker is looked for; zeros behind it
/// are what some drivers pad with.
bool jpeg_is_whole(const std::uint8_t* data, std::size_t size) {
  while (size > 2 && data[size - 1] == 0) --size;
  return size > 2 && data[size - 2] == 0xFF && data[size - 1] == 0xD9;
}

cv::Mat decode_picture(const std::uint8_t* data, std::size_t size) {
  const cv::Mat bytes(1, static_cast<int>(size), CV_8UC1, const_cast<std::uint8_t*>(data));
  try {
    return cv::imdecode(bytes, cv::IMREAD_UNCHANGED | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception& e) {
    throw DecodeError("picture: " + e.err);
  }
}

}  // namespace

std::optional<DecodedMessage> decode_image(const RawMessage& message, const DecodeOptions&) {
  ByteReader reader(message);
  CameraImage out;
  out.t_ns = reader.read_header();
  const auto height = reader.read<std::uint32_t>();
  const auto width = reader.read<std::uint32_t>();
  const PixelEncoding& encoding = find_encoding(reader.read_string());
  reader.read<std::uint8_t>();  // is_bigendian: one byte a channel has no order
  const auto step = reader.read<std::uint32_t>();
  const auto size = reader.read<std::uint32_t>();
  if (width == 0 || height == 0 || width > kMaxSidePx || height > kMaxSidePx) {
    throw DecodeError("image of " + std::to_string(width) + "x" + std::to_string(height) + " pixels");
  }
  if (step < width * static_cast<std::uint32_t>(encoding.channels) || size != std::uint64_t{step} * height) {
    throw DecodeError("image of " + std::to_string(size) + " bytes, but " + std::to_string(height) +
                      " rows of " + std::to_string(step) + " (" + std::to_string(width) + " pixels " +
                      encoding.name + ")");
  }
  const std::uint8_t* pixels = reader.take(size);
  reader.expect_end();
  const cv::Mat raw(static_cast<int>(height), static_cast<int>(width), CV_8UC(encoding.channels),
                    const_cast<std::uint8_t*>(pixels), step);
  if (encoding.conversion == kKeep) {
    out.image = raw.clone();
  } else {
    cv::cvtColor(raw, out.image, encoding.conversion);
  }
  return out;
}

std::optional<DecodedMessage> decode_compressed_image(const RawMessage& message, const DecodeOptions&) {
  ByteReader reader(message);
  CameraImage out;
  out.t_ns = reader.read_header();
  reader.read_string();  // format: drivers disagree on its spelling, the bytes themselves do not lie
  const auto size = reader.read<std::uint32_t>();
  const std::uint8_t* data = reader.take(size);
  reader.expect_end();
  const bool jpeg = starts_with(data, size, "\xFF\xD8\xFF");
  const bool png = starts_with(data, size, "\x89PNG\r\n\x1A\n");
  if (!jpeg && !png) throw DecodeError("compressed image is neither JPEG nor PNG");
  if (jpeg && !jpeg_is_whole(data, size)) throw DecodeError("JPEG is cut off");
  out.image = decode_picture(data, size);
  if (out.image.empty()) throw DecodeError(std::string(jpeg ? "JPEG" : "PNG") + " is damaged");
  if (out.image.type() != CV_8UC1 && out.image.type() != CV_8UC3) {
    throw DecodeError("compressed image is neither 8-bit grey nor 8-bit colour");
  }
  return out;
}

}  // namespace alight
