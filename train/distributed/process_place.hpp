#pragma once

#include <string>

#include "foundation/errors.hpp"

namespace alight {

/// A process's place among those that train together.
struct ProcessPlace {
  int rank = 0;        ///< 0 .. size - 1; 0 is the one that writes
  int size = 1;        ///< processes
  int local_rank = 0;  ///< among those of this machine
  int local_size = 1;
  std::string master_address;  ///< where they meet
  int master_port = 0;
  bool served = false;     ///< whoever started them listens there already; else rank 0 does
  std::string meeting_id;  ///< tells a restart's meeting from the one before

  /// They meet on the loopback device, so all run on this machine.
  bool on_loopback() const;
};

/// Reads torchrun's RANK, WORLD_SIZE, MASTER_ADDR, MASTER_PORT and LOCAL_RANK; for processes of `srun` that were given
/// MASTER_ADDR and MASTER_PORT, Slurm's SLURM_PROCID, SLURM_NTASKS and SLURM_LOCALID instead of the numbers.
/// @returns the only process where none is set @throws ConfigError naming what is missing or no such number
ProcessPlace read_process_place();

}  // namespace alight
