#include "train/evaluation/self/self_markdown.hpp"

#include <cmath>
#include <functional>
#include <map>

#include <fmt/format.h>

namespace alight {
namespace {

std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.1f} %", 100 * share) : "-";
}

std::string describe(const GoodDepth& good) {
  return fmt::format(
      "{:g} % of the pixels with true depth err by no more than {:g} m or {:g} % of the depth, whichever is "
      "more",
      100 * good.share, good.error_m, 100 * good.error_relative);
}

std::size_t count_good(const MapList& maps, std::size_t definition) {
  std::size_t count = 0;
  for (const MapScores* map : maps) count += map->good.at(definition) ? 1 : 0;
  return count;
}

std::string count_text(const MapList& maps, std::size_t definition = 0) {
  return fmt::format("{} maps, {} of them good", maps.size(), count_good(maps, definition));
}

std::string area_text(const FlightCases& cases) {
  const auto area = area_under_roc(pooled(cases));
  if (!area) return "-";
  const auto error = area_standard_error(cases);
  return error ? fmt::format("{:.3f} ± {:.3f}", *area, *error) : fmt::format("{:.3f}", *area);
}

std::string criteria_table(const SelfReport& report, const MapList& maps, std::size_t definition = 0) {
  std::string table =
      "| accepted by | AUROC | false accepts at 95 % recall | maps without evidence "
      "|\n|---|---:|---:|---:|\n";
  for (const Criterion& criterion : criteria()) {
    const FlightCases cases = cases_of(maps, criterion, report.config.image.self_evaluation, definition);
    int silent = 0;
    for (const ScoredCase& c : pooled(cases)) silent += std::isinf(c.score) ? 1 : 0;
    const auto rate = false_accept_rate_at(pooled(cases), 0.95);
    table += fmt::format("| {} | {} | {} | {} |\n", criterion.title, area_text(cases),
                         rate ? percent(*rate).c_str() : "-", silent);
  }
  return table + "\n";
}

std::string decision_table(const SelfReport& report, const MapList& maps, std::size_t definition = 0) {
  std::string table =
      "| decide_by | true accepts | false accepts | maps without evidence |\n|---|---:|---:|---:|\n";
  for (const Decision& decision : decisions()) {
    const DecisionRates rates = rates_of(maps, decision, report.config.image.self_evaluation, definition);
    table += std::string("| ") + decision.title + " | " + percent(rates.recall) + " | " +
             percent(rates.false_accept_rate) + " | " + percent(rates.no_evidence) + " |\n";
  }
  return table + "\n";
}

/// Parts of the maps in the order of their names.
using Groups = std::map<std::string, MapList>;
Groups grouped(const MapList& maps, const std::function<std::string(const MapScores&)>& group_of) {
  Groups groups;
  for (const MapScores* map : maps) groups[group_of(*map)].push_back(map);
  return groups;
}

/// The areas of all criteria, and what the decisions do, a group a line.
std::string group_table(const SelfReport& report, const std::string& corner, const Groups& groups) {
  std::string head = "| " + corner + " | maps | good |";
  std::string rule = "|---|---:|---:|";
  for (const Criterion& criterion : criteria()) {
    head += std::string(" ") + criterion.title + " |";
    rule += "---:|";
  }
  std::string table = head + "\n" + rule + "\n";
  for (const auto& [group, maps] : groups) {
    table += fmt::format("| {} | {} | {} |", group, maps.size(), count_good(maps, 0));
    for (const Criterion& criterion : criteria()) {
      table += " " + area_text(cases_of(maps, criterion, report.config.image.self_evaluation)) + " |";
    }
    table += "\n";
  }
  return table + "\n";
}

std::string group_decision_table(const SelfReport& report, const std::string& corner, const Groups& groups) {
  std::string head = "| " + corner + " |";
  std::string rule = "|---|";
  for (const Decision& decision : decisions()) {
    head += std::string(" ") + decision.title + " |";
    rule += "---:|";
  }
  std::string table = head + "\n" + rule + "\n";
  for (const auto& [group, maps] : groups) {
    table += "| " + group + " |";
    for (const Decision& decision : decisions()) {
      const DecisionRates rates = rates_of(maps, decision, report.config.image.self_evaluation);
      table += " " + percent(rates.recall) + ", " + percent(rates.false_accept_rate) + " |";
    }
    table += "\n";
  }
  return table + "\n";
}

std::string altitude_band(const MapScores& map) {
  if (map.depth_m < 10) return "below 10 m";
  if (map.depth_m < 20) return "from 10 to 20 m";
  return map.depth_m < 30 ? "from 20 to 30 m" : "from 30 m on";
}

