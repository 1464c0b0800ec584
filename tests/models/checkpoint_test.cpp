#include "models/checkpoint.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <sys/resource.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "tests/models/tiny_net.hpp"
#include "tests/support/file_text.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using test::random_sparse_m;
using test::tiny_config;
using testing::HasSubstr;

class Checkpoint : public testing::Test {
 protected:
  void SetUp() override { torch::manual_seed(7); }

  template <class Function>
  static std::string data_error(Function function) {
    try {
      function();
    } catch (const DataError& e) {
      return e.what();
    }
    return "no DataError";
  }

  const test::ScratchFolder folder_;
};

void train_step(DepthCompletionNet net, torch::optim::Adam& adam, int seed) {
  torch::manual_seed(static_cast<std::uint64_t>(seed));
  net->train();
  adam.zero_grad();
  net->forward({torch::rand({2, 3, 32, 32})}, random_sparse_m(2, 32, 32)).log().square().mean().backward();
  adam.step();
}

TEST_F(Checkpoint, RoundTripIsBitIdentical) {
  DepthCompletionNet net(tiny_config());
  torch::optim::Adam adam(net->parameters(), 1e-3);
  train_step(net, adam, 1);  // moves the running statistics too
  save_checkpoint(folder_ / "net.pt", net, {3, 77, "seed: 1\n", 5, {1, 2.5}, 12.5, 2});
  LoadedNetwork loaded = load_network(folder_ / "net.pt");
  EXPECT_EQ(print_config(loaded.config), print_config(net->config()));
  EXPECT_EQ(loaded.info.epoch, 3);
  EXPECT_EQ(loaded.info.step, 77);
  EXPECT_EQ(loaded.info.train_config, "seed: 1\n");
  EXPECT_EQ(loaded.info.epoch_step, 5);
  EXPECT_EQ(loaded.info.epoch_losses, (std::vector<double>{1, 2.5}));
  EXPECT_EQ(loaded.info.best_score, 12.5);
  EXPECT_EQ(loaded.info.best_epoch, 2);
  EXPECT_FALSE(loaded.net->is_training());
  net->eval();
  torch::NoGradGuard no_grad;
  const torch::Tensor image = torch::rand({1, 3, 33, 47});
  const torch::Tensor sparse_m = random_sparse_m(1, 33, 47);
  EXPECT_TRUE(torch::equal(loaded.net->forward({image}, sparse_m), net->forward({image}, sparse_m)));
}

