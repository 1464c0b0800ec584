#include "losses/training_loss.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "losses/ratio_loss.hpp"

namespace alight {
namespace {

LossInputs random_inputs(std::int64_t batch = 2, std::int64_t height = 7, std::int64_t width = 9) {
  torch::manual_seed(1);
  const auto image = [&] { return torch::rand({batch, 3, height, width}); };
  const auto yes = torch::ones({batch}, torch::kBool);
  LossInputs in;
  in.prediction_m = 5 + torch::rand({batch, 1, height, width});
  in.ground_truth_m = (5 + torch::rand_like(in.prediction_m)) * (torch::rand_like(in.prediction_m) < 0.5);
  in.input_m = in.ground_truth_m * (torch::rand_like(in.prediction_m) < 0.5);
  in.left = image();
  in.previous = image();
  in.next = image();
  in.right = image();
  in.has_previous = in.has_next = in.has_right = yes;
  in.T_previous_camera = torch::eye(4).repeat({batch, 1, 1});
  in.T_next_camera = torch::eye(4).repeat({batch, 1, 1});
  in.baseline_m = torch::full({batch}, 0.2);
  in.intrinsics_px = torch::tensor({{10.0F, 10.0F, 4.0F, 3.0F}}).repeat({batch, 1});
  return in;
}

TEST(TrainingLoss, DefaultIsThePapersSum) {
  const LossTerms terms = TrainingLoss()(random_inputs());
  const double expected = terms.depth.item<double>() + terms.ratio.item<double>() +
                          2 * terms.photometric.item<double>() + terms.smoothness.item<double>();
  EXPECT_NEAR(terms.total.item<double>(), expected, 1e-5);
  for (const torch::Tensor& term : {terms.depth, terms.ratio, terms.photometric, terms.smoothness}) {
    EXPECT_GT(term.item<double>(), 0);
  }
}

TEST(TrainingLoss, TermsAreThoseOfTheLosses) {
  const LossInputs in = random_inputs();
  const LossTerms terms = TrainingLoss()(in);
  EXPECT_TRUE(torch::equal(terms.depth, depth_loss(in.prediction_m, in.ground_truth_m)));
  EXPECT_TRUE(torch::equal(terms.ratio, ratio_loss(in.prediction_m, in.ground_truth_m)));
  EXPECT_TRUE(torch::equal(terms.smoothness, smoothness_loss(in.prediction_m, in.left)));
}

TEST(TrainingLoss, SelfSupervisedComparesWithTheInput) {
  const LossInputs in = random_inputs();
  TrainingLossConfig config;
  config.target = LossTarget::kInput;
  EXPECT_TRUE(torch::equal(TrainingLoss(config)(in).depth, depth_loss(in.prediction_m, in.input_m)));
}

TEST(TrainingLoss, HeldOutComparesWithWhatWasNotFed) {
  const LossInputs in = random_inputs();
  TrainingLossConfig config;
  config.target = LossTarget::kHeldOut;
  const torch::Tensor held_out = in.ground_truth_m - in.input_m;
  EXPECT_TRUE(torch::equal(TrainingLoss(config)(in).depth, depth_loss(in.prediction_m, held_out)));
}

TEST(TrainingLoss, HalvesOfABatchAverageToTheWhole) {
  const auto total = [](std::int64_t from, std::int64_t to) {
    LossInputs in = random_inputs(4);
    for (torch::Tensor* t : {&in.prediction_m, &in.ground_truth_m, &in.input_m, &in.left, &in.previous,
                             &in.next, &in.right, &in.has_previous, &in.has_next, &in.has_right,
                             &in.T_previous_camera, &in.T_next_camera, &in.baseline_m, &in.intrinsics_px}) {
      *t = t->slice(0, from, to);
    }
    return TrainingLoss()(in).total.item<double>();
  };
  EXPECT_NEAR(total(0, 4), (total(0, 2) + total(2, 4)) / 2, 1e-5);
}

TEST(TrainingLoss, WeightZeroIsNotComputed) {
  LossInputs in = random_inputs();
  for (torch::Tensor* image : {&in.previous, &in.next, &in.right})
    image->reset();  // would throw if it were read
  TrainingLossConfig config;
  config.photometric_weight = 0;
  const LossTerms terms = TrainingLoss(config)(in);
  EXPECT_EQ(terms.photometric.item<double>(), 0);
  EXPECT_GT(terms.total.item<double>(), 0);
}

TEST(TrainingLoss, RightCameraLiesAtTheBaseline) {
  // f 10 px, 0.2 m, 2 m: one pixel. The right camera sees the left image's pixel u at u - 1.
  LossInputs in = random_inputs(1);
  in.prediction_m = torch::full_like(in.prediction_m, 2.0);
  in.right = torch::roll(in.left, -1, 3);
  TrainingLossConfig config;
  config.photometric.use_previous = config.photometric.use_next = false;
  const double right_depth = TrainingLoss(config)(in).photometric.item<double>();
  in.baseline_m = -in.baseline_m;
  EXPECT_LT(right_depth, 0.3 * TrainingLoss(config)(in).photometric.item<double>());
}

TEST(TrainingLoss, NothingToLearnFromIsZeroWithZeroGradient) {
  LossInputs in = random_inputs();
  in.ground_truth_m.zero_();
  in.has_previous = in.has_next = in.has_right = torch::zeros({2}, torch::kBool);
  in.prediction_m = torch::full_like(in.prediction_m, 6.0).requires_grad_(true);
  const LossTerms terms = TrainingLoss()(in);
  EXPECT_EQ(terms.total.item<double>(), 0);
  terms.total.backward();
  EXPECT_TRUE(torch::equal(in.prediction_m.grad(), torch::zeros_like(in.prediction_m)));
}

TEST(TrainingLoss, NamesTheTermThatIsNotFinite) {
  LossInputs in = random_inputs();
  EXPECT_EQ(TrainingLoss()(in).first_not_finite(), "");
  in.left[0][0][0][0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(TrainingLoss()(in).first_not_finite(), "photometric");
  in.prediction_m[0][0][0][0] = std::numeric_limits<float>::infinity();
  in.ground_truth_m[0][0][0][0] = 1;
  EXPECT_EQ(TrainingLoss()(in).first_not_finite(), "depth");
}

}  // namespace
}  // namespace alight
