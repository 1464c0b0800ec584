#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <torch/torch.h>

#include "dataset/store/depth_dataset.hpp"

namespace alight {

/// Which of a sample's points a method gets.
struct Feeding {
  enum class Kind {
    kShare,   ///< P, a random share of the full window (the paper)
    kWindow,  ///< the points of the first seconds after the image, as the onboard loop gathers them
  };
  Kind kind = Kind::kShare;
  double amount = 1;  ///< share, or seconds

  /// "P=0.3" or "0.3 s"
  std::string name() const;
};

/// Shares first, then windows.
std::vector<Feeding> make_feedings(const std::vector<double>& shares, const std::vector<double>& windows_s);

/// The fed points. With one seed a smaller share is a part of a larger one. @returns [1,H,W], 0 = not fed
torch::Tensor feed(const DepthSample& sample, const Feeding& feeding, std::uint64_t seed);

}  // namespace alight
