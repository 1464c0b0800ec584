#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "closed_loop/landing/landing_flight.hpp"

namespace alight::closed_loop {

/// Which landings a campaign flies: landing i is in world `first_seed + i`, of look i and fault i / looks, each list round
/// and round. A fault strikes at a moment drawn from the world's seed.
struct CampaignPlan {
  int worlds = 1000;
  int first_seed = 100000;  ///< worlds that training never saw: its flights have seeds below 1000
  std::vector<std::string> looks;
  std::vector<std::string> faults;  ///< "none" is one; empty: none
  bool lidar_only = false;
  double fault_from_s = 2;  ///< a fault strikes between these moments, uniformly
  double fault_to_s = 40;
  /// A fault that passes lasts for a time between these two, uniformly. Empty: none passes.
  std::vector<double> fault_lasts_s;
  double lasting_share = 0;  ///< of the faults, which stay to the end although fault_lasts_s is given
};

/// Landing i of a plan.
struct CampaignLanding {
  int seed = 0;
  sim::Look look = sim::Look::kVillage;
  PlannedFault fault;
};
CampaignLanding planned(const CampaignPlan& plan, int index);

/// @throws ConfigError naming an option whose name is none
void check(const CampaignPlan& plan);

/// The folder of a campaign: `plan.json`, `config.yaml`, `rows.jsonl` (a landing a line, appended whole), `pictures/` of
/// landings that did not end well, `report.md`. Landings that have a row are not flown again.
class CampaignFolder {
 public:
  /// Opens a new or an old campaign. @throws ConfigError if the folder holds one with another plan or configuration; more
  /// worlds are the same plan
  CampaignFolder(const std::filesystem::path& path, const CampaignPlan& plan, const LandConfig& config);
  /// Opens an old one. @throws DataError
  explicit CampaignFolder(const std::filesystem::path& path);

  const CampaignPlan& plan() const { return plan_; }
  LandConfig config() const;
  /// Rows so far, as far as they are whole. @throws DataError
  std::vector<LandingResult> rows() const;
  /// Indices without a row.
  std::vector<int> missing() const;
  /// One write of one line: safe from several processes. @throws DataError
  void append(const LandingResult& result) const;
  void write_pictures(const FlownLanding& flown, const sim::SurfaceTruth& truth, double body_radius_m) const;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  CampaignPlan plan_;
};

}  // namespace alight::closed_loop
