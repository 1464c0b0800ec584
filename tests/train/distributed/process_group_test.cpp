#include "train/distributed/process_group.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/train/distributed/thread_group.hpp"

namespace alight {
namespace {

using test::in_group;

TEST(ProcessGroup, OneProcessDoesNothing) {
  const ProcessGroup group;
  torch::Tensor x = torch::ones({2});
  group.all_reduce_sum({x});
  group.all_reduce_mean({x});
  group.broadcast({x});
  group.barrier();
  group.expect_same("x", 1);
  EXPECT_TRUE(torch::equal(x, torch::ones({2})));
  EXPECT_EQ(group.of_first_rank(3), 3);
  bool worked = false;
  group.on_first_rank([&](const auto& alive) {
    alive();
    worked = true;
  });
  EXPECT_TRUE(worked);
}

TEST(ProcessGroup, ReducesTensorsOfAllShapesAndTypesInPlace) {
  in_group(3, [](const ProcessGroup& group) {
    const double r = group.rank();
    torch::Tensor map = torch::full({1, 2, 2, 2}, r).contiguous(torch::MemoryFormat::ChannelsLast);
    map.select(1, 1).fill_(10 * r);
    torch::Tensor count = torch::full({}, group.rank(), torch::kInt64);
    torch::Tensor learned = torch::full({2}, r).requires_grad_();
    group.all_reduce_sum({map, torch::Tensor(), count, learned});
    EXPECT_TRUE(torch::equal(map.select(1, 0), torch::full({1, 2, 2}, 3.0)));
    EXPECT_TRUE(torch::equal(map.select(1, 1), torch::full({1, 2, 2}, 30.0)));
    EXPECT_EQ(count.item<std::int64_t>(), 3);
    EXPECT_TRUE(torch::equal(learned.detach(), torch::full({2}, 3.0)));
    EXPECT_THAT(group.mean({r, 2 * r}), testing::ElementsAre(1, 2));
  });
}

TEST(ProcessGroup, AllGetWhatTheFirstHas) {
  in_group(2, [](const ProcessGroup& group) {
    torch::Tensor x = torch::full({2}, group.rank() + 5.0);
    group.broadcast({x});
    EXPECT_TRUE(torch::equal(x, torch::full({2}, 5.0)));
    EXPECT_EQ(group.of_first_rank(group.rank() + 7.5), 7.5);
  });
}

TEST(ProcessGroup, SaysWhoHasAnotherValue) {
  in_group(2, [](const ProcessGroup& group) { group.expect_same("the step", 4); });
  try {
    in_group(2, [](const ProcessGroup& group) { group.expect_same("the step", 4 + group.rank()); });
    FAIL() << "expected a DataError";
  } catch (const DataError& e) {
    EXPECT_THAT(e.what(), testing::StartsWith("process 1 of 2: the step is 5 here and 4 for process 0"));
  }
}

TEST(ProcessGroup, OthersWaitForTheFirstHoweverLongItWorks) {
  std::atomic<bool> done{false};
  in_group(3, [&](const ProcessGroup& group) {
    group.on_first_rank([&](const auto& alive) {
      EXPECT_EQ(group.rank(), 0);
      for (int i = 0; i < 12; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        alive();
      }
      done = true;
    });
    EXPECT_TRUE(done);
  });
}

/// The others are gone.
class DeadCollectives : public Collectives {
 public:
  torch::Device device() const override { return torch::kCPU; }
  void sum(torch::Tensor&) override { throw std::runtime_error("connection closed\nstack trace"); }
  void broadcast(torch::Tensor&) override { throw std::runtime_error("connection closed"); }
};

TEST(ProcessGroup, MessageSaysWhatFailedWhereAndHowToGoOn) {
  ProcessPlace place;
  place.rank = 1;
  place.size = 4;
  const ProcessGroup group(place, std::make_shared<DeadCollectives>());
  try {
    group.barrier();
    FAIL() << "expected a DataError";
  } catch (const DataError& e) {
    EXPECT_THAT(e.what(),
                testing::AllOf(testing::StartsWith("process 1 of 4: averaging"),
                               testing::HasSubstr("(connection closed)"), testing::HasSubstr("--resume"),
                               testing::Not(testing::HasSubstr("trace"))));
  }
}

}  // namespace
}  // namespace alight
