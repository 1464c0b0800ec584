#include "models/layers/join_maps.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>

#include <ATen/Parallel.h>

namespace alight {
namespace {

/// Every second row and column, from (row, column) on.
torch::Tensor every_second(const torch::Tensor& x, std::int64_t row, std::int64_t column) {
  using torch::indexing::None;
  using torch::indexing::Slice;
  return x.index({Slice(), Slice(), Slice(row, None, 2), Slice(column, None, 2)});
}

/// [B,4*C,h+1,w+1] -> [B,C,2h,2w]
torch::Tensor interleave(const torch::Tensor& y) {
  const std::int64_t channels = y.size(1) / 4, height = y.size(2) - 1, width = y.size(3) - 1;
  torch::Tensor map = torch::empty({y.size(0), channels, 2 * height, 2 * width},
                                   y.options().memory_format(torch::MemoryFormat::ChannelsLast));
  for (std::int64_t row = 0; row < 2; ++row) {
    for (std::int64_t column = 0; column < 2; ++column) {
      every_second(map, row, column)
          .copy_(y.narrow(1, (2 * row + column) * channels, channels)
                     .narrow(2, row, height)
                     .narrow(3, column, width));
    }
  }
  return map;
}

void join_tensors(const torch::Tensor& y, bool blocks, const std::vector<torch::Tensor>& addends,
                  bool rectify, torch::Tensor& target) {
  torch::Tensor map = blocks ? interleave(y) : y;
  for (const torch::Tensor& addend : addends) map = map + addend;
  if (rectify) map = torch::relu(map);
  target.copy_(map.narrow(2, 0, target.size(2)).narrow(3, 0, target.size(3)));
}

struct Float32 {
  using Stored = float;
  static float load(float x) { return x; }
  static float store(float x) { return x; }
};

/// The upper half of a float32, rounded to the nearest, ties to even.
struct Bfloat16 {
  using Stored = std::uint16_t;
  static float load(std::uint16_t x) {
    const std::uint32_t bits = static_cast<std::uint32_t>(x) << 16;
    float value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  static std::uint16_t store(float x) {
    std::uint32_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return static_cast<std::uint16_t>((bits + 0x7fffU + ((bits >> 16) & 1U)) >> 16);
  }
};

/// A channels-last map, or some of its channels: [B,H,W,channels] with `pixel` numbers from a pixel to the next.
template <class Stored>
struct View {
  explicit View(const torch::Tensor& x)
      : data(static_cast<Stored*>(x.data_ptr())), pixel(x.stride(3)), row(x.stride(2)), sample(x.stride(0)) {}
  Stored* at(std::int64_t b, std::int64_t v, std::int64_t u) const {
    return data + b * sample + v * row + u * pixel;
  }
  Stored* data;
  std::int64_t pixel, row, sample;
};

/// kAddends of them, known to the compiler, so that it can make one loop over the channels.
template <class Number, int kAddends>
void join_views(const torch::Tensor& y, bool blocks, const std::vector<torch::Tensor>& addends, bool rectify,
                const torch::Tensor& target) {
  using Stored = typename Number::Stored;
  const View<Stored> from(y), to(target);
  std::vector<View<Stored>> more;
  for (const torch::Tensor& addend : addends) more.emplace_back(addend);
  const std::int64_t channels = target.size(1), height = target.size(2), width = target.size(3);
  const float least = rectify ? 0.0F : -std::numeric_limits<float>::infinity();
  constexpr std::int64_t kRowsATask = 16;
  at::parallel_for(0, target.size(0) * height, kRowsATask, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t line = begin; line < end; ++line) {
      const std::int64_t b = line / height, v = line % height;
      for (std::int64_t u = 0; u < width; ++u) {
        const std::int64_t row = v % 2, column = u % 2;
        const Stored* in = blocks ? from.at(b, v / 2 + row, u / 2 + column) + (2 * row + column) * channels
                                  : from.at(b, v, u);
        const Stored* first = kAddends > 0 ? more[0].at(b, v, u) : nullptr;
        const Stored* second = kAddends > 1 ? more[1].at(b, v, u) : nullptr;
        Stored* __restrict out = to.at(b, v, u);
        for (std::int64_t c = 0; c < channels; ++c) {
          float sum = Number::load(in[c]);
          if constexpr (kAddends > 0) sum += Number::load(first[c]);
          if constexpr (kAddends > 1) sum += Number::load(second[c]);
          out[c] = Number::store(sum < least ? least : sum);  // a NaN stays one
        }
      }
    }
  });
}

template <class Number>
void join_views(const torch::Tensor& y, bool blocks, const std::vector<torch::Tensor>& addends, bool rectify,
                const torch::Tensor& target) {
  if (addends.empty()) return join_views<Number, 0>(y, blocks, addends, rectify, target);
  if (addends.size() == 1) return join_views<Number, 1>(y, blocks, addends, rectify, target);
  return join_views<Number, 2>(y, blocks, addends, rectify, target);
}

/// Channels lie side by side in memory.
bool is_swept(const torch::Tensor& x, torch::ScalarType type) {
  return x.device().is_cpu() && x.scalar_type() == type && (x.stride(1) == 1 || x.size(1) == 1) &&
         !(torch::GradMode::is_enabled() && x.requires_grad());
}

}  // namespace

torch::Tensor join_maps(const torch::Tensor& y, bool blocks, const std::vector<torch::Tensor>& addends,
                        bool rectify, torch::Tensor target) {
  if (y.dim() != 4 || addends.size() > 2) {
    throw std::invalid_argument("join_maps: expected a map [B,C,H,W] and two others at most");
  }
  if (!target.defined()) {
    target = blocks ? torch::empty({y.size(0), y.size(1) / 4, 2 * (y.size(2) - 1), 2 * (y.size(3) - 1)},
                                   y.options().memory_format(torch::MemoryFormat::ChannelsLast))
                    : torch::empty_like(y);
  }
  const torch::ScalarType type = y.scalar_type();
  const bool swept = (type == torch::kFloat32 || type == torch::kBFloat16) && is_swept(y, type) &&
                     is_swept(target, type) &&
                     std::all_of(addends.begin(), addends.end(),
                                 [&](const torch::Tensor& addend) { return is_swept(addend, type); });
  if (!swept) {
    join_tensors(y, blocks, addends, rectify, target);
  } else if (type == torch::kFloat32) {
    join_views<Float32>(y, blocks, addends, rectify, target);
  } else {
    join_views<Bfloat16>(y, blocks, addends, rectify, target);
  }
  return target;
}

}  // namespace alight
