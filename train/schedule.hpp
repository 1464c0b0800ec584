#pragma once

#include <cstdint>

#include "foundation/binder_fwd.hpp"

namespace alight {

/// `constant`; `step`: times drop_factor after an epoch (the paper); `cosine`: down to final_factor along half a wave
/// (Loshchilov and Hutter 2017).
enum class ScheduleKind { kConstant, kStep, kCosine };

/// How the step size changes over a training.
struct ScheduleConfig {
  ScheduleKind kind = ScheduleKind::kStep;
  int warmup_steps = 0;        ///< the learning rate rises linearly over the first steps
  int drop_after_epoch = 20;   ///< step; 0: never
  double drop_factor = 0.1;    ///< step
  double final_factor = 0.01;  ///< cosine
};
void bind(Binder& b, ScheduleConfig& c);

/// Factor of the learning rate (paper 4.1: a tenth after epoch 20).
/// @param epoch from 1 @param step optimizer steps finished before this one @param total_steps of the whole run
double learning_rate_factor(const ScheduleConfig& config, int epoch, std::int64_t step,
                            std::int64_t total_steps);

}  // namespace alight
