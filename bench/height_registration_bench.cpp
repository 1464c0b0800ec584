#include <random>

#include <benchmark/benchmark.h>

#include "geometry/frames.hpp"
#include "infer/depth/height_registration.hpp"

namespace alight {
namespace {

/// 0.1 s of a Livox Mid-40 over level ground from 20 m up, 10,000 points, after a second of it.
void register_packet(benchmark::State& state) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place_m(-6, 6);
  std::normal_distribution<double> noise_m(0, 0.02);
  WorldPacket packet;
  for (int i = 0; i < 10'000; ++i)
    packet.points.push_back({0, {place_m(random), place_m(random), noise_m(random)}});
  HeightRegistration registration;
  const auto next = [&] {
    packet.end_ns += to_nanoseconds(0.1);
    return registration.add(packet);
  };
  for (int i = 0; i < 10; ++i) next();
  for (auto _ : state) benchmark::DoNotOptimize(next());
}
BENCHMARK(register_packet)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace alight
