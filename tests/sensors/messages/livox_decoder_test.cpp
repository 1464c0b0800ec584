#include "sensors/messages/livox_decoder.hpp"

#include <gtest/gtest.h>

namespace alight {
namespace {

constexpr NoisePoints kAll[] = {NoisePoints::kKeep, NoisePoints::kDropCertain, NoisePoints::kDropLikely};

TEST(LivoxNoise, FirstDriversSensorsMarkByConfidenceThatItIsNoise) {
  for (const int first : {0, 2}) {
    const auto tag = [&](int bits) { return static_cast<std::uint8_t>(bits << first); };
    EXPECT_TRUE(is_noise_of_livox(tag(1), NoisePoints::kDropCertain))
        << "high confidence, from bit " << first;
    EXPECT_TRUE(is_noise_of_livox(tag(1), NoisePoints::kDropLikely));
    EXPECT_FALSE(is_noise_of_livox(tag(2), NoisePoints::kDropCertain)) << "moderate";
    EXPECT_TRUE(is_noise_of_livox(tag(2), NoisePoints::kDropLikely));
    EXPECT_FALSE(is_noise_of_livox(tag(3), NoisePoints::kDropLikely)) << "low, or reserved";
  }
  for (int echo = 0; echo < 4; ++echo) {
    for (const NoisePoints noise : kAll)
      EXPECT_FALSE(is_noise_of_livox(static_cast<std::uint8_t>(echo << 4), noise)) << "number of the return";
  }
}

TEST(LivoxNoise, SecondDriversSensorsMarkByConfidenceInThePoint) {
  for (const int first : {0, 2, 4}) {
    const auto tag = [&](int bits) { return static_cast<std::uint8_t>(bits << first); };
    EXPECT_TRUE(is_noise_of_livox2(tag(2), NoisePoints::kDropCertain))
        << "low confidence, from bit " << first;
    EXPECT_FALSE(is_noise_of_livox2(tag(1), NoisePoints::kDropCertain)) << "moderate";
    EXPECT_TRUE(is_noise_of_livox2(tag(1), NoisePoints::kDropLikely));
    EXPECT_FALSE(is_noise_of_livox2(tag(3), NoisePoints::kDropLikely)) << "reserved";
  }
}

TEST(LivoxNoise, OfUnmarkedPointsAndWhereNoneIsWantedNothingGoes) {
  for (const NoisePoints noise : kAll) {
    EXPECT_FALSE(is_noise_of_livox(0, noise));
    EXPECT_FALSE(is_noise_of_livox2(0, noise));
  }
  for (int tag = 0; tag < 256; ++tag) {
    EXPECT_FALSE(is_noise_of_livox(static_cast<std::uint8_t>(tag), NoisePoints::kKeep));
    EXPECT_FALSE(is_noise_of_livox2(static_cast<std::uint8_t>(tag), NoisePoints::kKeep));
  }
}

}  // namespace
}  // namespace alight
