#include "dataset/build/sample_writer.hpp"

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace alight {
namespace {

TEST(SampleWriter, RunsEveryJobInOrder) {
  std::vector<int> done;
  SampleWriter writer(1, 2);
  for (int i = 0; i < 100; ++i) writer.add([&done, i] { done.push_back(i); });
  writer.finish();
  ASSERT_EQ(done.size(), 100u);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(done[static_cast<std::size_t>(i)], i);
}

TEST(SampleWriter, AFailureComesBackAndEndsTheWork) {
  int later = 0;
  SampleWriter writer(1, 1000);
  writer.add([] { throw std::runtime_error("disk full"); });
  EXPECT_THROW(
      {
        for (int i = 0; i < 1000; ++i) writer.add([&later] { ++later; });
        writer.finish();
      },
      std::runtime_error);
  EXPECT_EQ(later, 0);
}

TEST(SampleWriter, EndsWithoutFinish) {
  SampleWriter writer(3, 10);
  writer.add([] {});
}

}  // namespace
}  // namespace alight
