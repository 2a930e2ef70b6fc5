// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "parkade/cli/object_truth.hpp"
#include "parkade/cli/sample_score.hpp"
#include "parkade/eval/statistics.hpp"
#include "parkade/geometry/so3.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/pipeline/stitched_views.hpp"
#include "parkade/semantics/drawing/draw_labels.hpp"
#include "parkade/semantics/drawing/draw_objects.hpp"
#include "parkade/semantics/lines/line_extraction.hpp"
#include "parkade/semantics/networks/segmentation.hpp"
#include "parkade/semantics/slots/slot_extraction.hpp"
#include "parkade/semantics/standing/object_extraction.hpp"

namespace parkade::cli {
namespace {

const std::vector<SemanticClass> kClasses = {
    SemanticClass::kArrow,     SemanticClass::kSpeedLimitPaint, SemanticClass::kStopLine,
    SemanticClass::kCrossing,  SemanticClass::kSpeedBump,       SemanticClass::kPaintedNumber,
    SemanticClass::kWheelStop, SemanticClass::kPillar,          SemanticClass::kVehicle,
    SemanticClass::kPedestrian};
constexpr double kNear = 5.0;  // m from the picture's middle

// Found and true objects of one class.
struct ClassScore {
  int true_in_sight = 0;
  int found = 0;      // of those
  int told = 0;       // detections
  int mistaken = 0;   // of those, where nothing is
  int with_text = 0;  // found ones that have one in truth
  int text_right = 0;
  int text_wrong = 0;
  int direction_right = 0;
  int with_direction = 0;
  std::vector<double> errors;
  std::vector<double> near_errors;
  double chi2 = 0.0;  // sum of squared errors over the covariances

  [[nodiscard]] double recall() const {
    return true_in_sight > 0 ? static_cast<double>(found) / true_in_sight : 0.0;
  }
  [[nodiscard]] double precision() const {
    return told > 0 ? 1.0 - static_cast<double>(mistaken) / told : 0.0;
  }
};

struct Told {
  SemanticClass semantic_class = SemanticClass::kUnknown;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
  double heading = 0.0;
  bool has_heading = false;
  std::string text;
};

// Where the place should be. A vehicle's may be anywhere along its outline: which point of it is
// nearest is not what counts.
Eigen::Vector2d rightPlace(const Told& told, const TrueObject& object) {
  if (object.semantic_class != SemanticClass::kVehicle) return object.position;
  const Eigen::Matrix2d R = object.box.axes();
  Eigen::Vector2d d = R.transpose() * (told.position - object.box.center);
  const Eigen::Vector2d half = 0.5 * object.box.size;
  const Eigen::Vector2d inside = half - d.cwiseAbs();
  if (inside.minCoeff() <= 0.0) return object.box.nearestTo(told.position);
  const int face = inside.x() < inside.y() ? 0 : 1;
  d[face] = d[face] < 0.0 ? -half[face] : half[face];
  return object.box.center + R * d;
}

double distance(const Told& told, const TrueObject& object) {
  return (told.position - rightPlace(told, object)).norm();
}

double gateOf(SemanticClass c) {
  return c == SemanticClass::kVehicle ? 1.0 : 0.7;
}

class ObjectScore : public SampleScore {
 public:
  ObjectScore(ObjectScoreOptions options, std::optional<SegmentationNetwork> network)
      : options_(std::move(options)), network_(std::move(network)) {}

  Status begin(const SemanticSampler& sampler) override {
    garage_ = sampler.simulation().spec().garage_seed;
    views_ = viewsOf(sampler.stitcher(), sampler.simulation().toldRig());
    extractor_.emplace(sampler.stitcher().geometry(), views_);
    return {};
  }

  Status add(const SemanticSampler& sampler, const SemanticSample& sample) override {
    BevLabels labels;
    if (network_) {
      Result<BevLabels> found = network_->segment(sample.bev);
      if (!found) return found.error();
      labels = std::move(found).value();
    } else {
      labels.geometry = sample.bev.geometry;
      labels.labels = sample.bev_labels;
      labels.confidence = cv::Mat(sample.bev_labels.size(), CV_8UC1, cv::Scalar(255));
    }
    const Lines lines = extractLines(sample.bev, labels, options_.attitude_sigma);
    const std::vector<SlotObservation> slots =
        extractSlots(sample.bev, labels, lines.segments, views_,
                     {options_.attitude_sigma, options_.height_sigma});
    const FoundObjects found = extractor_->extract(labels, slots, options_.attitude_sigma);
    std::vector<Told> told;
    for (const ObjectObservation& o : found.objects) {
      told.push_back({o.semantic_class, o.position.head<2>(), o.covariance.topLeftCorner<2, 2>(),
                      o.heading, o.sigma_heading > 0.0, o.text});
    }
    for (const AgentDetection& a : found.agents) {
      told.push_back({a.semantic_class, a.contact, a.covariance, 0.0, false, ""});
    }
    const std::vector<TrueObject> truth = trueObjects(sampler, sample, views_);
    for (const SemanticClass c : kClasses) match(c, told, truth, sample.bev.geometry.center);
    ++samples_;
    return options_.pictures.empty() ? Status() : writePicture(sample, labels, found, truth);
  }

