#include "sensors/messages/camera_info_decoder.hpp"

#include <array>
#include <string>

#include "geometry/rig/ros_lens.hpp"

namespace alight {

std::optional<DecodedMessage> decode_camera_info(const RawMessage& message, const DecodeOptions& options) {
  constexpr std::size_t kRectificationBytes = (9 + 12) * sizeof(double);  // R, P
  constexpr std::size_t kBinningAndRegionBytes = 6 * 4 + 1;
  constexpr std::uint32_t kMostCoefficients = 14;
  ByteReader reader(message);
  CameraDescription out;
  out.t_ns = read_stamp(reader, message, options);
  const auto height = reader.read<std::uint32_t>();
  const auto width = reader.read<std::uint32_t>();
  const std::string model(reader.read_string());
  const auto count = reader.read<std::uint32_t>();
  if (count > kMostCoefficients) throw DecodeError(std::to_string(count) + " distortion coefficients");
  std::vector<double> coefficients;
  for (std::uint32_t i = 0; i < count; ++i) coefficients.push_back(reader.read<double>());
  std::array<double, 9> K{};
  for (double& k : K) k = reader.read<double>();
  reader.take(kRectificationBytes + kBinningAndRegionBytes);
  reader.expect_end();
  if (K[0] == 0) return std::nullopt;
  if (width > kMaxImageSide_px || height > kMaxImageSide_px)
    throw DecodeError("camera of " + std::to_string(width) + "x" + std::to_string(height) + " pixels");
  out.camera.intrinsics = {K[0], K[4], K[2], K[5], static_cast<int>(width), static_cast<int>(height)};
  if (const std::string problem = set_ros_distortion(model, coefficients, out.camera); !problem.empty())
    throw DecodeError(problem);
  return out;
}

}  // namespace alight
