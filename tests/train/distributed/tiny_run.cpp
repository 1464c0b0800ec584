#include "tests/train/distributed/tiny_run.hpp"

#include <cmath>
#include <vector>

#include "dataset/store/sample_store.hpp"
#include "tests/models/tiny_net.hpp"
#include "tests/support/programs.hpp"

namespace alight::test {
namespace fs = std::filesystem;

namespace {

constexpr int kSide_px = 40;

/// Ground 10 m below with a block 3 m high that is elsewhere in every sample; a point at every third pixel.
Sample tiny_sample(int index) {
  cv::Mat depth_m(kSide_px, kSide_px, CV_32FC1, cv::Scalar(10));
  depth_m(cv::Rect(3 + 2 * (index % 8), 8 + index % 5, 12, 14)).setTo(7);
  Sample sample;
  sample.left = cv::Mat(kSide_px, kSide_px, CV_8UC3);
  sample.sparse = SparseDepth::empty({kSide_px, kSide_px});
  for (int v = 0; v < kSide_px; ++v) {
    for (int u = 0; u < kSide_px; ++u) {
      const float z = depth_m.at<float>(v, u);
      sample.left.at<cv::Vec3b>(v, u) = {static_cast<uchar>((23 * u + 31 * v + 7 * index) % 256),
                                         static_cast<uchar>(25 * z), static_cast<uchar>(20 * z)};
      if ((u + v + index) % 3 != 0) continue;
      sample.sparse.depth_m.at<float>(v, u) = z;
      sample.sparse.offset_us.at<std::int32_t>(v, u) = 1000 * ((17 * u + 29 * v) % 900 + 1);
    }
  }
  sample.right = sample.left.clone();
  return sample;
}

}  // namespace

void write_tiny_dataset(const fs::path& dir, int samples) {
  DatasetInfo info;
  info.rig.intrinsics = {40, 40, 19.5, 19.5, kSide_px, kSide_px};
  info.rig.baseline_m = 0.1;
  info.window_before_s = info.window_after_s = 1;
  info.flights = {{"tiny", samples, {}, true, false}};
  create_flight_folders(dir, info.flights.front());
  std::vector<SampleRow> rows;
  for (int i = 0; i < samples; ++i) {
    write_sample(dir, info.flights.front(), i, tiny_sample(i), 1);
    SampleRow row;
    row.index = i;
    row.t_ns = i * std::int64_t{1'000'000'000};
    row.height_m = 10 + 0.1 * i;
    rows.push_back(row);
  }
  write_samples(dir, "tiny", rows);
  write_dataset_info(dir, info);
}

TrainConfig tiny_run_config(const fs::path& dataset) {
  TrainConfig c;
  c.dataset = dataset.string();
  c.split.held_out_blocks = {{0, 0.2}};
  c.split.gap_s = 0;
  c.model = tiny_config();
  c.model.stem = Stem::kFull;  // four numbers a channel, the other stem's coarsest map, magnify rounding
  // Turned samples lose their right camera, and then some have no pixel that counts for the photometric loss.
  c.augmentation.horizontal_flip_probability = c.augmentation.vertical_flip_probability = 0.5;
  c.augmentation.jitter_probability = 0.5;
  // Adam makes whole steps of gradients that are mere rounding; short ones keep what that changes apart from mistakes.
  c.optimizer.learning_rate = 1e-5;
  c.compute.device = "cpu";
  c.compute.threads = 1;
  c.compute.distributed_timeout_s = 60;  // a busy computer is no dead process
  c.train.epochs = 2;
  c.train.steps_per_epoch = 3;
  c.train.batch_size = 4;
  c.train.crop_px = 32;
  c.validation.shares = {0.3};
  c.validation.samples = 2;
  return c;
}

std::vector<std::string> rank_command(int rank, int port, const std::string& arguments) {
  return shell_command("exec env RANK=" + std::to_string(rank) + " LOCAL_RANK=" + std::to_string(rank) +
                       " WORLD_SIZE=2 MASTER_ADDR=127.0.0.1 MASTER_PORT=" + std::to_string(port) + " " +
                       ALIGHT_BINARY_DIR "/bin/alight-train " + arguments);
}

}  // namespace alight::test
