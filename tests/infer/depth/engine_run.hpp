#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "infer/depth/depth_engine.hpp"
#include "tests/infer/fakes.hpp"

/// The engine over the fakes' flights.
namespace alight::engine_run {

constexpr double kHeight_m = 6.0;

/// Engine for the fakes' small images; `paper`: LiDAR after the image, a prediction per packet.
inline DepthEngineConfig config_of(bool paper) {
  DepthEngineConfig config;
  config.image.warm_images = 0;  // every image for itself, unless a test says otherwise
  config.width_px = 160;
  config.height_px = 144;
  if (paper) {
    config.history_s = 0;
    config.image.step_growth = 1;
  }
  return config;
}

struct Outcome {
  std::vector<DepthResult> results;
  std::map<std::string, std::int64_t> dropped;
};

inline Outcome run(const DepthEngineConfig& config, const std::vector<LogMessage>& messages,
                   std::shared_ptr<DepthPredictor> net) {
  DepthEngine engine(config, fakes::small_rig(), std::move(net));
  Outcome out;
  const auto take = [&] {
    for (DepthResult& result : engine.take_results()) out.results.push_back(std::move(result));
  };
  for (const LogMessage& message : messages) {
    engine.add(message);
    take();
  }
  engine.finish();
  take();
  out.dropped = engine.dropped();
  return out;
}

inline std::int64_t images_in(const std::vector<LogMessage>& messages) {
  return std::count_if(messages.begin(), messages.end(),
                       [](const LogMessage& m) { return std::holds_alternative<StereoFrame>(m); });
}

/// Every image once, in order, with what its source promises.
inline void expect_complete(const Outcome& run, const std::vector<LogMessage>& messages) {
  EXPECT_EQ(static_cast<std::int64_t>(run.results.size()), images_in(messages));
  for (std::size_t i = 0; i < run.results.size(); ++i) {
    const DepthResult& result = run.results[i];
    if (i > 0) EXPECT_GT(result.t_ns, run.results[i - 1].t_ns);
    EXPECT_FALSE(result.reason.empty());
    EXPECT_EQ(result.depth_m.empty(), result.source == DepthSource::kNone);
    if (result.source == DepthSource::kImage) EXPECT_EQ(result.accumulation_s, 0);
    if (result.source == DepthSource::kLidar) EXPECT_GT(result.accumulation_s, 0);
    if (result.depth_m.empty()) continue;
    EXPECT_TRUE(result.T_world_camera);
    EXPECT_EQ(cv::countNonZero((result.depth_m > 0) != (result.pixel_source > 0)), 0);
  }
}

inline std::shared_ptr<fakes::FakePredictor> always(double depth_m) {
  return std::make_shared<fakes::FakePredictor>([depth_m](int) { return depth_m; });
}

}  // namespace alight::engine_run