/// village_2 -> village
std::string world_look(const MapScores& map) { return map.flight.substr(0, map.flight.find('_')); }

/// How many maps of a kind and window there are, and how many are good.
std::string origin_table(const SelfReport& report, const MapList& all) {
  std::string head = "| good maps |";
  std::string rule = "|---|";
  for (const double window_s : report.config.windows_s) {
    head += fmt::format(" {:g} s |", window_s);
    rule += "---:|";
  }
  std::string table = head + "\n" + rule + "\n";
  for (const auto& [origin, maps] : grouped(all, [](const MapScores& map) { return name(map.origin); })) {
    table += "| " + origin + " |";
    for (const double window_s : report.config.windows_s) {
      MapList cell;
      for (const MapScores* map : maps) {
        if (map->window_s == window_s) cell.push_back(map);
      }
      table += fmt::format(" {} of {} |", count_good(cell, 0), cell.size());
    }
    table += "\n";
  }
  return table + "\n";
}

std::string head(const SelfReport& report, const MapList& all) {
  const SelfScoreConfig& config = report.config;
  std::string out =
      "# Self-evaluation, evaluated\n\nHow well the onboard loop tells depth that is good enough to land by "
      "from depth that is not. Made by\n```\n" +
      report.command + "\n```\n";
  for (const auto& [key, value] : report.about) out += "- " + key + ": " + value + "\n";
  out += "- good: " + describe(config.good.front()) +
         ". The lowest step that the site selection tells from flat ground is 9 cm, so 10 cm are the "
         "smallest error that "
         "makes or hides an obstacle\n";
  out += fmt::format(
      "- hold-out: the LiDAR points of the {:g} s after the fed window; sim_d is made from them and the fed "
      "ones, which the onboard loop has when it judges\n",
      config.holdout_s);
  out += fmt::format(
      "- wrong on purpose, besides the network's own maps (`network`): level ground at the reported height "
      "(`altitude_plane`), the network told a height {:g} times as large (`wrong_height`), ",
      config.height_factor);
  out += fmt::format(
      "its depth times {:g} (`too_far`) and times {:g} (`too_near`), linear interpolation of the fed points "
      "(`delaunay`)\n\n",
      config.depth_factor, 2 - config.depth_factor);
  return out + "Columns: LiDAR time fed.\n\n" + origin_table(report, all);
}

}  // namespace

std::string to_markdown(const SelfReport& report) {
  const MapList own = chosen_maps(report, /*own_alone=*/true);
  const MapList all = chosen_maps(report, /*own_alone=*/false);
  const auto section = [&](const char* title, const MapList& maps) {
    return std::string("## ") + title + "\n\n" + count_text(maps) + ".\n\n" + criteria_table(report, maps) +
           decision_table(report, maps);
  };
  std::string out = head(report, all);
  out +=
      "AUROC: the probability that a good map scores above one that is not, ± its standard error by a "
      "bootstrap over "
      "flights; 0.5 is chance. Maps without evidence are never accepted, so they count as the lowest score. "
      "False accepts "
      "at 95 % recall: of the threshold that accepts 95 % of the good maps, `-` where too many of them come "
      "without "
      "evidence. The decisions are those of the onboard loop with the thresholds of its configuration; "
      "`paper's rules "
      "alone` have no probe and never abstain for want of contrast.\n\n";
  if (!report.figure.empty()) out += "![ROC curves](" + report.figure + ")\n\n";
  out += section("The network's own maps", own) + section("With the maps that are wrong on purpose", all);
  const auto groups = [&](const char* title, const char* corner, const Groups& by) {
    return std::string("## By ") + title +
           "\n\nAll maps: AUROC, then true and false accepts of the decisions.\n\n" +
           group_table(report, corner, by) + group_decision_table(report, corner, by);
  };
  out += groups("altitude", "median depth", grouped(all, altitude_band));
  out += groups("the look of the world", "flights", grouped(all, world_look));
  for (std::size_t i = 1; i < report.config.good.size(); ++i) {
    out += "## Another definition of good\n\nWhere " + describe(report.config.good[i]) + ": " +
           count_text(own, i) + ", of the network's own; " + count_text(all, i) +
           ", of all. Own maps, then all.\n\n";
    for (const MapList& maps : {own, all})
      out += criteria_table(report, maps, i) + decision_table(report, maps, i);
  }
  out.pop_back();
  return out;
}

}  // namespace alight
