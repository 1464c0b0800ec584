#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dataset/store/sample_store.hpp"
#include "foundation/binder_fwd.hpp"

namespace alight {

/// A FlightEntry as it stands in YAML files.
struct FlightSection {
  struct Dropped {
    std::string reason;
    std::int64_t count = 0;
  };
  std::string name;
  int samples = 0;
  bool has_right = false;
  bool has_dense = false;
  std::vector<Dropped> dropped;
};
void bind(Binder& b, FlightSection::Dropped& c);
void bind(Binder& b, FlightSection& c);

/// A flight as it stands in the file, and back.
FlightSection to_section(const FlightEntry& flight);
FlightEntry from_section(const FlightSection& section);

}  // namespace alight
