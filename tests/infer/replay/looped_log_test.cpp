#include "infer/replay/looped_log.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "tests/infer/bag_of_flight.hpp"
#include "tests/infer/fakes.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {
namespace fs = std::filesystem;

TEST(LoopedLog, TimesGoOnOverTheRounds) {
  const test::ScratchFolder folder;
  const fs::path path = folder / "flight.bag";
  const Rig rig = fakes::small_rig();
  fakes::LevelWorld world(12.0);
  fakes::write_bag(path.string(), rig, fakes::flight(world, {1.0}));
  LogConfig config;
  config.height_topic.reset();
  std::vector<std::int64_t> images_ns, attitudes_ns, packet_begins_ns;
  LoopedLog log(path, rig, config, 3);
  LogMessage message;
  std::int64_t receive_ns = 0;
  while (log.next(message)) {
    EXPECT_GE(log.receive_ns(), receive_ns);
    receive_ns = log.receive_ns();
    if (const auto* frame = std::get_if<StereoFrame>(&message)) images_ns.push_back(frame->t_ns);
    if (const auto* attitude = std::get_if<AttitudeSample>(&message)) attitudes_ns.push_back(attitude->t_ns);
    if (const auto* packet = std::get_if<LidarPacket>(&message))
      packet_begins_ns.push_back(packet->returns[0].t_ns);
  }
  for (const auto* times_ns : {&images_ns, &attitudes_ns, &packet_begins_ns}) {
    ASSERT_GT(times_ns->size(), 20U);
    EXPECT_EQ(times_ns->size() % 3, 0U);
    for (std::size_t i = 1; i < times_ns->size(); ++i) EXPECT_GT((*times_ns)[i], (*times_ns)[i - 1]);
  }
  EXPECT_EQ(log.consumed(), log.messages());
}

}  // namespace
}  // namespace alight
