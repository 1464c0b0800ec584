#include "sensors/poses/packet_window.hpp"

#include <gtest/gtest.h>

namespace alight {
namespace {

constexpr std::int64_t kMs = 1'000'000;

WorldPacketPtr packet_of(std::int64_t end_ms, int points = 10) {
  auto packet = std::make_shared<WorldPacket>();
  packet->end_ns = end_ms * kMs;
  packet->begin_ns = (end_ms - 100) * kMs;
  packet->duration_s = 0.1;
  packet->points.resize(static_cast<std::size_t>(points));
  return packet;
}

std::vector<std::int64_t> ends_ms(const std::vector<WorldPacketPtr>& packets) {
  std::vector<std::int64_t> ends;
  for (const auto& packet : packets) ends.push_back(packet->end_ns / kMs);
  return ends;
}

TEST(PacketWindow, GivesTheNewestPastFirstAndOneMoreToHoldOut) {
  PacketWindow window(1000);
  for (const int end : {1000, 1100, 1200, 1300, 1400, 1500}) window.add(packet_of(end));
  EXPECT_EQ(ends_ms(window.before(1450 * kMs, 0.2, 10)), (std::vector<std::int64_t>{1400, 1300, 1200}));
  EXPECT_EQ(ends_ms(window.before(1400 * kMs, 0.1, 10)), (std::vector<std::int64_t>{1400, 1300}));
  EXPECT_EQ(ends_ms(window.after(1400 * kMs)), (std::vector<std::int64_t>{1500}));
  EXPECT_EQ(ends_ms(window.before(1450 * kMs, 5, 0.3)), (std::vector<std::int64_t>{1400, 1300}));
}

TEST(PacketWindow, MemoryIsBoundedByTimeAndByPoints) {
  PacketWindow window(95);
  for (int end = 100; end <= 100000; end += 100) window.add(packet_of(end));
  EXPECT_EQ(window.packets(), 9U);
  EXPECT_EQ(window.points(), 90U);
  window.forget_before(99700 * kMs);
  EXPECT_EQ(window.packets(), 4U);
  window.add(packet_of(100100, 5000));  // larger than the bound: kept alone
  EXPECT_EQ(window.packets(), 1U);
}

TEST(PacketWindow, LatePacketsFindTheirPlace) {
  PacketWindow window(1000);
  for (const int end : {1000, 1200, 1100}) window.add(packet_of(end));
  EXPECT_EQ(ends_ms(window.after(0)), (std::vector<std::int64_t>{1000, 1100, 1200}));
}

TEST(PacketWindow, ProjectsOnlyItsSpanOfTime) {
  const PinholeIntrinsics intrinsics{10, 10, 4.5, 4.5, 10, 10};
  const auto packet = [](std::vector<WorldPoint> points) {
    WorldPacket world;
    world.begin_ns = points.front().t_ns;
    world.end_ns = points.back().t_ns;
    world.points = std::move(points);
    return std::make_shared<WorldPacket>(std::move(world));
  };
  PacketWindow window;
  window.add(packet({{0, {0, 0, 5}}, {100, {1, 0, 5}}}));
  window.add(packet({{200, {-1, 0, 5}}, {300, {0, 1, 5}}}));
  const auto count = [&](std::int64_t begin_ns, std::int64_t end_ns) {
    SparseDepth out = SparseDepth::empty(intrinsics.size());
    return window.project(begin_ns, end_ns, Eigen::Isometry3d::Identity(), intrinsics, 0, {0.5, 100}, out);
  };
  EXPECT_EQ(count(0, 300), 4);
  EXPECT_EQ(count(1, 299), 2);
  EXPECT_EQ(count(100, 100), 1);
  EXPECT_EQ(count(301, 400), 0);
  window.forget_before(101);
  EXPECT_EQ(count(0, 300), 2);
}

}  // namespace
}  // namespace alight
