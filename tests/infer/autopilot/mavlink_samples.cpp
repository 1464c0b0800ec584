// Prints frames with what is in them, one a line: message fields... hexadecimal bytes. For pymavlink_test.py.
#include <array>
#include <cstdint>
#include <cstdio>
#include <random>

#include "infer/autopilot/mavlink_messages.hpp"

namespace {

using namespace alight;

constexpr std::uint8_t kSystemId = 3;
constexpr std::uint8_t kComponentId = 191;

class Random {
 public:
  /// Every third number is zero, so that payloads end in zeros of all lengths.
  template <class Integer>
  Integer integer() {
    return zero() ? Integer{0} : static_cast<Integer>(bits_());
  }
  float real() { return zero() ? 0.0F : std::normal_distribution<float>(0, 20)(bits_); }

 private:
  bool zero() { return bits_() % 3 == 0; }
  std::mt19937_64 bits_{20};
};

void print(const std::vector<std::uint8_t>& frame) {
  for (const unsigned byte : frame) std::printf("%02x", byte);
  std::printf("\n");
}

void heartbeat(Random& random, MavlinkFramer& framer) {
  Heartbeat h;
  h.custom_mode = random.integer<std::uint32_t>();
  h.type = random.integer<std::uint8_t>();
  h.autopilot = random.integer<std::uint8_t>();
  h.base_mode = random.integer<std::uint8_t>();
  h.system_status = random.integer<std::uint8_t>();
  h.mavlink_version = random.integer<std::uint8_t>();
  std::printf("HEARTBEAT %u %u %u %u %u %u ", h.type, h.autopilot, h.base_mode, h.custom_mode,
              h.system_status, h.mavlink_version);
  print(framer.frame(encode(h)));
}

void landing_target(Random& random, MavlinkFramer& framer) {
  LandingTarget t;
  t.time_us = random.integer<std::uint64_t>();
  for (float* value : {&t.angle_x_rad, &t.angle_y_rad, &t.distance_m, &t.size_x_rad, &t.size_y_rad, &t.p_m[0],
                       &t.p_m[1], &t.p_m[2], &t.q_wxyz[0], &t.q_wxyz[1], &t.q_wxyz[2], &t.q_wxyz[3]})
    *value = random.real();
  for (std::uint8_t* value : {&t.target_num, &t.frame, &t.type, &t.position_valid})
    *value = random.integer<std::uint8_t>();
  std::printf("LANDING_TARGET %llu %u %u ", static_cast<unsigned long long>(t.time_us), t.target_num,
              t.frame);
  for (const float value : {t.angle_x_rad, t.angle_y_rad, t.distance_m, t.size_x_rad, t.size_y_rad, t.p_m[0],
                            t.p_m[1], t.p_m[2], t.q_wxyz[0], t.q_wxyz[1], t.q_wxyz[2], t.q_wxyz[3]})
    std::printf("%.9g ", static_cast<double>(value));
  std::printf("%u %u ", t.type, t.position_valid);
  print(framer.frame(encode(t)));
}

}  // namespace

int main() {
  Random random;
  MavlinkFramer framer(kSystemId, kComponentId);
  for (int i = 0; i < 300; ++i) {  // the sequence number wraps around
    heartbeat(random, framer);
    landing_target(random, framer);
  }
  return 0;
}
