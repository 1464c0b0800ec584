#include "sim/spec/hardship.hpp"

#include <algorithm>
#include <utility>

namespace alight::sim {
namespace {

const std::vector<std::pair<Hardship, std::string>> kNames = {
    {Hardship::kStones, "stones"}, {Hardship::kKerbs, "kerbs"},         {Hardship::kWires, "wires"},
    {Hardship::kSlopes, "slopes"}, {Hardship::kClearings, "clearings"}, {Hardship::kSnow, "snow"},
    {Hardship::kDusk, "dusk"},     {Hardship::kTraffic, "traffic"},     {Hardship::kPeople, "people"}};

}  // namespace

std::string to_string(Hardship hardship) { return kNames[static_cast<std::size_t>(hardship)].second; }

std::vector<Hardship> all_hardships() {
  std::vector<Hardship> all;
  for (const auto& [hardship, name] : kNames) all.push_back(hardship);
  return all;
}

std::string hardship_names() {
  std::string names;
  for (const auto& [hardship, name] : kNames) names += (names.empty() ? "" : ", ") + name;
  return names;
}

bool Hardships::has(Hardship hardship) const {
  return std::find(names.begin(), names.end(), to_string(hardship)) != names.end();
}

std::string Hardships::unknown() const {
  for (const std::string& name : names) {
    const bool known =
        std::any_of(kNames.begin(), kNames.end(), [&](const auto& entry) { return entry.second == name; });
    if (!known) return name;
  }
  return {};
}

}  // namespace alight::sim
