#include "sim/record/fault_injector.hpp"

#include <algorithm>
#include <deque>
#include <random>
#include <utility>
#include <variant>

#include "geometry/frames.hpp"

namespace alight::sim {
namespace {

/// Changes the messages of one type that come from `from_ns` on; `change` returns false to lose one.
template <class Message, class Change>
FaultFilter changed(std::int64_t from_ns, Change change) {
  return [from_ns, change](TimedMessage& timed) mutable {
    auto* message = std::get_if<Message>(&timed.message);
    return message == nullptr || timed.receive_ns < from_ns || change(*message);
  };
}

template <class Message>
FaultFilter lost(std::int64_t from_ns) {
  return changed<Message>(from_ns, [](Message&) { return false; });
}

void shift_stamps(LidarPacket& packet, std::int64_t by_ns) {
  packet.t_ns += by_ns;
  for (LidarReturn& echo : packet.returns) echo.t_ns += by_ns;
}
template <class Message>
void shift_stamps(Message& message, std::int64_t by_ns) {
  message.t_ns += by_ns;
}
template <class Message>
FaultFilter stamps_shifted(std::int64_t from_ns, double by_s) {
  return changed<Message>(from_ns, [by_s](Message& message) {
    shift_stamps(message, to_nanoseconds(by_s));
    return true;
  });
}

/// An exposure of nothing: what is left is the sensor's noise around `level`.
cv::Mat exposed_to(const cv::Mat& image, double level, std::int64_t t_ns) {
  cv::Mat noise(image.size(), CV_8UC(image.channels()));
  cv::RNG random(static_cast<std::uint64_t>(t_ns));
  random.fill(noise, cv::RNG::NORMAL, level, 1.5);
  return noise;
}

FaultFilter camera_frozen(std::int64_t from_ns) {
  StereoFrame last;
  return changed<StereoFrame>(from_ns, [last](StereoFrame& frame) mutable {
    if (last.left.empty()) last = frame;
    frame.left = last.left;
    frame.right = last.right;
    return true;
  });
}

FaultFilter camera_black(std::int64_t from_ns) {
  return changed<StereoFrame>(from_ns, [](StereoFrame& frame) {
    frame.left = exposed_to(frame.left, 2, frame.t_ns);
    frame.right = exposed_to(frame.right, 2, frame.t_ns + 1);
    return true;
  });
}

FaultFilter camera_over_exposed(std::int64_t from_ns) {
  return changed<StereoFrame>(from_ns, [](StereoFrame& frame) {
    frame.left = cv::Mat(frame.left * 3 + cv::Scalar::all(60));  // the healthy flight shares the pixels
    frame.right = cv::Mat(frame.right * 3 + cv::Scalar::all(60));
    return true;
  });
}

FaultFilter right_lost(std::int64_t from_ns) {
  return changed<StereoFrame>(from_ns, [](StereoFrame& frame) {
    frame.right = cv::Mat();
    return true;
  });
}

FaultFilter cameras_swapped(std::int64_t from_ns) {
  return changed<StereoFrame>(from_ns, [](StereoFrame& frame) {
    std::swap(frame.left, frame.right);
    return true;
  });
}

/// What the cameras show is `frames` exposures old.
FaultFilter cameras_late(std::int64_t from_ns, bool left_too, std::size_t frames) {
  return [=, before = std::deque<StereoFrame>()](TimedMessage& timed) mutable {
    auto* frame = std::get_if<StereoFrame>(&timed.message);
    if (frame == nullptr) return true;
    before.push_back(*frame);
    if (before.size() <= frames) return true;
    if (timed.receive_ns >= from_ns) {
      frame->right = before.front().right;
      if (left_too) frame->left = before.front().left;
    }
    before.pop_front();
    return true;
  };
}

FaultFilter lidar_half(std::int64_t from_ns) {
  return changed<LidarPacket>(from_ns, [](LidarPacket& packet) {
    std::vector<LidarReturn> half;
    for (std::size_t i = 0; i < packet.returns.size(); i += 2) half.push_back(packet.returns[i]);
    packet.returns = std::move(half);
    packet.dropped /= 2;
    return true;
  });
}

FaultFilter lidar_frozen(std::int64_t from_ns) {
  LidarPacket last;
  return changed<LidarPacket>(from_ns, [last](LidarPacket& packet) mutable {
    if (last.returns.empty()) last = packet;
    const std::int64_t t_ns = packet.t_ns;
    packet = last;
    shift_stamps(packet, t_ns - last.t_ns);
    return true;
  });
}

/// Drops send back 8 % of the shots from anywhere on the way to the ground.
FaultFilter lidar_rain(std::int64_t from_ns) {
  std::mt19937 random(7);
  return changed<LidarPacket>(from_ns, [random](LidarPacket& packet) mutable {
    std::uniform_real_distribution<float> uniform(0, 1);
    for (LidarReturn& echo : packet.returns) {
      if (uniform(random) < 0.08F) echo.p_lidar *= 0.1F + 0.6F * uniform(random);
    }
    return true;
  });
}

FaultFilter lidar_mirrored(std::int64_t from_ns, const Eigen::Vector3f& signs) {
  return changed<LidarPacket>(from_ns, [signs](LidarPacket& packet) {
    for (LidarReturn& echo : packet.returns) echo.p_lidar = echo.p_lidar.cwiseProduct(signs);
    return true;
  });
}

FaultFilter position_jumps(std::int64_t from_ns) {
  return changed<PositionSample>(from_ns, [](PositionSample& sample) {
    std::get<GeodeticPosition>(sample.position).latitude_deg += 2.0 / 111'320;
    return true;
  });
}

FaultFilter attitude_frozen(std::int64_t from_ns) {
  std::vector<Eigen::Quaterniond> last;
  return changed<AttitudeSample>(from_ns, [last](AttitudeSample& sample) mutable {
    if (last.empty()) last.push_back(sample.q_world_imu);
    sample.q_world_imu = last.front();
    return true;
  });
}

FaultFilter out_of_order(std::int64_t from_ns) {
  return [from_ns, random = std::mt19937(3)](TimedMessage& timed) mutable {
    std::uniform_real_distribution<double> delay_s(0, 0.2);
    if (timed.receive_ns >= from_ns) timed.receive_ns += to_nanoseconds(delay_s(random));
    return true;
  };
}

FaultFilter all_late(std::int64_t from_ns) {
  return [from_ns](TimedMessage& timed) {
    if (timed.receive_ns >= from_ns) timed.receive_ns += to_nanoseconds(0.4);
    return true;
  };
}

FaultFilter autopilot_clock_jumps(std::int64_t from_ns) {
  return [attitude = stamps_shifted<AttitudeSample>(from_ns, 1.0),
          position = stamps_shifted<PositionSample>(from_ns, 1.0),
          height = stamps_shifted<HeightSample>(from_ns, 1.0)](TimedMessage& timed) mutable {
    return attitude(timed) && position(timed) && height(timed);
  };
}

}  // namespace

FaultFilter passing(FaultFilter fault, std::int64_t until_ns) {
  return [fault = std::move(fault), until_ns](TimedMessage& timed) {
    return timed.receive_ns >= until_ns || fault(timed);
  };
}

const std::vector<Fault>& all_faults() {
  using T = std::int64_t;
  static const std::vector<Fault> kFaults = {
      {"camera lost", "left camera", "lost", "degraded", lost<StereoFrame>},
      {"camera frozen", "left camera", "frozen", "degraded", camera_frozen},
      {"camera black", "left camera", "black", "degraded", camera_black},
      {"camera over-exposed", "left camera", "over-exposed", "degraded", camera_over_exposed},
      {"right camera lost", "right camera", "lost", "degraded", right_lost},
      {"cameras swapped", "stereo", "cameras swapped", "degraded", cameras_swapped},
      {"right camera 0.2 s late", "stereo", "cameras misaligned", "degraded",
       [](T t) { return cameras_late(t, false, 2); }},
      {"both cameras 0.2 s late with stamps as if not", "", "", "",
       [](T t) { return cameras_late(t, true, 2); }},
      {"camera clock 0.3 s ahead", "left camera", "clock jump", "degraded",
       [](T t) { return stamps_shifted<StereoFrame>(t, 0.3); }},
      {"camera clock 2 s behind", "left camera", "clock jump", "degraded",
       [](T t) { return stamps_shifted<StereoFrame>(t, -2); }},
      {"LiDAR lost", "lidar", "lost", "degraded", lost<LidarPacket>},
      {"LiDAR half of the points", "lidar", "points missing", "degraded", lidar_half},
      {"LiDAR frozen", "lidar", "frozen", "degraded", lidar_frozen},
      {"LiDAR rain", "lidar", "noise", "degraded", lidar_rain},
      {"LiDAR mirrored left-right", "lidar", "mirrored", "degraded",
       [](T t) { return lidar_mirrored(t, {1, -1, 1}); }},
      {"LiDAR mirrored front-back", "lidar", "mirrored", "degraded",
       [](T t) { return lidar_mirrored(t, {1, 1, -1}); }},
      {"LiDAR clock 2 s ahead", "lidar", "clock jump", "degraded",
       [](T t) { return stamps_shifted<LidarPacket>(t, 2); }},
      {"LiDAR clock 0.1 s behind", "", "", "", [](T t) { return stamps_shifted<LidarPacket>(t, -0.1); }},
      {"position jumps by 2 m", "position", "jump", "failed", position_jumps},
      {"position lost", "position", "lost", "failed", lost<PositionSample>},
      {"attitude lost", "attitude", "lost", "failed", lost<AttitudeSample>},
      {"attitude frozen", "attitude", "frozen", "failed", attitude_frozen},
      {"autopilot clock 1 s ahead", "lidar", "clock jump", "failed", autopilot_clock_jumps},
      {"messages mixed up by up to 0.2 s", "attitude", "out of order", "degraded", out_of_order},
      {"all messages 0.4 s late", "", "", "", all_late},
  };
  return kFaults;
}

const Fault* find_fault(const std::string& name) {
  for (const Fault& fault : all_faults()) {
    if (fault.name == name) return &fault;
  }
  return nullptr;
}

Messages inject(const Fault& fault, const Messages& flight, std::int64_t from_ns) {
  const FaultFilter filter = fault.begin(from_ns);
  Messages broken;
  for (TimedMessage timed : flight) {
    if (filter(timed)) broken.push_back(std::move(timed));
  }
  std::stable_sort(broken.begin(), broken.end(),
                   [](const auto& a, const auto& b) { return a.receive_ns < b.receive_ns; });
  return broken;
}

}  // namespace alight::sim
