#include "train/evaluation/self/self_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "train/evaluation/self/self_figure.hpp"
#include "train/evaluation/self/self_markdown.hpp"

namespace alight {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

MapScores scored_map(const std::string& flight, bool good, double holdout_median, Verdict stereo,
                     Verdict holdout) {
  MapScores map;
  map.flight = flight;
  map.depth_m = 15;
  map.share_within = {good ? 1.0 : 0.25, 1.0};
  map.good = {good, true};
  map.stereo.sim = 0.5;
  map.stereo.sim_d = 0.75;
  map.stereo.sim_pred = good ? 0.75 : 0.5625;
  map.stereo.share = 0.5;
  map.holdout.points = 500;
  map.holdout.median_relative = map.holdout.rms_relative = holdout_median;
  map.stereo_verdict = stereo;
  map.holdout_verdict = holdout;
  return map;
}

/// Two good maps, two bad ones; the hold-out test is right, the stereo test abstains on one and errs on another.
SelfReport small_self_report() {
  SelfReport report;
  report.config.good = {{0.9, 0.1, 0.01}, {0.2, 0.1, 0.01}};
  report.command = "alight-evaluate self --every 7";
  report.maps = {scored_map("a_1", true, 0.001, Verdict::kAccept, Verdict::kAccept),
                 scored_map("a_1", false, 0.1, Verdict::kAccept, Verdict::kReject),
                 scored_map("b_1", true, 0.002, Verdict::kNoEvidence, Verdict::kAccept),
                 scored_map("b_1", false, 0.2, Verdict::kReject, Verdict::kReject)};
  report.maps.back().origin = MapOrigin::kTooFar;
  return report;
}

const Criterion& criterion(const std::string& title) {
  return *std::find_if(criteria().begin(), criteria().end(),
                       [&](const Criterion& c) { return c.title == title; });
}

DecisionRates rates(const SelfReport& report, const std::string& title) {
  const auto found = std::find_if(decisions().begin(), decisions().end(),
                                  [&](const Decision& d) { return d.title == title; });
  return rates_of(chosen_maps(report, false), *found, report.config.image.self_evaluation);
}

TEST(Criteria, AreThePapersMargins) {
  const SelfReport report = small_self_report();
  const SelfEvaluationConfig& tests = report.config.image.self_evaluation;
  EXPECT_DOUBLE_EQ(criterion("paper, rule 1").score(report.maps[0], tests), 0.75 - 0.625);
  EXPECT_DOUBLE_EQ(criterion("paper, rule 2").score(report.maps[0], tests), 0.75 - 0.5 - 0.2);
  EXPECT_DOUBLE_EQ(criterion("paper, either rule").score(report.maps[0], tests), 0.125);
  EXPECT_DOUBLE_EQ(criterion("hold-out median").score(report.maps[1], tests), -0.1);
}

TEST(Criteria, MissingScoresAreNoEvidence) {
  MapScores map = small_self_report().maps[0];
  map.stereo.sim_d.reset();
  map.holdout.points = 99;
  const SelfEvaluationConfig tests;
  const double none = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(criterion("paper, rule 1").score(map, tests), none);
  EXPECT_DOUBLE_EQ(criterion("paper, either rule").score(map, tests), 0.75 - 0.5 - 0.2);
  EXPECT_EQ(criterion("probe (peak)").score(map, tests), none);
  EXPECT_EQ(criterion("hold-out RMS").score(map, tests), none);
  map.stereo.share = 0.01;
  EXPECT_EQ(criterion("paper, rule 2").score(map, tests), none);
}

TEST(Decisions, RatesOfAcceptedGoodAndBadMaps) {
  const SelfReport report = small_self_report();
  const DecisionRates stereo = rates(report, "stereo");
  EXPECT_EQ(stereo.recall, 0.5);
  EXPECT_EQ(stereo.false_accept_rate, 0.5);
  EXPECT_EQ(stereo.no_evidence, 0.25);
  EXPECT_EQ(rates(report, "lidar_holdout").recall, 1);
  EXPECT_EQ(rates(report, "lidar_holdout").false_accept_rate, 0);
  EXPECT_EQ(rates(report, "either").recall, 1);
  EXPECT_EQ(rates(report, "either").false_accept_rate, 0.5);
  EXPECT_EQ(rates(report, "both").recall, 1);
  EXPECT_EQ(rates(report, "both").false_accept_rate, 0);
  EXPECT_EQ(rates(report, "paper's rules alone").recall, 1);
  EXPECT_EQ(rates(report, "paper's rules alone").false_accept_rate, 0);
}

TEST(SelfReport, TheDocumentHoldsCommandDefinitionsAndTables) {
  const std::string text = to_markdown(small_self_report());
  EXPECT_THAT(text, AllOf(HasSubstr("alight-evaluate self --every 7"), HasSubstr("3 maps, 2 of them good"),
                          HasSubstr("4 maps, 2 of them good"), HasSubstr("90 % of the pixels"),
                          HasSubstr("| hold-out median | 1.000 ± 0.000 | 0.0 % | 0 |"),
                          HasSubstr("| probe (peak) | 0.500 ± 0.000 | - | 4 |")));
  EXPECT_THAT(text, AllOf(HasSubstr("| both | 100.0 % | 0.0 % | 0.0 % |"),
                          HasSubstr("| stereo | 50.0 % | 50.0 % | 25.0 % |"),
                          HasSubstr("| from 10 to 20 m | 4 | 2 |"), HasSubstr("| b | 2 | 1 |"),
                          HasSubstr("## Another definition of good"), HasSubstr("4 maps, 4 of them good")));
}

TEST(SelfReport, OneLineAMapInTheScores) {
  const std::string text = to_csv(small_self_report());
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 5);
  EXPECT_THAT(text,
              HasSubstr("\nb_1,0,0,too_far,15,0.25,0,1,1,0.5,0.75,0.5625,0.5,,500,0.2,0.2,reject,reject\n"));
}

TEST(SelfReport, TheFigureShowsCurvesAndNeedsBothKinds) {
  SelfReport report = small_self_report();
  const cv::Mat figure = draw_roc(report);
  EXPECT_EQ(figure.type(), CV_8UC3);
  EXPECT_EQ(figure.cols, 1200);
  cv::Mat colored;
  cv::extractChannel(figure, colored, 0);
  cv::Mat red;
  cv::extractChannel(figure, red, 2);
  EXPECT_GT(cv::countNonZero(red > colored + 100), 500);  // the red curve of the hold-out test
  for (MapScores& map : report.maps) map.good = {true, true};
  EXPECT_THROW(draw_roc(report), DataError);
}

}  // namespace
}  // namespace alight