  [[nodiscard]] std::string table() const override;
  void writeTo(nlohmann::json& metrics) const override;

 private:
  void match(SemanticClass c, const std::vector<Told>& told, const std::vector<TrueObject>& truth,
             const Eigen::Vector2d& middle) {
    ClassScore& score = scores_[c];
    std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
    std::vector<bool> explained(told.size(), false);
    for (std::size_t i = 0; i < told.size(); ++i) {
      if (told[i].semantic_class != c) continue;
      ++score.told;
      for (std::size_t k = 0; k < truth.size(); ++k) {
        if (truth[k].semantic_class != c) continue;
        const double d = distance(told[i], truth[k]);
        if (d < gateOf(c)) pairs.emplace_back(d, i, k);
      }
    }
    // Those in sight first: they have to be found.
    std::sort(pairs.begin(), pairs.end(), [&](const auto& a, const auto& b) {
      const bool sight_a = truth[std::get<2>(a)].in_sight;
      const bool sight_b = truth[std::get<2>(b)].in_sight;
      return sight_a != sight_b ? sight_a : a < b;
    });
    std::vector<bool> done(truth.size(), false);
    std::vector<bool> used(told.size(), false);
    for (const auto& [d, i, k] : pairs) {
      explained[i] = true;
      if (used[i] || done[k]) continue;
      used[i] = done[k] = true;
      if (truth[k].in_sight) addPair(score, told[i], truth[k], d, middle);
    }
    for (std::size_t i = 0; i < told.size(); ++i) {
      if (told[i].semantic_class == c && !explained[i]) ++score.mistaken;
    }
    for (std::size_t k = 0; k < truth.size(); ++k) {
      if (truth[k].semantic_class == c && truth[k].in_sight) ++score.true_in_sight;
    }
  }

  static void addPair(ClassScore& score, const Told& told, const TrueObject& object, double error,
                      const Eigen::Vector2d& middle) {
    ++score.found;
    score.errors.push_back(error);
    if ((object.position - middle).norm() < kNear) score.near_errors.push_back(error);
    const Eigen::Vector2d off = told.position - rightPlace(told, object);
    score.chi2 += off.dot(told.covariance.llt().solve(off));
    if (object.semantic_class == SemanticClass::kArrow) {
      ++score.with_direction;
      constexpr double kOff = 15.0 * M_PI / 180.0;
      const bool right = told.has_heading && told.text == object.text &&
                         std::abs(wrapAngle(told.heading - object.heading)) < kOff;
      score.direction_right += right ? 1 : 0;
    }
    if (object.semantic_class == SemanticClass::kArrow ||
        object.semantic_class == SemanticClass::kSpeedLimitPaint) {
      ++score.with_text;
      score.text_right += told.text == object.text ? 1 : 0;
      score.text_wrong += !told.text.empty() && told.text != object.text ? 1 : 0;
    }
  }

  Status writePicture(const SemanticSample& sample, const BevLabels& labels,
                      const FoundObjects& found, const std::vector<TrueObject>& truth) const {
    std::vector<ObjectObservation> real;
    for (const TrueObject& object : truth) {
      if (!object.in_sight) continue;
      ObjectObservation o;
      o.semantic_class = object.semantic_class;
      o.position << object.position, 0.0;
      o.heading = object.heading;
      o.sigma_heading = object.text.empty() ? 0.0 : 1.0;
      o.text = object.text;
      o.outline = object.box.size.x() > 0.0 ? object.box.outline() : o.outline;
      real.push_back(o);
    }
    const BevGeometry& g = sample.bev.geometry;
    const cv::Mat parts[2] = {
        drawObjects(drawLabels(sample.bev.image, labels.labels, 0.4), g, found.objects,
                    untracked(found.agents), 2.0),
        drawObjects(drawLabels(sample.bev.image, labels.labels, 0.0), g, real, {}, 2.0)};
    cv::Mat picture(parts[0].rows, 2 * parts[0].cols, CV_8UC3);
    for (int k = 0; k < 2; ++k) {
      cv::Mat place = picture.colRange(k * parts[0].cols, (k + 1) * parts[0].cols);
      parts[k].copyTo(place);
    }
    return writeImage(joinPath(options_.pictures,
                               fmt::format("g{}_{:03d}_objects.png", garage_, sample.frames.index)),
                      picture, {.png = true});
  }

