#include "infer/onboard/stage_queue.hpp"

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

namespace alight {
namespace {

StageEvent depth_of(std::int64_t t_ns) {
  StageEvent event;
  event.depths.emplace_back();
  event.depths.back().sensed.depth.t_ns = t_ns;
  return event;
}

StageEvent message() {
  StageEvent event;
  event.message = std::make_shared<const LogMessage>(StereoFrame{});
  return event;
}

TEST(StageQueue, GivesEverythingInOrderAndWaitsWhileDepthIsNotWorkedOff) {
  StageQueue queue;
  constexpr std::int64_t kDepths = 200;
  std::atomic<std::int64_t> pushed{0};
  std::thread depth_stage([&] {
    for (std::int64_t i = 0; i < kDepths; ++i) {
      queue.push(message());
      queue.push(depth_of(i));
      pushed = i + 1;
    }
    queue.close();
  });
  std::int64_t depths = 0, messages = 0;
  while (const auto event = queue.pop()) {
    messages += event->message ? 1 : 0;
    if (event->depths.empty()) continue;
    EXPECT_EQ(messages, depths + 1) << "a message comes before its depth";
    EXPECT_EQ(event->depths.front().sensed.depth.t_ns, depths++);
    // What was taken, what waits, and the one that may have come since it was taken.
    EXPECT_LE(pushed.load(), depths + static_cast<std::int64_t>(StageQueue::kMostDepths) + 1);
  }
  depth_stage.join();
  EXPECT_EQ(depths, kDepths);
  EXPECT_EQ(messages, kDepths);
}

TEST(StageQueue, NobodyWaitsWhenItIsAbandoned) {
  StageQueue queue;
  std::thread depth_stage([&] {
    for (int i = 0; i < 10; ++i) queue.push(depth_of(i));
  });
  ASSERT_TRUE(queue.pop());
  queue.abandon();
  depth_stage.join();
  EXPECT_FALSE(queue.pop());
}

}  // namespace
}  // namespace alight
