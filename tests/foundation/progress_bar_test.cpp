#include "foundation/progress_bar.hpp"

#include <spdlog/spdlog.h>

#include <gtest/gtest.h>

namespace alight {
namespace {

std::string printed_at(spdlog::level::level_enum level) {
  const auto before = spdlog::get_level();
  spdlog::set_level(level);
  testing::internal::CaptureStderr();
  {
    ProgressBar progress("flights", 4, "flights");
    progress.advance(3, "the third");
  }
  spdlog::set_level(before);
  return testing::internal::GetCapturedStderr();
}

TEST(ProgressBar, TellsHowFarTheWorkIs) {
  const std::string printed = printed_at(spdlog::level::info);
  EXPECT_NE(printed.find("flights  [=================="), std::string::npos) << printed;
  EXPECT_NE(printed.find("75 %"), std::string::npos) << printed;
  EXPECT_NE(printed.find("the third"), std::string::npos) << printed;
}

TEST(ProgressBar, IsSilentWhereOnlyWarningsAreWanted) { EXPECT_EQ(printed_at(spdlog::level::warn), ""); }

}  // namespace
}  // namespace alight
