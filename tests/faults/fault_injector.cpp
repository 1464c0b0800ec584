#include "tests/faults/fault_injector.hpp"

#include <algorithm>
#include <deque>
#include <random>
#include <utility>
#include <variant>

#include "geometry/frames.hpp"

namespace alight {
namespace {

/// Changes the messages of one type that come from `from_ns` on; `change` returns false to drop one.
template <class Message, class Change>
Messages changed(Messages flight, std::int64_t from_ns, Change change) {
  const auto dropped = [&](TimedMessage& timed) {
    auto* message = std::get_if<Message>(&timed.message);
    return message != nullptr && timed.receive_ns >= from_ns && !change(*message);
  };
  flight.erase(std::remove_if(flight.begin(), flight.end(), dropped), flight.end());
  return flight;
}

template <class Message>
Messages lost(const Messages& flight, std::int64_t from_ns) {
  return changed<Message>(flight, from_ns, [](Message&) { return false; });
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
Messages stamps_shifted(const Messages& flight, std::int64_t from_ns, double by_s) {
  return changed<Message>(flight, from_ns, [by_s](Message& message) {
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

Messages camera_frozen(const Messages& flight, std::int64_t from_ns) {
  StereoFrame last;
  return changed<StereoFrame>(flight, from_ns, [last](StereoFrame& frame) mutable {
    if (last.left.empty()) last = frame;
    frame.left = last.left;
    frame.right = last.right;
    return true;
  });
}

Messages camera_black(const Messages& flight, std::int64_t from_ns) {
  return changed<StereoFrame>(flight, from_ns, [](StereoFrame& frame) {
    frame.left = exposed_to(frame.left, 2, frame.t_ns);
    frame.right = exposed_to(frame.right, 2, frame.t_ns + 1);
    return true;
  });
}

Messages camera_over_exposed(const Messages& flight, std::int64_t from_ns) {
  return changed<StereoFrame>(flight, from_ns, [](StereoFrame& frame) {
    frame.left = cv::Mat(frame.left * 3 + cv::Scalar::all(60));  // the healthy flight shares the pixels
    frame.right = cv::Mat(frame.right * 3 + cv::Scalar::all(60));
    return true;
  });
}

Messages right_lost(const Messages& flight, std::int64_t from_ns) {
  return changed<StereoFrame>(flight, from_ns, [](StereoFrame& frame) {
    frame.right = cv::Mat();
    return true;
  });
}

Messages eyes_swapped(const Messages& flight, std::int64_t from_ns) {
  return changed<StereoFrame>(flight, from_ns, [](StereoFrame& frame) {
    std::swap(frame.left, frame.right);
    return true;
  });
}

/// What the eyes show is `frames` exposures old.
Messages eyes_late(const Messages& flight, std::int64_t from_ns, bool left_too, std::size_t frames) {
  Messages late = flight;
  std::deque<StereoFrame> before;
  for (TimedMessage& timed : late) {
    auto* frame = std::get_if<StereoFrame>(&timed.message);
    if (frame == nullptr) continue;
    before.push_back(*frame);
    if (before.size() <= frames) continue;
    if (timed.receive_ns >= from_ns) {
      frame->right = before.front().right;
      if (left_too) frame->left = before.front().left;
    }
    before.pop_front();
  }
  return late;
}

Messages lidar_half(const Messages& flight, std::int64_t from_ns) {
  return changed<LidarPacket>(flight, from_ns, [](LidarPacket& packet) {
    std::vector<LidarReturn> half;
    for (std::size_t i = 0; i < packet.returns.size(); i += 2) half.push_back(packet.returns[i]);
    packet.returns = std::move(half);
    packet.dropped /= 2;
    return true;
  });
}

Messages lidar_frozen(const Messages& flight, std::int64_t from_ns) {
  LidarPacket last;
  return changed<LidarPacket>(flight, from_ns, [last](LidarPacket& packet) mutable {
    if (last.returns.empty()) last = packet;
    const std::int64_t t_ns = packet.t_ns;
    packet = last;
    shift_stamps(packet, t_ns - last.t_ns);
    return true;
  });
}

/// Drops send back 8 % of the shots from anywhere on the way to the ground.
Messages lidar_rain(const Messages& flight, std::int64_t from_ns) {
  std::mt19937 random(7);
  return changed<LidarPacket>(flight, from_ns, [random](LidarPacket& packet) mutable {
    std::uniform_real_distribution<float> uniform(0, 1);
    for (LidarReturn& echo : packet.returns) {
      if (uniform(random) < 0.08F) echo.p_lidar *= 0.1F + 0.6F * uniform(random);
    }
    return true;
  });
}

Messages lidar_mirrored(const Messages& flight, std::int64_t from_ns, const Eigen::Vector3f& signs) {
  return changed<LidarPacket>(flight, from_ns, [signs](LidarPacket& packet) {
    for (LidarReturn& echo : packet.returns) echo.p_lidar = echo.p_lidar.cwiseProduct(signs);
    return true;
  });
}

Messages position_jumps(const Messages& flight, std::int64_t from_ns) {
  return changed<PositionSample>(flight, from_ns, [](PositionSample& sample) {
    sample.latitude_deg += 2.0 / 111'320;
    return true;
  });
}

Messages attitude_frozen(const Messages& flight, std::int64_t from_ns) {
  std::vector<Eigen::Quaterniond> last;
  return changed<AttitudeSample>(flight, from_ns, [last](AttitudeSample& sample) mutable {
    if (last.empty()) last.push_back(sample.q_world_imu);
    sample.q_world_imu = last.front();
    return true;
  });
}

Messages in_order_of_arrival(Messages flight) {
  std::stable_sort(flight.begin(), flight.end(),
                   [](const auto& a, const auto& b) { return a.receive_ns < b.receive_ns; });
  return flight;
}

Messages out_of_order(const Messages& flight, std::int64_t from_ns) {
  Messages mixed = flight;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> delay_s(0, 0.2);
  for (TimedMessage& timed : mixed) {
    if (timed.receive_ns >= from_ns) timed.receive_ns += to_nanoseconds(delay_s(random));
  }
  return in_order_of_arrival(std::move(mixed));
}

Messages all_late(const Messages& flight, std::int64_t from_ns) {
  Messages late = flight;
  for (TimedMessage& timed : late) {
    if (timed.receive_ns >= from_ns) timed.receive_ns += to_nanoseconds(0.4);
  }
  return late;
}

Messages autopilot_clock_jumps(const Messages& flight, std::int64_t from_ns) {
  return stamps_shifted<AttitudeSample>(
      stamps_shifted<PositionSample>(stamps_shifted<HeightSample>(flight, from_ns, 1.0), from_ns, 1.0),
      from_ns, 1.0);
}

}  // namespace

const std::vector<Fault>& all_faults() {
  using M = const Messages&;
  using T = std::int64_t;
  static const std::vector<Fault> kFaults = {
      {"camera lost", "left camera", "lost", "degraded", lost<StereoFrame>},
      {"camera frozen", "left camera", "frozen", "degraded", camera_frozen},
      {"camera black", "left camera", "black", "degraded", camera_black},
      {"camera over-exposed", "left camera", "over-exposed", "degraded", camera_over_exposed},
      {"right eye lost", "right camera", "lost", "degraded", right_lost},
      {"eyes swapped", "stereo", "eyes swapped", "degraded", eyes_swapped},
      {"right eye 0.2 s late", "stereo", "eyes misaligned", "degraded",
       [](M f, T t) { return eyes_late(f, t, false, 2); }},
      {"both eyes 0.2 s late, stamps as if not", "", "", "",
       [](M f, T t) { return eyes_late(f, t, true, 2); }},
      {"camera clock 0.3 s ahead", "left camera", "clock jump", "degraded",
       [](M f, T t) { return stamps_shifted<StereoFrame>(f, t, 0.3); }},
      {"camera clock 2 s behind", "left camera", "clock jump", "degraded",
       [](M f, T t) { return stamps_shifted<StereoFrame>(f, t, -2); }},
      {"LiDAR lost", "lidar", "lost", "degraded", lost<LidarPacket>},
      {"LiDAR half of the points", "lidar", "points missing", "degraded", lidar_half},
      {"LiDAR frozen", "lidar", "frozen", "degraded", lidar_frozen},
      {"LiDAR rain", "lidar", "noise", "degraded", lidar_rain},
      {"LiDAR mirrored left-right", "lidar", "mirrored", "degraded",
       [](M f, T t) {
         return lidar_mirrored(f, t, {1, -1, 1});
       }},
      {"LiDAR mirrored front-back", "lidar", "mirrored", "degraded",
       [](M f, T t) {
         return lidar_mirrored(f, t, {1, 1, -1});
       }},
      {"LiDAR clock 2 s ahead", "lidar", "clock jump", "degraded",
       [](M f, T t) { return stamps_shifted<LidarPacket>(f, t, 2); }},
      {"LiDAR clock 0.1 s behind", "", "", "",
       [](M f, T t) { return stamps_shifted<LidarPacket>(f, t, -0.1); }},
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

}  // namespace alight
