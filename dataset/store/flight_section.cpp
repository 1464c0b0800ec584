#include "dataset/store/flight_section.hpp"

#include "foundation/config_reader.hpp"

namespace alight {

void bind(Binder& b, FlightSection::Dropped& c) {
  b.required("reason", c.reason, "what was left out");
  b.required("count", c.count, "how many");
}

void bind(Binder& b, FlightSection& c) {
  b.required("name", c.name, "folder of the flight");
  b.check("name", c.name.find('/') == std::string::npos && c.name != "..",
          "\"" + c.name + "\" is no folder's name");
  b.required("samples", c.samples, "lines of its samples.csv", at_least(0));
  b.required("has_right", c.has_right, "stereo");
  b.required("has_dense", c.has_dense, "with the simulator's true depth");
  b.list("dropped", c.dropped, "what was left out of the log, and why");
}

FlightSection to_section(const FlightEntry& flight) {
  FlightSection section{flight.name, flight.samples, flight.has_right, flight.has_dense, {}};
  for (const auto& [reason, count] : flight.dropped) section.dropped.push_back({reason, count});
  return section;
}

FlightEntry from_section(const FlightSection& section) {
  FlightEntry flight{section.name, section.samples, {}, section.has_right, section.has_dense};
  for (const FlightSection::Dropped& entry : section.dropped) flight.dropped[entry.reason] = entry.count;
  return flight;
}

}  // namespace alight
