#include "closed_loop/campaign/campaign.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "closed_loop/landing/landing_pictures.hpp"
#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "foundation/file_content.hpp"
#include "foundation/output_folder.hpp"
#include "pictures/picture_file.hpp"
#include "sim/counter_random.hpp"

namespace alight::closed_loop {
namespace fs = std::filesystem;
namespace {

constexpr const char* kNoFault = "none";

sim::Look look_of(const std::string& name) {
  for (const sim::Look look : sim::all_looks()) {
    if (sim::to_string(look) == name) return look;
  }
  std::string known;
  for (const sim::Look look : sim::all_looks()) known += (known.empty() ? "" : ", ") + sim::to_string(look);
  throw ConfigError("--looks " + name + ": no such look; there are " + known);
}

const sim::Fault* fault_of(const std::string& name) {
  if (name == kNoFault) return nullptr;
  if (const sim::Fault* fault = sim::find_fault(name)) return fault;
  std::string known = kNoFault;
  for (const sim::Fault& fault : sim::all_faults()) known += ", \"" + fault.name + "\"";
  throw ConfigError("--faults " + name + ": no such fault; there are " + known + "; all names every one");
}

std::string plan_json(const CampaignPlan& plan) {
  const nlohmann::ordered_json json = {{"first_seed", plan.first_seed},
                                       {"looks", plan.looks},
                                       {"faults", plan.faults},
                                       {"lidar_only", plan.lidar_only},
                                       {"fault_from_s", plan.fault_from_s},
                                       {"fault_to_s", plan.fault_to_s},
                                       {"fault_lasts_s", plan.fault_lasts_s},
                                       {"lasting_share", plan.lasting_share},
                                       {"worlds", plan.worlds}};
  return json.dump(1) + "\n";
}

std::string read_file(const fs::path& path) {
  std::optional<std::string> content = file_content(path);
  if (!content) throw DataError(path.string() + ": cannot be read; is this the folder of a campaign?");
  return std::move(*content);
}

CampaignPlan read_plan(const fs::path& path) {
  try {
    const auto json = nlohmann::json::parse(read_file(path));
    CampaignPlan plan;
    plan.first_seed = json.at("first_seed").get<int>();
    plan.looks = json.at("looks").get<std::vector<std::string>>();
    plan.faults = json.at("faults").get<std::vector<std::string>>();
    plan.lidar_only = json.at("lidar_only").get<bool>();
    plan.fault_from_s = json.at("fault_from_s").get<double>();
    plan.fault_to_s = json.at("fault_to_s").get<double>();
    plan.fault_lasts_s = json.at("fault_lasts_s").get<std::vector<double>>();
    plan.lasting_share = json.at("lasting_share").get<double>();
    plan.worlds = json.at("worlds").get<int>();
    return plan;
  } catch (const nlohmann::json::exception& e) {
    throw DataError(path.string() + ": is no plan of a campaign: " + e.what());
  }
}

}  // namespace

void check(const CampaignPlan& plan) {
  if (plan.looks.empty()) throw ConfigError("--looks: name at least one");
  for (const std::string& look : plan.looks) look_of(look);
  for (const std::string& fault : plan.faults) fault_of(fault);
  if (plan.fault_from_s > plan.fault_to_s) throw ConfigError("--fault-from: must not exceed --fault-to");
  const std::vector<double>& lasts_s = plan.fault_lasts_s;
  if (!lasts_s.empty() && (lasts_s.size() != 2 || lasts_s[0] <= 0 || lasts_s[1] < lasts_s[0]))
    throw ConfigError("--fault-duration: name the shortest and the longest time in seconds, such as 2,10");
}

CampaignLanding planned(const CampaignPlan& plan, int index) {
  const auto looks = static_cast<int>(plan.looks.size());
  CampaignLanding landing;
  landing.seed = plan.first_seed + index;
  landing.look = look_of(plan.looks[static_cast<std::size_t>(index % looks)]);
  if (plan.faults.empty()) return landing;
  const auto faults = static_cast<int>(plan.faults.size());
  landing.fault.fault = fault_of(plan.faults[static_cast<std::size_t>(index / looks % faults)]);
  if (landing.fault.fault == nullptr) return landing;
  const sim::CounterRandom random(static_cast<std::uint64_t>(landing.seed), sim::RandomStream::kLandingFault);
  landing.fault.at_s = random.uniform(0, plan.fault_from_s, plan.fault_to_s);
  if (!plan.fault_lasts_s.empty() && random.uniform(2) >= plan.lasting_share)
    landing.fault.lasts_s = random.uniform(1, plan.fault_lasts_s.front(), plan.fault_lasts_s.back());
  return landing;
}

CampaignFolder::CampaignFolder(const fs::path& path, const CampaignPlan& plan, const LandConfig& config)
    : path_(path), plan_(plan) {
  const std::string yaml = print_config(config);
  if (fs::exists(path_ / "plan.json")) {
    CampaignPlan old = read_plan(path_ / "plan.json");
    old.worlds = plan.worlds;
    if (plan_json(old) != plan_json(plan) || read_file(path_ / "config.yaml") != yaml) {
      throw ConfigError(
          "--output " + path_.string() +
          ": holds a campaign with another plan or configuration; go on with the same options, or "
          "name another folder");
    }
  } else {
    fs::create_directories(path_ / "pictures");
    write_file_atomically(path_ / "config.yaml", yaml);
  }
  write_file_atomically(path_ / "plan.json", plan_json(plan));
}

CampaignFolder::CampaignFolder(const fs::path& path) : path_(path), plan_(read_plan(path / "plan.json")) {}

LandConfig CampaignFolder::config() const { return load_config<LandConfig>(path_ / "config.yaml"); }

std::vector<LandingResult> CampaignFolder::rows() const {
  std::vector<LandingResult> rows;
  std::ifstream stream(path_ / "rows.jsonl");
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (!line.empty())
      rows.push_back(result_from_json(line, (path_ / "rows.jsonl:").string() + std::to_string(number)));
  }
  std::sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.seed < b.seed; });
  return rows;
}

std::vector<int> CampaignFolder::missing() const {
  std::set<int> flown;
  for (const LandingResult& row : rows()) flown.insert(row.seed - plan_.first_seed);
  std::vector<int> indices;
  for (int i = 0; i < plan_.worlds; ++i) {
    if (flown.count(i) == 0) indices.push_back(i);
  }
  return indices;
}

void CampaignFolder::append(const LandingResult& result) const {
  const fs::path path = path_ / "rows.jsonl";
  const std::string line = to_json(result) + "\n";
  const int file = open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0644);
  const bool written =
      file >= 0 && write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  const int error = errno;
  if (file >= 0) close(file);
  if (!written) throw DataError(path.string() + ": cannot be written: " + std::strerror(error));
}

void CampaignFolder::write_pictures(const FlownLanding& flown, const sim::SurfaceTruth& truth,
                                    double body_radius_m) const {
  const std::string name = flown.result.look + "_" + std::to_string(flown.result.seed);
  fs::create_directories(path_ / "pictures");
  const cv::Mat top = top_picture(flown, truth, body_radius_m);
  cv::Mat side = trajectory_picture(flown, truth);
  cv::copyMakeBorder(side, side, 0, std::max(0, top.rows - side.rows), 0, 0, cv::BORDER_CONSTANT,
                     cv::Scalar::all(255));
  cv::Mat both;
  cv::hconcat(side(cv::Rect(0, 0, side.cols, std::min(side.rows, top.rows))), top, both);
  write_picture(path_ / "pictures" / (name + ".png"), both);
}

}  // namespace alight::closed_loop
