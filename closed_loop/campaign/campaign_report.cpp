#include "closed_loop/campaign/campaign_report.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "foundation/order_statistics.hpp"

namespace alight::closed_loop {
namespace {

struct Counts {
  int landings = 0;
  int with_site = 0;
  int safe_with_site = 0;
  int safe = 0;
  int least_bad = 0;
  int unsafe = 0;
  int collided = 0;
  int gave_up_with_site = 0;
  int gave_up_without_site = 0;
  std::vector<double> time_s;  // of safe landings
  double accumulation_s = 0;
  double cost_s = 0;

  void add(const LandingResult& row, double wanted_radius_m) {
    const bool site = row.safe_radius_m >= wanted_radius_m;
    ++landings;
    with_site += site ? 1 : 0;
    safe += row.outcome == Outcome::kSafe ? 1 : 0;
    safe_with_site += site && row.outcome == Outcome::kSafe ? 1 : 0;
    least_bad += row.landed() && row.least_bad ? 1 : 0;
    unsafe += row.outcome == Outcome::kUnsafe ? 1 : 0;
    collided += row.outcome == Outcome::kCollided ? 1 : 0;
    gave_up_with_site += site && row.outcome == Outcome::kGaveUp ? 1 : 0;
    gave_up_without_site += !site && row.outcome == Outcome::kGaveUp ? 1 : 0;
    if (row.outcome == Outcome::kSafe) time_s.push_back(row.duration_s);
    accumulation_s += row.accumulation_s;
    cost_s += row.cost_s;
  }
  double time_at(double share) const {
    if (time_s.empty()) return 0;
    std::vector<double> values = time_s;
    return quantile(values, share);
  }
};

std::string share_text(int successes, int trials) {
  if (trials == 0) return "-";
  const Interval interval = wilson(successes, trials);
  return fmt::format("{:.1f} % ({:.1f} to {:.1f})", 100.0 * successes / trials, 100 * interval.low,
                     100 * interval.high);
}

std::string head(const char* first) {
  return fmt::format("| {} ", first) +
         "| landings | site within reach | landed safely where there was one (95 %) | landed safely in all "
         "| unsafe touchdowns | collisions | gave up, site | gave up, no site "
         "| time to land, s (median, 90 %) | accumulation, s "
         "|\n|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
}

std::string row(const std::string& first, const Counts& c) {
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.0f}, {:.0f} | {:.2f} |\n", first,
                     c.landings, c.with_site, share_text(c.safe_with_site, c.with_site), c.safe, c.unsafe,
                     c.collided, c.gave_up_with_site, c.gave_up_without_site, c.time_at(0.5), c.time_at(0.9),
                     c.landings > 0 ? c.accumulation_s / c.landings : 0);
}

}  // namespace

Interval wilson(int successes, int trials) {
  if (trials <= 0) return {};
  constexpr double kZ = 1.959963984540054;
  const double n = trials;
  const double p = successes / n;
  const double middle = (p + kZ * kZ / (2 * n)) / (1 + kZ * kZ / n);
  const double half = kZ / (1 + kZ * kZ / n) * std::sqrt(p * (1 - p) / n + kZ * kZ / (4 * n * n));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

std::string campaign_report(const std::vector<LandingResult>& rows, double wanted_radius_m) {
  Counts all;
  std::map<std::string, Counts> by_look;
  std::map<std::string, Counts> by_fault;
  for (const LandingResult& r : rows) {
    all.add(r, wanted_radius_m);
    by_look[r.look].add(r, wanted_radius_m);
    by_fault[r.fault_kind()].add(r, wanted_radius_m);
  }
  std::string page = head("") + row("all", all) + "\n" + head("look");
  for (const auto& [look, counts] : by_look) page += row(look, counts);
  if (by_fault.size() > 1 || by_fault.count("none") == 0) {
    page += "\n" + head("fault");
    for (const auto& [fault, counts] : by_fault) page += row(fault, counts);
  }
  const Interval unsafe = wilson(all.unsafe + all.collided, all.landings);
  page += fmt::format(
      "\nA site is within reach where the truth has safe ground of {:.1f} m radius inside the geofence. "
      "Unsafe touchdowns and collisions: {} of {} landings, 95 % interval {:.2f} to {:.2f} %. {} touchdowns "
      "at a least bad site. Computing took {:.1f} s of a core a landing.\n",
      wanted_radius_m, all.unsafe + all.collided, all.landings, 100 * unsafe.low, 100 * unsafe.high,
      all.least_bad, all.landings > 0 ? all.cost_s / all.landings : 0.0);
  std::string bad;
  std::string refused;
  for (const LandingResult& r : rows) {
    const std::string line = "* " + describe(r, wanted_radius_m) + "\n";
    if (r.outcome == Outcome::kUnsafe || r.outcome == Outcome::kCollided) bad += line;
    if (r.outcome == Outcome::kGaveUp && r.safe_radius_m >= wanted_radius_m) refused += line;
  }
  if (!bad.empty()) page += "\nUnsafe touchdowns and collisions:\n\n" + bad;
  if (!refused.empty()) page += "\nGiven up though a site was within reach:\n\n" + refused;
  return page;
}

}  // namespace alight::closed_loop
