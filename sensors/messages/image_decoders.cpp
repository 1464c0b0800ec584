#include "sensors/messages/image_decoders.hpp"

#include <algorithm>
#include <string>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "sensors/messages/jpeg_decoder.hpp"

namespace alight {
namespace {

constexpr int kKeep = -1;
constexpr int kHighByte = -2;  // of pairs of bytes, of which image rows need not be a multiple

/// How one pixel encoding of sensor_msgs/image_encodings.h becomes grey or BGR.
struct PixelEncoding {
  const char* name;
  int type;        ///< CV_8UC1 ..., of the bytes as they are
  int conversion;  ///< cv::ColorConversionCodes

  std::uint32_t pixel_bytes() const { return static_cast<std::uint32_t>(CV_ELEM_SIZE(type)); }
};

/// OpenCV names a Bayer pattern by its second row's second and third pixel, ROS by the first two rows from
/// the corner.
constexpr PixelEncoding kEncodings[] = {
    {"mono8", CV_8UC1, kKeep},
    {"mono16", CV_8UC2, kHighByte},
    {"bgr8", CV_8UC3, kKeep},
    {"rgb8", CV_8UC3, cv::COLOR_RGB2BGR},
    {"bgra8", CV_8UC4, cv::COLOR_BGRA2BGR},
    {"rgba8", CV_8UC4, cv::COLOR_RGBA2BGR},
    {"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2BGR},
    {"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2BGR},
    {"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2BGR},
    {"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2BGR},
    {"yuv422", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
    {"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2BGR_YUYV},
};

const PixelEncoding& find_encoding(std::string_view name) {
  std::string known;
  for (const PixelEncoding& encoding : kEncodings) {
    if (name == encoding.name) return encoding;
    known += std::string(known.empty() ? "" : ", ") + encoding.name;
  }
  throw DecodeError("pixel encoding \"" + std::string(name.substr(0, 40)) + "\" is none of " + known);
}

/// Grey of 16 bits to 8: the more significant byte, wherever it is.
cv::Mat high_bytes(const cv::Mat& pairs, bool big_endian) {
  cv::Mat high;
  cv::extractChannel(pairs, high, big_endian ? 0 : 1);
  return high;
}

/// Pixels as they are in the message to a copy in grey or BGR.
cv::Mat to_grey_or_bgr(const cv::Mat& raw, const PixelEncoding& encoding, bool big_endian) {
  if (encoding.conversion == kHighByte) return high_bytes(raw, big_endian);
  if (encoding.conversion == kKeep) return raw.clone();
  cv::Mat image;
  cv::cvtColor(raw, image, encoding.conversion);
  return image;
}

bool starts_with(const std::uint8_t* data, std::size_t size, std::string_view magic) {
  return size >= magic.size() && std::memcmp(data, magic.data(), magic.size()) == 0;
}

cv::Mat decode_png(const std::uint8_t* data, std::size_t size) {
  const cv::Mat bytes(1, static_cast<int>(size), CV_8UC1, const_cast<std::uint8_t*>(data));
  try {
    return cv::imdecode(bytes, cv::IMREAD_UNCHANGED | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception& e) {
    throw DecodeError("PNG: " + e.err);
  }
}

}  // namespace

std::optional<DecodedMessage> decode_image(const RawMessage& message, const DecodeOptions& options) {
  ByteReader reader(message);
  CameraImage out;
  out.t_ns = read_stamp(reader, message, options);
  const auto height = reader.read<std::uint32_t>();
  const auto width = reader.read<std::uint32_t>();
  const PixelEncoding& encoding = find_encoding(reader.read_string());
  const bool big_endian = reader.read<std::uint8_t>() != 0;
  const auto step = reader.read<std::uint32_t>();
  const auto size = reader.read<std::uint32_t>();
  if (width == 0 || height == 0 || width > kMaxImageSide_px || height > kMaxImageSide_px) {
    throw DecodeError("image of " + std::to_string(width) + "x" + std::to_string(height) + " pixels");
  }
  if (step < width * encoding.pixel_bytes() || size != std::uint64_t{step} * height) {
    throw DecodeError("image of " + std::to_string(size) + " bytes, but " + std::to_string(height) +
                      " rows of " + std::to_string(step) + " (" + std::to_string(width) + " pixels " +
                      encoding.name + ")");
  }
  const bool yuv = encoding.type == CV_8UC2 && encoding.conversion != kHighByte;
  if (yuv && width % 2 != 0) throw DecodeError("yuv422 of an odd width");
  const std::uint8_t* pixels = reader.take(size);
  reader.expect_end();
  const cv::Mat raw(static_cast<int>(height), static_cast<int>(width), encoding.type,
                    const_cast<std::uint8_t*>(pixels), step);
  out.image = to_grey_or_bgr(raw, encoding, big_endian);
  return out;
}

std::optional<DecodedMessage> decode_compressed_image(const RawMessage& message,
                                                      const DecodeOptions& options) {
  ByteReader reader(message);
  CameraImage out;
  out.t_ns = read_stamp(reader, message, options);
  reader.read_string();  // format: drivers disagree on its spelling, the bytes themselves do not lie
  const auto size = reader.read<std::uint32_t>();
  const std::uint8_t* data = reader.take(size);
  reader.expect_end();
  if (is_jpeg(data, size)) {
    out.image = decode_jpeg(data, size, kMaxImageSide_px);
    return out;
  }
  const bool png = starts_with(data, size, "\x89PNG\r\n\x1A\n");
  if (!png) throw DecodeError("compressed image is neither JPEG nor PNG");
  out.image = decode_png(data, size);
  if (out.image.empty()) throw DecodeError("PNG is damaged");
  if (out.image.type() == CV_8UC4) cv::cvtColor(out.image, out.image, cv::COLOR_BGRA2BGR);
  if (out.image.type() != CV_8UC1 && out.image.type() != CV_8UC3) {
    throw DecodeError("compressed image is neither 8-bit grey nor 8-bit colour");
  }
  return out;
}

}  // namespace alight
