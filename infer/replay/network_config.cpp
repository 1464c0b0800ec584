#include "infer/replay/network_config.hpp"

#include "foundation/config_reader.hpp"

namespace alight {

void bind(Binder& b, NetworkConfig& c) {
  b.field("device", c.device, "auto | cpu | cuda | cuda:N");
  b.choice("precision", c.precision,
           {{"auto", NetworkPrecision::kAuto},
            {"float32", NetworkPrecision::kFloat32},
            {"bfloat16", NetworkPrecision::kBfloat16},
            {"float16", NetworkPrecision::kFloat16}},
           "of the convolutions; auto: the fastest that device or processor have instructions for");
  b.field("threads", c.threads, "processor threads; 0: all", between(0, 1024));
}

}  // namespace alight
