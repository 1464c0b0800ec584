#include "sim/record/message_schedule.hpp"

#include <algorithm>
#include <tuple>

#include "geometry/frames.hpp"

namespace alight::sim {
namespace {

/// The first measurement at or after the end closes a stream of poses; cameras stop before it.
enum class End { kEnclosed, kBefore };

/// Measurements at phase + k / rate.
void add_stream(std::vector<ScheduledMessage>& messages, SensorStream stream, double rate_hz, double phase_s,
                double delay_s, std::int64_t end_ns, End end) {
  for (std::int64_t k = 0;; ++k) {
    const std::int64_t t_ns = to_nanoseconds(phase_s + static_cast<double>(k) / rate_hz);
    if (t_ns >= end_ns && end == End::kBefore) return;
    messages.push_back({t_ns + to_nanoseconds(delay_s), t_ns, stream, k});
    if (t_ns >= end_ns) return;
  }
}

void add_lidar(std::vector<ScheduledMessage>& messages, const LidarConfig& config, std::int64_t end_ns) {
  const std::int64_t packet_ns = to_nanoseconds(config.packet_s);
  const std::int64_t delay_ns = packet_ns + to_nanoseconds(config.transport_s);
  for (std::int64_t k = 0; (k + 1) * packet_ns <= end_ns; ++k) {
    messages.push_back({k * packet_ns + delay_ns, k * packet_ns, SensorStream::kLidar, k});
  }
}

}  // namespace

std::vector<ScheduledMessage> message_schedule(const SensorsConfig& config, double duration_s) {
  const std::int64_t end_ns = to_nanoseconds(duration_s);
  const double delay_s = config.pose_transport_s;
  std::vector<ScheduledMessage> messages;
  add_stream(messages, SensorStream::kAttitude, config.attitude.rate_hz, 0, delay_s, end_ns, End::kEnclosed);
  add_stream(messages, SensorStream::kImu, config.imu.rate_hz, 0, delay_s, end_ns, End::kEnclosed);
  add_stream(messages, SensorStream::kPosition, config.gps.rate_hz, 0, delay_s, end_ns, End::kEnclosed);
  add_stream(messages, SensorStream::kHeight, config.height.rate_hz, 0, delay_s, end_ns, End::kEnclosed);
  add_stream(messages, SensorStream::kCamera, config.camera.rate_hz, config.camera.phase_s,
             config.camera.transport_s, end_ns, End::kBefore);
  add_lidar(messages, config.lidar, end_ns);
  std::sort(messages.begin(), messages.end(), [](const ScheduledMessage& a, const ScheduledMessage& b) {
    return std::tie(a.receive_ns, a.stream, a.index) < std::tie(b.receive_ns, b.stream, b.index);
  });
  return messages;
}

}  // namespace alight::sim
