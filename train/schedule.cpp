#include "train/schedule.hpp"

#include <algorithm>
#include <cmath>

#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

double cosine(const ScheduleConfig& config, std::int64_t step, std::int64_t total_steps) {
  const double length = static_cast<double>(std::max<std::int64_t>(total_steps - config.warmup_steps, 1));
  const double share = std::clamp(static_cast<double>(step - config.warmup_steps) / length, 0.0, 1.0);
  return config.final_factor + (1 - config.final_factor) * 0.5 * (1 + std::cos(kPi * share));
}

}  // namespace

void bind(Binder& b, ScheduleConfig& c) {
  b.choice("kind", c.kind,
           {{"constant", ScheduleKind::kConstant},
            {"step", ScheduleKind::kStep},
            {"cosine", ScheduleKind::kCosine}},
           "how the learning rate changes");
  b.field("warmup_steps", c.warmup_steps, "the learning rate rises linearly over the first steps",
          at_least(0));
  b.field("drop_after_epoch", c.drop_after_epoch, "step: falls after this epoch; 0: never", at_least(0));
  b.field("drop_factor", c.drop_factor, "step: by which it is multiplied then", between(0, 1));
  b.field("final_factor", c.final_factor, "cosine: share of the learning rate at the end", between(0, 1));
}

double learning_rate_factor(const ScheduleConfig& config, int epoch, std::int64_t step,
                            std::int64_t total_steps) {
  if (step < config.warmup_steps)
    return static_cast<double>(step + 1) / static_cast<double>(config.warmup_steps);
  if (config.kind == ScheduleKind::kCosine) return cosine(config, step, total_steps);
  const bool dropped =
      config.kind == ScheduleKind::kStep && config.drop_after_epoch > 0 && epoch > config.drop_after_epoch;
  return dropped ? config.drop_factor : 1.0;
}

}  // namespace alight
