#include "infer/landing/site_selector.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"

namespace alight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string mistakes_of(const std::string& text) {
  try {
    parse_config<SiteSelectionConfig>(text, "x.yaml");
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(SiteSelectionConfig, BadValuesAreRefused) {
  EXPECT_THAT(mistakes_of("{plane_fit: {cell_m: 0.5, radius_m: 0.2}}"),
              HasSubstr("plane_fit.radius_m: must be at least cell_m"));
  EXPECT_THAT(mistakes_of("{method: derivatives, derivatives: {erode_px: 3, dilate_px: 5}}"),
              HasSubstr("derivatives.dilate_px: must not exceed erode_px"));
  EXPECT_THAT(mistakes_of("{method: derivatives, derivatives: {smoothing_px: 4}}"),
              HasSubstr("derivatives.smoothing_px: must be odd"));
  EXPECT_THAT(mistakes_of("{vehicle_radius_m: 3}"),
              HasSubstr("min_radius_m: must be at least vehicle_radius_m"));
  EXPECT_THAT(mistakes_of("{method: guess}"), HasSubstr("method: expected one of plane_fit | derivatives"));
  EXPECT_THAT(mistakes_of("{ranking: {weight_size: 0}}"), HasSubstr("weight_size: must be positive"));
  EXPECT_THAT(mistakes_of("{max_slope: 4}"), HasSubstr("max_slope: no such key"));
  EXPECT_EQ(parse_config<SiteSelectionConfig>("{max_slope_deg: 4}", "x").rules.max_slope_deg, 4);
}

TEST(SiteSelectionConfig, KeysOfTheOtherMethodAreAMistake) {
  EXPECT_EQ(
      mistakes_of("max_slope_deg: 7\nderivatives:\n  erode_px: 7\n"),
      "x.yaml:2: derivatives: belongs to method: derivatives, and the method is plane_fit; remove it or "
      "choose that method");
  EXPECT_EQ(mistakes_of("plane_fit: {guard_m: 1}\nmethod: derivatives\n"),
            "x.yaml:1: plane_fit: belongs to method: plane_fit, and the method is derivatives; remove it or "
            "choose that method");
  EXPECT_EQ(mistakes_of("method: derivatives\nderivatives: {erode_px: 7}\n"), "");
  EXPECT_EQ(mistakes_of("plane_fit: {guard_m: 1}\n"), "");
}

TEST(SiteSelectionConfig, WhatIsPrintedReadsBack) {
  SiteSelectionConfig config;
  config.derivatives.erode_px = 9;
  config.plane_fit.guard_m = 0.9;
  const std::string planes = print_config(config);
  EXPECT_THAT(planes, Not(HasSubstr("erode_px")));
  EXPECT_EQ(parse_config<SiteSelectionConfig>(planes, "x").plane_fit.guard_m, 0.9);
  config.method = LandingMethod::kDerivatives;
  const std::string derivatives = print_config(config);
  EXPECT_THAT(derivatives, Not(HasSubstr("guard_m")));
  EXPECT_EQ(parse_config<SiteSelectionConfig>(derivatives, "x").derivatives.erode_px, 9);
}

}  // namespace
}  // namespace alight
