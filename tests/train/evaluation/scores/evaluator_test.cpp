#include "train/evaluation/scores/evaluator.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/train/evaluation/evaluation_scenes.hpp"
#include "train/evaluation/table.hpp"

namespace alight {
namespace {

torch::Tensor perfect(const DepthSample& sample, const torch::Tensor&) { return sample.dense; }
torch::Tensor a_tenth_too_far(const DepthSample& sample, const torch::Tensor&) { return sample.dense * 1.1; }
torch::Tensor nothing(const DepthSample&, const torch::Tensor& fed_m) { return torch::zeros_like(fed_m); }
torch::Tensor echo(const DepthSample&, const torch::Tensor& fed_m) { return fed_m.clone(); }

EvaluationConfig small_config() {
  EvaluationConfig config;
  config.shares = {0, 0.3, 1};
  config.windows_s = {0.5};
  config.threads = 2;
  return config;
}

/// Two samples of flight "a", one of "b".
const std::vector<EvaluationItem> kItems{{0, "a"}, {1, "a"}, {2, "b"}};

EvaluationReport report_of(DepthMethods methods, SampleSource& source,
                           const EvaluationConfig& config = small_config()) {
  return evaluate(methods, source, kItems, test::scene_rig(), config);
}

DepthMethods list(const char* name, test::FakeMethod::Function function) {
  DepthMethods methods;
  methods.push_back(test::fake(name, std::move(function)));
  return methods;
}

TEST(Evaluator, APerfectMethodHasNoErrorAnywhere) {
  auto source = test::scenes(3);
  const EvaluationReport report = report_of(list("perfect", perfect), source);
  int filled = 0;
  for (const EvaluationCell& cell : report.cells.at(0)) {
    for (const FlightErrors& errors : cell.regions) {
      if (errors.flights().empty()) continue;
      ++filled;
      EXPECT_EQ(errors.pooled().value(Metric::kRmse), 0);
      EXPECT_EQ(errors.pooled().value(Metric::kDelta), 100);
      EXPECT_EQ(errors.pooled().substituted(), 0);
    }
    EXPECT_EQ(cell.at(Region::kDense).pooled().pixels(), 3 * 48 * 48);
  }
  EXPECT_GE(filled, 4 * 7 - 1);  // all but held_out where all points are fed, and a band or more
}

TEST(Evaluator, ARelativeErrorIsFoundInEveryRegionAndFlight) {
  auto source = test::scenes(3);
  const EvaluationReport report = report_of(list("far", a_tenth_too_far), source);
  for (const Region region :
       {Region::kAll, Region::kDense, Region::kInsideFov, Region::kOutsideFov, Region::kNearEdges}) {
    const FlightErrors& errors = report.cells[0][0].at(region);
    EXPECT_EQ(errors.flights().size(), 2U) << name(region);
    EXPECT_NEAR(errors.mean(Metric::kRel).mean, 100, 1e-3) << name(region);
    EXPECT_NEAR(errors.mean(Metric::kRel).standard_error, 0, 1e-3) << name(region);
  }
}

TEST(Evaluator, MethodsSeeTheFedPointsAndNoOthers) {
  auto source = test::scenes(3);
  const EvaluationReport report = report_of(list("echo", echo), source);
  for (std::size_t f = 0; f < report.feedings.size(); ++f) {
    const PixelErrors all = report.cells[0][f].at(Region::kAll).pooled();
    const PixelErrors held_out = report.cells[0][f].at(Region::kHeldOut).pooled();
    EXPECT_EQ(all.substituted(), held_out.pixels()) << report.feedings[f].name();
    EXPECT_EQ(held_out.substituted(), held_out.pixels()) << report.feedings[f].name();
  }
  EXPECT_EQ(report.cells[0][0].at(Region::kHeldOut).pooled().pixels(),
            report.cells[0][0].at(Region::kAll).pooled().pixels());
  EXPECT_TRUE(report.cells[0][2].at(Region::kHeldOut).flights().empty()) << "P=1 holds nothing out";
  EXPECT_GT(report.cells[0][3].at(Region::kHeldOut).pooled().pixels(), 0) << "0.5 s";
}

TEST(Evaluator, TheAltitudePlaneStandsInForAMethodThatKnowsNothing) {
  auto source = test::scenes(3);
  DepthMethods methods = list("nothing", nothing);
  methods.push_back(make_altitude_plane({}));
  const EvaluationReport report = report_of(std::move(methods), source);
  const PixelErrors none = report.cells[0][1].at(Region::kDense).pooled();
  const PixelErrors plane = report.cells[1][1].at(Region::kDense).pooled();
  EXPECT_EQ(none.substituted(), none.pixels());
  EXPECT_EQ(plane.substituted(), 0);
  EXPECT_EQ(none.value(Metric::kRmse), plane.value(Metric::kRmse));
  EXPECT_GE(none.value(Metric::kRmse), 1000) << "the take-off place lies a metre lower";
}

TEST(Evaluator, WithoutAHeightNobodyStandsIn) {
  std::vector<DepthSample> samples;
  for (int i = 0; i < 3; ++i) {
    samples.push_back(test::scene_sample(i));
    samples.back().height_m = std::nan("");
  }
  test::MemorySource source(std::move(samples));
  const PixelErrors errors =
      report_of(list("nothing", nothing), source).cells[0][1].at(Region::kDense).pooled();
  EXPECT_EQ(errors.pixels(), 0);
  EXPECT_EQ(errors.unknown(), 3 * 48 * 48);
}

TEST(Evaluator, TheResultDoesNotDependOnTheThreads) {
  auto source = test::scenes(3);
  EvaluationConfig config = small_config();
  config.threads = 1;
  const std::string one = to_json(evaluate(make_baselines({}), source, kItems, test::scene_rig(), config));
  config.threads = 5;
  EXPECT_EQ(to_json(evaluate(make_baselines({}), source, kItems, test::scene_rig(), config)), one);
}

/// The right image of a hovering pair is the left one moved by less than a pixel, so true depth reconstructs it well and
/// depth that is far too small does not.
TEST(Evaluator, SimilarityIsThatOfTheReconstructedRightImage) {
  std::vector<DepthSample> samples;
  for (int i = 0; i < 3; ++i) {
    samples.push_back(test::scene_sample(i));
    samples.back().left = test::random_image(48, 48);
    samples.back().right = samples.back().left.clone();
    samples.back().has_right = i < 2;
  }
  test::MemorySource source(std::move(samples));
  DepthMethods methods = list("far away", [](const DepthSample& s, const torch::Tensor&) {
    return torch::full_like(s.dense, 1000.0);  // no disparity
  });
  methods.push_back(test::fake("at hand", [](const DepthSample& s, const torch::Tensor&) {
    return torch::full_like(s.dense, 0.1);  // 4 px
  }));
  const EvaluationReport report = report_of(std::move(methods), source);
  EXPECT_EQ(report.cells[0][1].similarity.samples(), 2);
  EXPECT_GT(report.cells[0][1].similarity.pooled(), 0.99);
  EXPECT_LT(report.cells[1][1].similarity.pooled(), 0.5);
  EXPECT_EQ(report.cells[0][3].similarity.samples(), 0) << "shares only";
}

TEST(Evaluator, TheFirstMethodsErrorsAreKeptBySample) {
  auto source = test::scenes(3);
  int calls = 0;
  DepthMethods methods = list("far", a_tenth_too_far);
  const EvaluationReport report =
      evaluate(methods, source, kItems, test::scene_rig(), small_config(), [&] { ++calls; });
  EXPECT_EQ(calls, 3);
  ASSERT_EQ(report.first_method.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const torch::Tensor error_m = source.get(i).dense * 0.1;
    EXPECT_EQ(report.first_method[i].item.index, i);
    EXPECT_NEAR(report.first_method[i].rmse_mm, 1000 * error_m.pow(2).mean().sqrt().item<double>(), 0.5);
  }
}

class BrokenSource : public test::MemorySource {
 public:
  using test::MemorySource::MemorySource;
  DepthSample get(std::size_t index) override {
    if (index == 1) throw DataError("b/000001.png: is damaged");
    return test::MemorySource::get(index);
  }
};

TEST(Evaluator, ASampleThatCannotBeReadEndsTheEvaluation) {
  BrokenSource source({test::scene_sample(0), test::scene_sample(1), test::scene_sample(2)});
  EXPECT_THROW(report_of(list("perfect", perfect), source), DataError);
}

}  // namespace
}  // namespace alight
