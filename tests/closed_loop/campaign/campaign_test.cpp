#include "closed_loop/campaign/campaign.hpp"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "closed_loop/campaign/campaign_report.hpp"
#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight::closed_loop {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class CampaignTest : public ::testing::Test {
 protected:
  LandingResult row(int index, Outcome outcome, double safe_radius_m = 5) const {
    LandingResult r;
    r.seed = plan_.first_seed + index;
    r.look = "village";
    r.outcome = outcome;
    r.reason = "a \"quoted\" reason";
    r.duration_s = 30 + index;
    r.safe_radius_m = safe_radius_m;
    if (r.landed()) r.footprint = Footprint{3.5, 0.02, 1.0, 2.25};
    return r;
  }

  const test::ScratchFolder scratch_;
  const fs::path path_ = scratch_ / "campaign";
  CampaignPlan plan_ = [] {
    CampaignPlan plan;
    plan.worlds = 6;
    plan.looks = {"village", "forest"};
    plan.faults = {"none", "LiDAR lost", "position lost"};
    return plan;
  }();
};

TEST_F(CampaignTest, LandingsRunThroughLooksAndFaults) {
  std::set<std::string> seen;
  for (int i = 0; i < 6; ++i) {
    const CampaignLanding landing = planned(plan_, i);
    EXPECT_EQ(landing.seed, plan_.first_seed + i);
    const sim::Fault* fault = landing.fault.fault;
    seen.insert(sim::to_string(landing.look) + " " + (fault != nullptr ? fault->name : "none"));
    if (fault == nullptr) continue;
    EXPECT_GE(landing.fault.at_s, plan_.fault_from_s);
    EXPECT_LT(landing.fault.at_s, plan_.fault_to_s);
    EXPECT_EQ(landing.fault.at_s, planned(plan_, i).fault.at_s);
  }
  EXPECT_EQ(seen.size(), 6u);
}

TEST_F(CampaignTest, FailuresPassOrLastAsPlanned) {
  plan_.looks = {"village"};
  plan_.faults = {"LiDAR lost"};
  EXPECT_FALSE(planned(plan_, 0).fault.lasts_s);
  plan_.fault_lasts_s = {2, 10};
  plan_.lasting_share = 0.25;
  check(plan_);
  int lasting = 0;
  for (int i = 0; i < 400; ++i) {
    const PlannedFault fault = planned(plan_, i).fault;
    lasting += fault.lasts_s ? 0 : 1;
    if (!fault.lasts_s) continue;
    EXPECT_GE(*fault.lasts_s, 2);
    EXPECT_LT(*fault.lasts_s, 10);
    EXPECT_EQ(fault.lasts_s, planned(plan_, i).fault.lasts_s);
  }
  EXPECT_NEAR(lasting, 100, 35);
  plan_.fault_lasts_s = {10, 2};
  EXPECT_THROW(check(plan_), ConfigError);
}

TEST_F(CampaignTest, UnknownNamesAreRefusedWithTheKnownOnes) {
  plan_.looks = {"moon"};
  EXPECT_THROW(check(plan_), ConfigError);
  plan_.looks = {"village"};
  plan_.faults = {"gremlins"};
  try {
    check(plan_);
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_THAT(e.what(), HasSubstr("LiDAR lost"));
  }
}

TEST_F(CampaignTest, GoesOnWhereItWasStopped) {
  LandingResult full = row(1, Outcome::kSafe);
  full.fault = "LiDAR lost";
  full.fault_s = 3.5;
  full.fault_lasts_s = 2.25;
  full.p_end = {1.5, -2, 0.25};
  full.events = {{5, MissionState::kManual, MissionState::kSelect, "automatic mode"}};
  {
    const CampaignFolder folder(path_, plan_, {});
    EXPECT_EQ(folder.missing().size(), 6u);
    folder.append(full);
    folder.append(row(4, Outcome::kGaveUp));
  }
  const CampaignFolder again(path_, plan_, {});
  EXPECT_EQ(again.missing(), (std::vector<int>{0, 2, 3, 5}));
  const auto rows = again.rows();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].outcome, Outcome::kSafe);
  EXPECT_EQ(rows[0].footprint->clearance_m, 2.25);
  EXPECT_EQ(rows[1].reason, "a \"quoted\" reason");
  EXPECT_EQ(to_json(rows[0]), to_json(full));
  plan_.worlds = 8;
  EXPECT_EQ(CampaignFolder(path_, plan_, {}).missing().size(), 6u);
}

TEST_F(CampaignTest, AnotherPlanOrConfigurationIsRefused) {
  const CampaignFolder folder(path_, plan_, {});
  LandConfig other;
  other.mission.confirm_height_m = 8;
  EXPECT_THROW(CampaignFolder(path_, plan_, other), ConfigError);
  plan_.lidar_only = true;
  EXPECT_THROW(CampaignFolder(path_, plan_, {}), ConfigError);
  EXPECT_EQ(print_config(folder.config()), print_config(LandConfig{}));
}

TEST_F(CampaignTest, ADamagedRowIsNamed) {
  const CampaignFolder folder(path_, plan_, {});
  folder.append(row(0, Outcome::kSafe));
  std::ofstream(path_ / "rows.jsonl", std::ios::app) << "{\"seed\":1\n";
  try {
    folder.rows();
    FAIL();
  } catch (const DataError& e) {
    EXPECT_THAT(e.what(), HasSubstr("rows.jsonl:2"));
  }
}

TEST_F(CampaignTest, TheReportCountsWhatTheRowsSay) {
  const std::vector<LandingResult> rows = {row(0, Outcome::kSafe),        row(1, Outcome::kSafe, 1.0),
                                           row(2, Outcome::kUnsafe),      row(3, Outcome::kGaveUp),
                                           row(4, Outcome::kGaveUp, 0.5), row(5, Outcome::kCollided)};
  const std::string page = campaign_report(rows, 3.0);
  // landings, with site, landed safely of those (1 of 4), safe in all, unsafe, collisions, gave up with and without site
  EXPECT_THAT(page, HasSubstr("| all | 6 | 4 | 25.0 % (4.6 to 69.9) | 2 | 1 | 1 | 1 | 1 | 30, 30 |"));
  EXPECT_THAT(page, HasSubstr("UNSAFE ground"));
  EXPECT_THAT(page, HasSubstr("2 of 6 landings"));
}

TEST(Wilson, AgreesWithPublishedValues) {
  // Newcombe 1998, table I: 81 of 263, 15 of 148, 0 of 20, 1 of 29.
  EXPECT_NEAR(wilson(81, 263).low, 0.2553, 5e-5);
  EXPECT_NEAR(wilson(81, 263).high, 0.3662, 5e-5);
  EXPECT_NEAR(wilson(15, 148).low, 0.0624, 5e-5);
  EXPECT_NEAR(wilson(15, 148).high, 0.1605, 5e-5);
  EXPECT_NEAR(wilson(0, 20).low, 0, 1e-12);
  EXPECT_NEAR(wilson(0, 20).high, 0.1611, 5e-5);
  EXPECT_NEAR(wilson(1, 29).low, 0.0061, 5e-5);
  EXPECT_NEAR(wilson(1, 29).high, 0.1718, 5e-5);
  EXPECT_EQ(wilson(0, 0).high, 1);
}

}  // namespace
}  // namespace alight::closed_loop
