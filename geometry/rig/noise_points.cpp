#include "geometry/rig/noise_points.hpp"

#include "foundation/config_reader.hpp"

namespace alight {

void bind_noise_points(Binder& b, const char* key, NoisePoints& noise) {
  b.choice(key, noise,
           {{"keep", NoisePoints::kKeep},
            {"drop_certain", NoisePoints::kDropCertain},
            {"drop_likely", NoisePoints::kDropLikely}},
           "points that a Livox LiDAR marks as noise in their tag");
}

}  // namespace alight
