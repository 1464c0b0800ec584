#include "train/distributed/process_place.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <limits>

#include "foundation/errors.hpp"

namespace alight {
namespace {

struct PlaceVariable {
  const char* name;
  const char* of_slurm;  // what stands for it; null: nothing does
};
constexpr PlaceVariable kRank{"RANK", "SLURM_PROCID"};
constexpr PlaceVariable kSize{"WORLD_SIZE", "SLURM_NTASKS"};
constexpr PlaceVariable kLocalRank{"LOCAL_RANK", "SLURM_LOCALID"};
constexpr PlaceVariable kAddress{"MASTER_ADDR", nullptr};
constexpr PlaceVariable kPort{"MASTER_PORT", nullptr};
constexpr std::array<PlaceVariable, 5> kAll{kRank, kSize, kAddress, kPort, kLocalRank};

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// A variable that counts: torchrun's, or Slurm's where torchrun has started nothing.
struct Found {
  std::string name, value;
};

Found find(const PlaceVariable& variable, bool slurm) {
  Found found{variable.name, environment(variable.name)};
  if (found.value.empty() && slurm && variable.of_slurm != nullptr)
    found = {variable.of_slurm, environment(variable.of_slurm)};
  return found;
}

int number(const Found& found, int min, int max) {
  int value = 0;
  const char* end = found.value.data() + found.value.size();
  const auto [rest, error] = std::from_chars(found.value.data(), end, value);
  if (error == std::errc() && rest == end && value >= min && value <= max) return value;
  throw ConfigError("environment variable " + found.name + ": \"" + found.value + "\" is not between " +
                    std::to_string(min) + " and " + std::to_string(max) +
                    "; start the processes with scripts/cluster/launch.sh, torchrun or srun, which set it");
}

std::string missing(bool slurm) {
  std::string names;
  for (const PlaceVariable& variable : kAll) {
    if (find(variable, slurm).value.empty())
      names += (names.empty() ? "" : ", ") + std::string(variable.name);
  }
  return names;
}

/// Slurm writes "2(x3),1": two on each of three machines, one on the next.
int local_size(const ProcessPlace& place, bool slurm) {
  const std::string torchrun = environment("LOCAL_WORLD_SIZE");
  if (!torchrun.empty()) return number({"LOCAL_WORLD_SIZE", torchrun}, place.local_rank + 1, place.size);
  const int of_slurm = slurm ? std::atoi(environment("SLURM_TASKS_PER_NODE").c_str()) : 0;
  if (of_slurm > 0) return std::min(of_slurm, place.size);
  return place.on_loopback() ? place.size : place.local_rank + 1;
}

}  // namespace

bool ProcessPlace::on_loopback() const {
  return master_address == "localhost" || master_address == "::1" || master_address.rfind("127.", 0) == 0;
}

ProcessPlace read_process_place() {
  if (std::all_of(kAll.begin(), kAll.end(),
                  [](const PlaceVariable& v) { return environment(v.name).empty(); }))
    return {};
  const bool slurm = !environment(kAddress.name).empty() && environment(kRank.name).empty() &&
                     environment(kSize.name).empty();
  if (const std::string names = missing(slurm); !names.empty()) {
    throw ConfigError(
        "training with several processes: of the environment variables, " + names +
        " is missing; start the processes with scripts/cluster/launch.sh, torchrun or srun, or set none "
        "of RANK, WORLD_SIZE, MASTER_ADDR, MASTER_PORT and LOCAL_RANK to train with one");
  }
  ProcessPlace place;
  place.size = number(find(kSize, slurm), 1, std::numeric_limits<int>::max());
  place.rank = number(find(kRank, slurm), 0, place.size - 1);
  place.local_rank = number(find(kLocalRank, slurm), 0, place.size - 1);
  place.master_address = environment(kAddress.name);
  place.master_port = number(find(kPort, slurm), 1, 65535);
  place.local_size = local_size(place, slurm);
  // torchrun's agent keeps the meeting place over restarts and numbers them.
  place.served = environment("TORCHELASTIC_USE_AGENT_STORE") == "True";
  place.meeting_id = environment("TORCHELASTIC_RESTART_COUNT");
  return place;
}

}  // namespace alight
