#pragma once

#include "infer/health/ground_memory.hpp"
#include "sensors/poses/alignment.hpp"

namespace alight {

/// How far the heights of LiDAR packets drift apart. A receiver's height may wander by centimetres within the second of
/// LiDAR that makes a depth map, and such steps look like rough ground. The ground itself tells them: where packets meet
/// the same flat cells, the middle difference of their heights is the receiver's.
class HeightRegistration {
 public:
  HeightRegistration();

  /// Packets in the order of their time.
  /// @returns by how much the packet's heights (world's z) lie above those of the first one, as far as common ground says;
  /// where there is too little of it, as the packet before
  double add(const WorldPacket& packet);
  /// The pose has leapt, or the LiDAR was wrong: what follows is not compared with what was before.
  void forget() { ground_.clear(); }

 private:
  GroundMemory ground_;  // heights as of the first packet
  double shift_m_ = 0;
};

}  // namespace alight
