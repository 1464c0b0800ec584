#include "train/evaluation/scores/evaluator.hpp"

#include <algorithm>
#include <deque>
#include <future>
#include <optional>
#include <thread>

#include "infer/depth/self_evaluation.hpp"

namespace alight {
namespace {

/// What one sample adds to a cell.
struct CellPart {
  std::array<PixelErrors, kRegions.size()> regions;
  std::optional<double> similarity;
};

struct SamplePart {
  std::vector<std::vector<CellPart>> cells;  // [method][feeding]
  double first_method_rmse_mm = 0;
};

class SampleEvaluation {
 public:
  SampleEvaluation(const DepthMethods& methods, SampleSource& source, const RectifiedRig& rig,
                   const EvaluationConfig& config)
      : methods_(methods), source_(source), rig_(rig), config_(config), feedings_(config.feedings()) {}

  SamplePart operator()(std::size_t index) const {
    const DepthSample sample = source_.get(index);
    const cv::Mat dense_m = sample.dense.defined() ? tensor_to_depth(sample.dense) : cv::Mat();
    const Judge judge(*this, sample, dense_m);
    SamplePart part;
    part.cells.resize(methods_.size());
    for (const Feeding& feeding : feedings_) {
      const torch::Tensor fed_m = feed(sample, feeding, static_cast<std::uint64_t>(config_.seed) + index);
      for (std::size_t m = 0; m < methods_.size(); ++m) {
        const cv::Mat predicted_m = tensor_to_depth(methods_[m]->complete(sample, fed_m));
        part.cells[m].push_back(judge.cell(predicted_m, tensor_to_depth(fed_m), feeding));
        if (m == 0 && feeding.name() == config_.picture_feeding) {
          part.first_method_rmse_mm = judge.truth_rmse_mm(part.cells[m].back(), !dense_m.empty());
        }
      }
    }
    return part;
  }

 private:
  /// What is the same for all predictions of a sample.
  class Judge {
   public:
    Judge(const SampleEvaluation& all, const DepthSample& sample, const cv::Mat& dense_m)
        : regions_(tensor_to_depth(sample.sparse), dense_m, all.rig_, all.config_.regions),
          plane_m_(tensor_to_depth(make_altitude_plane(all.config_.baselines)
                                       ->complete(sample, torch::zeros_like(sample.sparse)))) {
      if (sample.has_right) {
        stereo_.emplace(tensor_to_image(sample.left), tensor_to_image(sample.right), all.rig_);
      }
    }

    CellPart cell(const cv::Mat& predicted_m, const cv::Mat& fed_m, const Feeding& feeding) const {
      CellPart part;
      for (std::size_t i = 0; i < kRegions.size(); ++i) {
        if (const auto pixels = regions_.pixels(kRegions[i], fed_m)) {
          part.regions[i] = measure(predicted_m, plane_m_, pixels->truth_m, pixels->mask);
        }
      }
      if (stereo_ && feeding.kind == Feeding::Kind::kShare) part.similarity = similarity(predicted_m);
      return part;
    }

    static double truth_rmse_mm(const CellPart& part, bool dense) {
      const Region region = dense ? Region::kDense : Region::kAll;
      return part.regions[static_cast<std::size_t>(region)].value(Metric::kRmse);
    }

   private:
    std::optional<double> similarity(const cv::Mat& predicted_m) const {
      cv::Mat whole_m = predicted_m.clone();
      plane_m_.copyTo(whole_m, ~(predicted_m > 0));
      return stereo_->score(stereo_->reconstruct(whole_m), nullptr).sim_pred;
    }

    SampleRegions regions_;
    cv::Mat plane_m_;
    std::optional<StereoTest> stereo_;
  };

  const DepthMethods& methods_;
  SampleSource& source_;
  const RectifiedRig& rig_;
  const EvaluationConfig& config_;
  std::vector<Feeding> feedings_;
};

void add(EvaluationReport& report, const EvaluationItem& item, const SamplePart& part) {
  for (std::size_t m = 0; m < part.cells.size(); ++m) {
    for (std::size_t f = 0; f < part.cells[m].size(); ++f) {
      const CellPart& from = part.cells[m][f];
      EvaluationCell& to = report.cells[m][f];
      for (std::size_t i = 0; i < kRegions.size(); ++i) {
        if (from.regions[i].pixels() + from.regions[i].unknown() > 0)
          to.regions[i].add(item.flight, from.regions[i]);
      }
      if (from.similarity) to.similarity.add(item.flight, *from.similarity);
    }
  }
  report.first_method.push_back({item, part.first_method_rmse_mm});
}

EvaluationReport empty_report(const DepthMethods& methods, const EvaluationConfig& config) {
  EvaluationReport report;
  for (const auto& method : methods) report.methods.push_back(method->name());
  report.feedings = config.feedings();
  report.cells.assign(methods.size(), std::vector<EvaluationCell>(report.feedings.size()));
  report.regions = config.regions;
  return report;
}

}  // namespace

EvaluationReport evaluate(const DepthMethods& methods, SampleSource& source,
                          const std::vector<EvaluationItem>& items, const RectifiedRig& rig,
                          const EvaluationConfig& config, const std::function<void()>& progress) {
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t at_once = config.threads > 0 ? static_cast<std::size_t>(config.threads) : cores;
  const SampleEvaluation evaluation(methods, source, rig, config);
  EvaluationReport report = empty_report(methods, config);
  std::deque<std::future<SamplePart>> pending;
  std::size_t started = 0;
  for (const EvaluationItem& item : items) {
    while (started < items.size() && pending.size() < at_once) {
      pending.push_back(std::async(std::launch::async, [&evaluation, index = items[started++].index] {
        at::set_num_threads(1);  // the samples share the cores
        return evaluation(index);
      }));
    }
    add(report, item, pending.front().get());  // in the items' order, so that sums are the same every time
    pending.pop_front();
    if (progress) progress();
  }
  return report;
}

}  // namespace alight
