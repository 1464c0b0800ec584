#pragma once

#include "infer/depth/landing_pipeline.hpp"
#include "sensors/messages/message_types.hpp"

namespace alight {

/// What is done with the results of a flight: written, sent, shown. Called on the thread of the landing sites, so all calls return
/// at once: whoever has more to do copies the report (its images are shared, not copied) and works elsewhere.
class FrameSink {
 public:
  FrameSink() = default;
  FrameSink(const FrameSink&) = delete;
  FrameSink& operator=(const FrameSink&) = delete;
  virtual ~FrameSink() = default;

  /// Every message, just before the engine gets it.
  virtual void on_message(const LogMessage& message) { static_cast<void>(message); }
  /// Every result, in image order.
  virtual void on_frame(const FrameReport& frame) = 0;
  /// Whenever a finding comes or goes, after the frames of the same message. Needs no frame: a camera that falls silent
  /// is told here.
  virtual void on_health(const HealthReport& health) { static_cast<void>(health); }
};

}  // namespace alight
