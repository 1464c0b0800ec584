#include "train/data/batch.hpp"

#include <algorithm>
#include <stdexcept>

#include "foundation/errors.hpp"

namespace alight {
namespace {

struct Window {
  CropOrigin origin;
  std::int64_t height_px;
  std::int64_t width_px;
};

/// Copies the window of a channels x H x W array to `out`, each value times `scale`; nothing for an empty
/// array.
template <class T>
void copy_window(const std::vector<T>& from, const CompactSample& sample, std::int64_t channels,
                 const Window& window, float scale, float* out) {
  if (from.empty()) return;
  for (std::int64_t channel = 0; channel < channels; ++channel) {
    for (std::int64_t row = 0; row < window.height_px; ++row) {
      const std::int64_t y = channel * sample.height_px + window.origin.row + row;
      const T* begin = from.data() + y * sample.width_px + window.origin.column;
      out = std::transform(begin, begin + window.width_px, out,
                           [scale](T v) { return scale * static_cast<float>(v); });
    }
  }
}

template <class T>
void copy_view(const std::vector<T>& from, const CompactSample& sample, const Window& window,
               torch::Tensor& batch, std::size_t i) {
  const float scale = std::is_same_v<T, std::uint8_t> ? 1.0F / 255.0F : 1.0F;
  float* out = batch.data_ptr<float>() + static_cast<std::int64_t>(i) * batch.stride(0);
  copy_window(from, sample, batch.size(1), window, scale, out);
}

Batch allocate(std::int64_t count, std::int64_t height_px, std::int64_t width_px) {
  const auto images = [&] { return torch::zeros({count, 3, height_px, width_px}); };
  const auto maps = [&] { return torch::zeros({count, 1, height_px, width_px}); };
  const auto flags = [&] { return torch::zeros({count}, torch::kBool); };
  Batch batch{images(), images(), images(), images(), maps(), maps(), flags(), flags(),
              flags(),  {},       {},       {},       {},     {},     {},      {}};
  batch.T_previous_camera = torch::zeros({count, 4, 4});
  batch.T_next_camera = torch::zeros({count, 4, 4});
  batch.intrinsics_px = torch::zeros({count, 4});
  batch.baseline_m = torch::zeros({count});
  batch.height_m = torch::zeros({count});
  batch.down_camera = torch::zeros({count, 3});
  return batch;
}

void fill(Batch& batch, std::size_t i, const CompactSample& sample, const Window& window) {
  copy_view(sample.left, sample, window, batch.left, i);
  copy_view(sample.right, sample, window, batch.right, i);
  copy_view(sample.previous, sample, window, batch.previous, i);
  copy_view(sample.next, sample, window, batch.next, i);
  copy_view(sample.sparse_m, sample, window, batch.sparse_m, i);
  copy_view(sample.offset_s, sample, window, batch.offset_s, i);
  const auto at = static_cast<std::int64_t>(i);
  const DepthSample& rest = sample.rest;
  batch.has_right.data_ptr<bool>()[i] = rest.has_right;
  batch.has_previous.data_ptr<bool>()[i] = rest.has_previous;
  batch.has_next.data_ptr<bool>()[i] = rest.has_next;
  batch.T_previous_camera[at].copy_(rest.T_previous_camera);
  batch.T_next_camera[at].copy_(rest.T_next_camera);
  batch.intrinsics_px[at].copy_(rest.intrinsics);
  batch.intrinsics_px.data_ptr<float>()[4 * i + 2] -= static_cast<float>(window.origin.column);
  batch.intrinsics_px.data_ptr<float>()[4 * i + 3] -= static_cast<float>(window.origin.row);
  batch.baseline_m.data_ptr<float>()[i] = static_cast<float>(rest.baseline_m);
  batch.height_m.data_ptr<float>()[i] = static_cast<float>(rest.height_m);
  batch.down_camera[at].copy_(rest.down_camera);
  batch.indices.push_back(rest.index);
}

}  // namespace

Batch Batch::to(torch::Device device, torch::MemoryFormat format) const {
  Batch moved = *this;
  for (torch::Tensor* image : {&moved.left, &moved.right, &moved.previous, &moved.next}) {
    *image = image->to(device).contiguous(format);
  }
  for (torch::Tensor* tensor :
       {&moved.sparse_m, &moved.offset_s, &moved.has_right, &moved.has_previous, &moved.has_next,
        &moved.T_previous_camera, &moved.T_next_camera, &moved.intrinsics_px, &moved.baseline_m,
        &moved.height_m, &moved.down_camera}) {
    *tensor = tensor->to(device);
  }
  return moved;
}

Batch stack(const std::vector<std::shared_ptr<const CompactSample>>& samples,
            const std::vector<CropOrigin>& origins, std::int64_t height_px, std::int64_t width_px) {
  if (samples.empty() || samples.size() != origins.size()) {
    throw std::invalid_argument("stack: expected one origin a sample");
  }
  Batch batch = allocate(static_cast<std::int64_t>(samples.size()), height_px, width_px);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const CompactSample& sample = *samples[i];
    if (origins[i].row + height_px > sample.height_px || origins[i].column + width_px > sample.width_px) {
      throw DataError("sample " + std::to_string(sample.rest.index) + ": " + std::to_string(sample.width_px) +
                      "x" + std::to_string(sample.height_px) + " px, a cut-out of " +
                      std::to_string(width_px) + "x" + std::to_string(height_px) +
                      " px does not fit; choose a smaller train.crop_px");
    }
    fill(batch, i, sample, {origins[i], height_px, width_px});
  }
  return batch;
}

}  // namespace alight
