#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "geometry/frames.hpp"
#include "geometry/rig/rig.hpp"
#include "infer/depth/landing_pipeline.hpp"
#include "infer/replay/stage_benchmark.hpp"
#include "sensors/messages/message_types.hpp"

namespace alight {

/// A hover above level ground that never ends: two seconds of messages over and over, each time later.
class HoverFlight {
 public:
  static constexpr double kHeight_m = 15;

  HoverFlight() : rig_(load_rig(std::string(ALIGHT_SOURCE_DIR) + "/configs/rigs/paper.yaml")) {
    messages_ = synthetic_hover(rig_, kHeight_m, 2.0);
  }

  const Rig& rig() const { return rig_; }
  std::unique_ptr<LandingPipeline> pipeline(std::shared_ptr<DepthPredictor> predictor) const {
    return std::make_unique<LandingPipeline>(DepthEngineConfig{}, LandingConfig{}, rig_,
                                             std::move(predictor));
  }

  static std::int64_t time_ns(const LogMessage& message) {
    return std::visit([](const auto& any) { return any.t_ns; }, message);
  }

  LogMessage next() {
    LogMessage message = messages_[index_];
    std::visit([this](auto& any) { any.t_ns += offset_ns_; }, message);
    if (auto* packet = std::get_if<LidarPacket>(&message)) {
      for (LidarReturn& echo : packet->returns) echo.t_ns += offset_ns_;
    }
    if (++index_ == messages_.size()) {
      index_ = 0;
      offset_ns_ += to_nanoseconds(2.01);
    }
    return message;
  }

 private:
  Rig rig_;
  std::vector<LogMessage> messages_;
  std::size_t index_ = 0;
  std::int64_t offset_ns_ = 0;
};

}  // namespace alight