TEST_F(Checkpoint, EqualNetworksAreEqualFiles) {
  for (const char* name : {"a.pt", "b.pt"}) {
    torch::manual_seed(5);
    DepthCompletionNet net(tiny_config());
    torch::optim::Adam adam(net->parameters(), 1e-3);
    train_step(net, adam, 1);
    save_checkpoint(folder_ / name, net, {}, {net, &adam});
  }
  EXPECT_EQ(test::file_text(folder_ / "a.pt"), test::file_text(folder_ / "b.pt"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 2);
}

TEST_F(Checkpoint, ResumedOptimizerEqualsUninterrupted) {
  DepthCompletionNet net(tiny_config());
  torch::optim::Adam adam(net->parameters(), 1e-3);
  train_step(net, adam, 1);
  save_checkpoint(folder_ / "net.pt", net, {}, {net, &adam});
  train_step(net, adam, 2);

  DepthCompletionNet resumed(tiny_config());
  torch::optim::Adam resumed_adam(resumed->parameters(), 1e-3);
  load_training(folder_ / "net.pt", resumed, {resumed, &resumed_adam});
  train_step(resumed, resumed_adam, 2);
  const auto expected = net->named_parameters();
  for (const auto& item : resumed->named_parameters()) {
    EXPECT_TRUE(torch::equal(item.value(), expected[item.key()])) << item.key();
  }
}

TEST_F(Checkpoint, NetworkThatLearnsIsKeptBesideTheOneThatFlies) {
  DepthCompletionNet net(tiny_config()), flying(tiny_config());
  torch::optim::Adam adam(net->parameters(), 1e-3);
  train_step(net, adam, 1);
  save_checkpoint(folder_ / "net.pt", flying, {}, {net, &adam});
  const auto weight = [](DepthCompletionNet n) { return n->parameters()[0]; };
  EXPECT_TRUE(torch::equal(weight(load_network(folder_ / "net.pt").net), weight(flying)));
  DepthCompletionNet resumed(tiny_config()), resumed_flying(tiny_config());
  torch::optim::Adam resumed_adam(resumed->parameters(), 1e-3);
  load_training(folder_ / "net.pt", resumed_flying, {resumed, &resumed_adam});
  EXPECT_TRUE(torch::equal(weight(resumed), weight(net)));
  EXPECT_TRUE(torch::equal(weight(resumed_flying), weight(flying)));
}

TEST_F(Checkpoint, NetworkToPassOnIsSmallAndNearlyTheSame) {
  DepthCompletionNet net(tiny_config());
  torch::optim::Adam adam(net->parameters(), 1e-3);
  train_step(net, adam, 1);
  net->eval();
  save_checkpoint(folder_ / "run.pt", net, {}, {net, &adam});
  save_network(folder_ / "net.pt", net);
  EXPECT_LT(fs::file_size(folder_ / "net.pt"), 0.5 * static_cast<double>(fs::file_size(folder_ / "run.pt")));
  LoadedNetwork loaded = load_network(folder_ / "net.pt");
  const torch::NoGradGuard no_grad;
  const torch::Tensor image = torch::rand({1, 3, 32, 32});
  const torch::Tensor sparse_m = random_sparse_m(1, 32, 32);
  EXPECT_TRUE(
      torch::allclose(loaded.net->forward({image}, sparse_m), net->forward({image}, sparse_m), 1e-2, 0));
  for (const auto& item : loaded.net->named_parameters())
    EXPECT_EQ(item.value().scalar_type(), torch::kFloat32);
}

TEST_F(Checkpoint, WithoutTrainingStateNothingIsResumed) {
  DepthCompletionNet net(tiny_config());
  save_checkpoint(folder_ / "net.pt", net);
  torch::optim::Adam adam(net->parameters(), 1e-3);
  EXPECT_THAT(data_error([&] { load_training(folder_ / "net.pt", net, {net, &adam}); }),
              HasSubstr("holds no training state"));
}

TEST_F(Checkpoint, FullDiskLeavesTheFileBeforeAsItWas) {
  DepthCompletionNet net(tiny_config());
  save_checkpoint(folder_ / "net.pt", net);
  const std::string before = test::file_text(folder_ / "net.pt");
  rlimit unlimited{};
  getrlimit(RLIMIT_FSIZE, &unlimited);
  const rlimit small{1000, unlimited.rlim_max};
  signal(SIGXFSZ, SIG_IGN);  // writing past the limit is then an error, as on a full disk
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string message =
      data_error([&] { save_checkpoint(folder_ / "net.pt", net, {1, 1, "x", 0, {}}); });
  setrlimit(RLIMIT_FSIZE, &unlimited);
  EXPECT_THAT(message, HasSubstr("net.pt"));
  EXPECT_EQ(test::file_text(folder_ / "net.pt"), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 1);
}

TEST_F(Checkpoint, OtherNetworkNamesTheFirstTensorAndBothShapes) {
  DepthCompletionNet net(tiny_config());
  save_checkpoint(folder_ / "net.pt", net);
  DepthCompletionConfig wider = tiny_config();
  wider.image_widths = {6, 4, 8, 8};
  DepthCompletionNet other(wider);
  const std::string message = data_error([&] { load_checkpoint(folder_ / "net.pt", other); });
  EXPECT_THAT(message,
              HasSubstr("net.pt: another network: tensor image_encoder.stem.conv.weight is [4, 3, 7, 7]"));
  EXPECT_THAT(message, HasSubstr("[6, 3, 7, 7] in this network"));
}

TEST_F(Checkpoint, WhatIsNoCheckpointIsRefused) {
  EXPECT_THAT(data_error([&] { load_network(folder_ / "none.pt"); }), HasSubstr("none.pt: no such file"));
  std::ofstream(folder_ / "text.pt") << "not a network";
  EXPECT_THAT(data_error([&] { load_network(folder_ / "text.pt"); }), HasSubstr("not a checkpoint"));
  std::ofstream(folder_ / "empty.pt").flush();
  EXPECT_THAT(data_error([&] { load_network(folder_ / "empty.pt"); }), HasSubstr("not a checkpoint"));
  torch::save(torch::ones({3}), (folder_ / "tensor.pt").string());
  EXPECT_THAT(data_error([&] { load_network(folder_ / "tensor.pt"); }), HasSubstr("not a checkpoint"));
  EXPECT_THAT(data_error([&] { load_network(folder_.path()); }), HasSubstr("no such file"));
}

TEST_F(Checkpoint, CutFileIsRefused) {
  DepthCompletionNet net(tiny_config());
  save_checkpoint(folder_ / "net.pt", net);
  fs::resize_file(folder_ / "net.pt", fs::file_size(folder_ / "net.pt") / 2);
  EXPECT_THAT(data_error([&] { load_network(folder_ / "net.pt"); }), HasSubstr("not a checkpoint"));
}

TEST_F(Checkpoint, OtherVersionsAreRefused) {
  for (const std::int64_t step : {-1, 1}) {
    torch::serialize::OutputArchive archive;
    archive.write("alight_checkpoint_version", c10::IValue(kCheckpointVersion + step));
    archive.save_to((folder_ / "other.pt").string());
    EXPECT_THAT(data_error([&] { load_network(folder_ / "other.pt"); }),
                HasSubstr(step > 0 ? "is newer than this program's" : "is older than this program's"));
  }
}

torch::Tensor first_convolution(DepthCompletionNet net) {
  return net->named_parameters()["image_encoder.stem.conv.weight"];
}

TEST_F(Checkpoint, ImageEncoderAloneIsTakenFromAnotherNetwork) {
  DepthCompletionNet source = test::random_net(tiny_config());
  save_checkpoint(folder_ / "net.pt", source);
  DepthCompletionConfig config = test::tiny_paper_config();
  config.decoder_widths = {4, 4, 4, 4, 4};
  DepthCompletionNet net(config);
  const torch::Tensor depth_encoder = net->named_parameters()["depth_encoder.stem.conv.weight"].clone();
  load_image_encoder(folder_ / "net.pt", net);
  net->eval();
  torch::NoGradGuard no_grad;
  const torch::Tensor image = torch::rand({1, 3, 40, 56});
  const auto expected = source->image_features(image);
  const auto features = net->image_features(image);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_TRUE(torch::equal(features[i], expected[i])) << i;
  EXPECT_TRUE(torch::equal(net->named_parameters()["depth_encoder.stem.conv.weight"], depth_encoder));
}

TEST_F(Checkpoint, ImageEncoderStartsWithNothingOnTheChannelsItNeverSaw) {
  DepthCompletionNet source(tiny_config());
  save_checkpoint(folder_ / "net.pt", source);
  DepthCompletionNet stereo(test::tiny_shipped_config());
  load_image_encoder(folder_ / "net.pt", stereo);
  const torch::Tensor weight = first_convolution(stereo);
  EXPECT_TRUE(torch::equal(weight.narrow(1, 0, 3), first_convolution(source)));
  EXPECT_EQ(weight.narrow(1, 3, weight.size(1) - 3).abs().max().item<float>(), 0);
  EXPECT_TRUE(weight.requires_grad());
}

TEST_F(Checkpoint, ImageEncoderThatDoesNotFitIsRefused) {
  save_checkpoint(folder_ / "net.pt", DepthCompletionNet(test::tiny_shipped_config()));
  DepthCompletionNet left_only(tiny_config());
  EXPECT_THAT(
      data_error([&] { load_image_encoder(folder_ / "net.pt", left_only); }),
      HasSubstr("image_encoder.stem.conv.weight is [4, 9, 7, 7] in the file, [4, 3, 7, 7] in this network"));
  DepthCompletionConfig group = test::tiny_shipped_config();
  group.normalization = Normalization::kGroup;
  EXPECT_THAT(data_error([&] { load_image_encoder(folder_ / "net.pt", DepthCompletionNet(group)); }),
              HasSubstr("the network has no tensor image_encoder.stem.norm.running_mean"));
  EXPECT_THAT(data_error([&] { load_image_encoder(folder_ / "none.pt", left_only); }),
              HasSubstr("no such file"));
}

TEST_F(Checkpoint, UnwritableFolderIsADataError) {
  DepthCompletionNet net(tiny_config());
  EXPECT_THROW(save_checkpoint(folder_ / "absent" / "net.pt", net), DataError);
}

}  // namespace
}  // namespace alight
