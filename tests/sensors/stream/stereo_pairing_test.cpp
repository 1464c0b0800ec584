#include "sensors/stream/stereo_pairing.hpp"

#include <gtest/gtest.h>

namespace alight {
namespace {

UndecodedImage image_at(std::int64_t t_ns) {
  return {t_ns, nullptr, {static_cast<std::uint8_t>(t_ns % 256)}, 0};
}

TEST(StereoPairer, PairsWithinTheTolerance) {
  StereoPairer pairer(10);
  EXPECT_FALSE(pairer.add_left(image_at(100)));
  const auto pair = pairer.add_right(image_at(110));
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->first.t_ns, 100);
  EXPECT_EQ(pair->first.bytes.at(0), 100);
  EXPECT_EQ(pair->second.t_ns, 110);
  EXPECT_EQ(pair->second.bytes.at(0), 110);
  EXPECT_EQ(pairer.unpaired(), 0);
}

TEST(StereoPairer, RightMayComeFirstAndLate) {
  StereoPairer pairer(0);
  EXPECT_FALSE(pairer.add_right(image_at(1)));
  EXPECT_FALSE(pairer.add_right(image_at(2)));
  ASSERT_TRUE(pairer.add_left(image_at(1)));
  ASSERT_TRUE(pairer.add_left(image_at(2)));
}

TEST(StereoPairer, CountsWhatHasNoPartner) {
  StereoPairer pairer(10);
  pairer.add_left(image_at(100));
  EXPECT_FALSE(pairer.add_right(image_at(111)));  // one beyond the tolerance: left 100 is lost
  EXPECT_EQ(pairer.unpaired(), 1);
  EXPECT_EQ(pairer.waiting(), 1);
  ASSERT_TRUE(pairer.add_left(image_at(112)));
  EXPECT_EQ(pairer.waiting(), 0);
}

TEST(StereoPairer, ADeadCameraDoesNotFillTheMemory) {
  StereoPairer pairer(10);
  for (int i = 0; i < 1000; ++i) pairer.add_left(image_at(i * 100));
  EXPECT_LE(pairer.waiting(), 100);
  EXPECT_EQ(pairer.waiting() + pairer.unpaired(), 1000);
}

}  // namespace
}  // namespace alight
