#pragma once

#include "train/data/batch.hpp"

namespace alight {

// The same scene as another camera would have seen it: exact moves of pixels, and poses, attitude and intrinsics that
// move along. All take a batch of one sample, share what they do not change, and leave the given tensors alone.
// @throws std::invalid_argument unless the batch has one sample

/// Left and right exchanged. The mirrored left camera is a right camera, so the cameras swap and the sample is told from the
/// other one: the points move by their disparity, to the nearest pixel and the nearest surface, and the height and the
/// poses to those of that camera. Points behind an edge that the left camera alone sees move along too. A sample without
/// right image is mirrored only.
Batch flip_horizontally(Batch sample);

/// Up and down exchanged, for views that look down. The cameras stay what they are.
Batch flip_vertically(Batch sample);

/// Turned counter-clockwise by 1, 2 or 3 quarters. Two are both flips. After one or three the right camera lies above or
/// below the left one, where no rectified method looks for it: the sample goes without.
/// @throws std::invalid_argument for images that are not square, or other turns
Batch turn(Batch sample, int quarter_turns);

}  // namespace alight