  ObjectScoreOptions options_;
  std::optional<SegmentationNetwork> network_;
  BevViews views_;
  std::optional<ObjectExtractor> extractor_;
  std::map<SemanticClass, ClassScore> scores_;
  int samples_ = 0;
  int garage_ = 0;
};

std::string ObjectScore::table() const {
  std::string text = fmt::format(
      "Objects from {} labels, {} pictures: what is whole in sight must be found\n"
      "{:<18} {:>6} {:>7} {:>6} {:>9} {:>10} {:>10} {:>10} {:>6}\n",
      network_ ? "the network's" : "true", samples_, "class", "true", "recall", "told", "precision",
      "median m", "p95 m", "med 5 m", "chi2");
  const auto out = std::back_inserter(text);
  for (const SemanticClass c : kClasses) {
    const auto it = scores_.find(c);
    if (it == scores_.end()) continue;
    const ClassScore& s = it->second;
    if (s.told == 0 && s.true_in_sight == 0) continue;
    fmt::format_to(out,
                   "{:<18} {:>6} {:>7.3f} {:>6} {:>9.3f} {:>10.3f} {:>10.3f} {:>10.3f} {:>6.2f}\n",
                   kSemanticClassNames[static_cast<std::size_t>(c)], s.true_in_sight, s.recall(),
                   s.told, s.precision(), quantile(s.errors, 0.5), quantile(s.errors, 0.95),
                   quantile(s.near_errors, 0.5), s.found > 0 ? s.chi2 / (2.0 * s.found) : 0.0);
  }
  for (const SemanticClass c : {SemanticClass::kArrow, SemanticClass::kSpeedLimitPaint}) {
    const auto it = scores_.find(c);
    if (it == scores_.end() || it->second.with_text == 0) continue;
    const ClassScore& s = it->second;
    fmt::format_to(out, "{}: {} of {} read right, {} wrong",
                   kSemanticClassNames[static_cast<std::size_t>(c)], s.text_right, s.with_text,
                   s.text_wrong);
    if (s.with_direction > 0) {
      fmt::format_to(out, "; direction right {:.3f}",
                     static_cast<double>(s.direction_right) / s.with_direction);
    }
    text += "\n";
  }
  return text;
}

void ObjectScore::writeTo(nlohmann::json& metrics) const {
  nlohmann::json& all = metrics["objects"];
  all["pictures"] = samples_;
  for (const auto& [c, s] : scores_) {
    if (s.told == 0 && s.true_in_sight == 0) continue;
    nlohmann::json& one = all[std::string(kSemanticClassNames[static_cast<std::size_t>(c)])];
    one = {{"in_sight", s.true_in_sight},
           {"recall", s.recall()},
           {"told", s.told},
           {"precision", s.precision()}};
    if (s.found > 0) {
      one["error_median"] = quantile(s.errors, 0.5);
      one["error_p95"] = quantile(s.errors, 0.95);
      one["chi2_per_dimension"] = s.chi2 / (2.0 * s.found);
    }
    if (!s.near_errors.empty()) one["error_median_to_5m"] = quantile(s.near_errors, 0.5);
    if (s.with_text > 0) {
      one["text_right"] = static_cast<double>(s.text_right) / s.with_text;
      one["text_wrong"] = static_cast<double>(s.text_wrong) / s.with_text;
    }
    if (s.with_direction > 0) {
      one["direction_right"] = static_cast<double>(s.direction_right) / s.with_direction;
    }
  }
}

}  // namespace

Result<std::unique_ptr<SampleScore>> makeObjectScore(const ObjectScoreOptions& options) {
  std::optional<SegmentationNetwork> network;
  if (!options.true_labels) {
    Result<SegmentationNetwork> loaded =
        SegmentationNetwork::loadOrOwn(options.bev_network, kBevNetwork);
    if (!loaded) return loaded.error();
    network = std::move(loaded).value();
  }
  if (!options.pictures.empty()) {
    const Status status = makeFolders(options.pictures);
    if (!status) return status.error();
  }
  return std::unique_ptr<SampleScore>(new ObjectScore(options, std::move(network)));
}

}  // namespace parkade::cli
