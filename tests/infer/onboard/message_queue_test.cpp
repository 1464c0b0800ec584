#include "infer/onboard/message_queue.hpp"

#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace alight {
namespace {

StereoFrame image(std::int64_t t_ns) {
  StereoFrame frame;
  frame.t_ns = t_ns;
  return frame;
}

std::int64_t time_of(const MessageQueue::Item& item) {
  return std::visit([](const auto& typed) { return typed.t_ns; }, item.message);
}

TEST(MessageQueue, FirstInFirstOut) {
  MessageQueue queue({});
  queue.push(AttitudeSample{1, {}});
  queue.push(image(2));
  queue.push(HeightSample{3, 4.0});
  queue.close();
  for (std::int64_t t_ns = 1; t_ns <= 3; ++t_ns) EXPECT_EQ(time_of(*queue.pop()), t_ns);
  EXPECT_FALSE(queue.pop());
  EXPECT_TRUE(queue.dropped().empty());
}

TEST(MessageQueue, TheOldestImageGoesAndPosesStay) {
  MessageQueue queue({2, 50, 2000});
  for (std::int64_t t_ns = 0; t_ns < 10; ++t_ns) {
    queue.push(image(t_ns));
    queue.push(AttitudeSample{t_ns, {}});
  }
  queue.close();
  std::vector<std::int64_t> images, poses;
  while (const auto item = queue.pop()) {
    (std::holds_alternative<StereoFrame>(item->message) ? images : poses).push_back(time_of(*item));
  }
  EXPECT_EQ(images, (std::vector<std::int64_t>{8, 9}));
  EXPECT_EQ(poses.size(), 10U);
  ASSERT_EQ(queue.dropped().size(), 1U);
  EXPECT_EQ(queue.dropped().begin()->second, 8);
}

TEST(MessageQueue, EveryKindIsBounded) {
  MessageQueue queue({1, 2, 3});
  for (std::int64_t t_ns = 0; t_ns < 100; ++t_ns) {
    queue.push(image(t_ns));
    LidarPacket packet;
    packet.t_ns = t_ns;
    queue.push(packet);
    queue.push(HeightSample{t_ns, 1.0});
  }
  EXPECT_EQ(queue.size(), 6U);
}

TEST(MessageQueue, NothingIsTakenAfterClose) {
  MessageQueue queue({});
  queue.close();
  queue.push(image(1));
  EXPECT_FALSE(queue.pop());
}

/// Several producers and one consumer: what was pushed was popped or counted as dropped, each producer's in its order.
TEST(MessageQueue, ManyProducersLoseNothingUncounted) {
  constexpr int kProducers = 4;
  constexpr std::int64_t kEach = 2000;
  MessageQueue queue({4, 4, 64});
  std::vector<std::thread> producers;
  for (std::int64_t producer = 0; producer < kProducers; ++producer) {
    producers.emplace_back([&queue, producer] {
      for (std::int64_t i = 0; i < kEach; ++i) queue.push(AttitudeSample{producer * kEach + i, {}});
    });
  }
  std::int64_t popped = 0;
  std::vector<std::int64_t> last(kProducers, -1);
  std::thread consumer([&] {
    while (const auto item = queue.pop()) {
      const auto producer = static_cast<std::size_t>(time_of(*item) / kEach);
      EXPECT_GT(time_of(*item), last[producer]);
      last[producer] = time_of(*item);
      ++popped;
    }
  });
  for (std::thread& producer : producers) producer.join();
  queue.close();
  consumer.join();
  std::int64_t dropped = 0;
  for (const auto& [reason, count] : queue.dropped()) dropped += count;
  EXPECT_EQ(popped + dropped, kProducers * kEach);
}

}  // namespace
}  // namespace alight
