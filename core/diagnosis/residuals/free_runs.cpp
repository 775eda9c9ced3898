#include "telltale/core/diagnosis/residuals/free_runs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <list>
#include <mutex>
#include <span>
#include <utility>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/effects/augmented_boat.hpp"
#include "telltale/core/effects/sensor_chain.hpp"
#include "telltale/core/simulation/divergence.hpp"

namespace telltale {
namespace {

constexpr double kBinsPerWindow = kDiagnosis.free_runs.bins_per_window;
// Stamps of seconds since 1970 are exact to a fraction of a microsecond.
constexpr double kSameBin = 1e-4;
// Steps by which a start is varied: metres, radians, m/s, rad/s. Small against what windows show,
// large against rounding.
constexpr std::array kStartSteps = {1e-2, 1e-2, 1e-3, 1e-2, 1e-2, 1e-2};

Pose Moved(Pose pose, const Eigen::Matrix<double, 6, 1>& by) {
  pose.eta.x_m += by[0];
  pose.eta.y_m += by[1];
  pose.eta.psi_rad += by[2];
  pose.nu.u += by[3];
  pose.nu.v += by[4];
  pose.nu.r += by[5];
  return pose;
}

/// Poses between those of a track, which are step_s apart: by the parabola that fits the velocities
/// at both ends, a straight line before the first. Times that ascend cost least.
class TrackInterpolation {
 public:
  TrackInterpolation(const std::vector<Pose>& track, double step_s)
      : track_(track), step_s_(step_s), start_rate_(RateAt(0)), end_rate_(RateAt(1)) {}

  Eta At(double since_start_s) {
    const Place place = PlaceOf(since_start_s);
    const Pose& a = track_[place.step];
    const Pose& b = track_[place.step + 1];
    MoveTo(place.step);
    const Eigen::Vector3d faster = end_rate_ - start_rate_;
    return {
        a.eta.x_m + place.share * (b.eta.x_m - a.eta.x_m) - place.bow_s * faster[0],
        a.eta.y_m + place.share * (b.eta.y_m - a.eta.y_m) - place.bow_s * faster[1],
        a.eta.psi_rad + place.share * (b.eta.psi_rad - a.eta.psi_rad) - place.bow_s * faster[2]};
  }

  /// The heading alone.
  double HeadingAt(double since_start_s) const {
    const Place place = PlaceOf(since_start_s);
    const Pose& a = track_[place.step];
    const Pose& b = track_[place.step + 1];
    return a.eta.psi_rad + place.share * (b.eta.psi_rad - a.eta.psi_rad) -
           place.bow_s * (b.nu.r - a.nu.r);
  }

 private:
  struct Place {
    std::size_t step;
    double share;  ///< of the step
    double bow_s;
  };

  Place PlaceOf(double since_start_s) const {
    const double steps = since_start_s / step_s_;
    const auto last = static_cast<double>(track_.size() - 2);
    const auto step = static_cast<std::size_t>(std::clamp(std::floor(steps), 0.0, last));
    const double share = steps - static_cast<double>(step);
    return {step, share, share < 0.0 ? 0.0 : 0.5 * share * (1.0 - share) * step_s_};
  }

  /// Keeps the rates of the pose at both ends of a step.
  void MoveTo(std::size_t step) {
    if (step == step_) return;
    start_rate_ = step == step_ + 1 ? end_rate_ : RateAt(step);
    end_rate_ = RateAt(step + 1);
    step_ = step;
  }

  Eigen::Vector3d RateAt(std::size_t k) const {
    return EtaDot(track_[k].eta.psi_rad, track_[k].nu);
  }

  const std::vector<Pose>& track_;
  double step_s_;
  std::size_t step_ = 0;
  Eigen::Vector3d start_rate_;
  Eigen::Vector3d end_rate_;
};

/// The first of ascending times from a time on.
std::size_t FirstFrom(double time_s, const std::vector<double>& times_s) {
  return static_cast<std::size_t>(std::ranges::lower_bound(times_s, time_s) - times_s.begin());
}

double Limited(double error) {
  return std::isfinite(error) ? std::clamp(error, -kLargestFreeRunResidual, kLargestFreeRunResidual)
                              : kLargestFreeRunResidual;
}

/// The largest velocity over its limit.
double OverLimits(const Nu& nu, const Nu& limits) {
  const double over =
      std::max({std::abs(nu.u) / limits.u, std::abs(nu.v) / limits.v, std::abs(nu.r) / limits.r});
  return std::isfinite(nu.u + nu.v + nu.r) ? over : std::numeric_limits<double>::infinity();
}

Divergence DivergenceAlong(const std::vector<Pose>& track, const Nu& limits) {
  double farthest = 0.0;
  for (const Pose& pose : track) farthest = std::max(farthest, OverLimits(pose.nu, limits));
  return {farthest >= 1.0 ? std::size_t{1} : std::size_t{0}, farthest};
}

}  // namespace

void Divergence::Add(const Divergence& other) {
  windows += other.windows;
  farthest = std::max(farthest, other.farthest);
}

bool Divergence::IsWorseThan(const Divergence& other) const {
  constexpr double kMuch = 2.0;
  return windows > other.windows || farthest > kMuch * std::max(1.0, other.farthest);
}

/// The drives of the boats that were asked for last, the latest first. Safe from several threads.
class DriveCache {
 public:
  template <class Compute>
  std::shared_ptr<const DrivesBySegment> Of(const AugmentedBoat& boat, Compute compute) {
    if (auto known = Find(boat)) return known;
    auto drives = std::make_shared<const DrivesBySegment>(compute());
    const std::lock_guard lock(mutex_);
    if (entries_.size() == kMostBoats) entries_.pop_back();
    entries_.push_front({boat, drives});
    return drives;
  }

 private:
  // More than the thrust coefficients of an equation, which are varied in turn.
  static constexpr std::size_t kMostBoats = 8;

  struct Entry {
    AugmentedBoat boat;
    std::shared_ptr<const DrivesBySegment> drives;
  };

  std::shared_ptr<const DrivesBySegment> Find(const AugmentedBoat& boat) {
    const std::lock_guard lock(mutex_);
    const auto entry = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& candidate) {
      return candidate.boat.IsDrivenLike(boat);
    });
    if (entry == entries_.end()) return nullptr;
    entries_.splice(entries_.begin(), entries_, entry);
    return entry->drives;
  }

  std::mutex mutex_;
  std::list<Entry> entries_;
};

FreeRuns::FreeRuns(FreeRuns&&) noexcept = default;
FreeRuns& FreeRuns::operator=(FreeRuns&&) noexcept = default;
FreeRuns::~FreeRuns() = default;

FreeRuns::FreeRuns(const PreparedDataset& dataset, const VesselModel& base, double horizon_s)
    : dataset_(&dataset),
      horizon_s_(horizon_s),
      rows_(static_cast<std::size_t>(std::lround(horizon_s / dataset.sampling_period_s))),
      steps_(StepsPerRow(base, dataset.sampling_period_s)),
      step_s_(dataset.sampling_period_s / static_cast<double>(steps_)),
      drive_cache_(std::make_unique<DriveCache>()) {
  Require(horizon_s > 0.0, "a horizon");
  const double shortest_bin_s = std::max(horizon_s / kBinsPerWindow, dataset.sampling_period_s);
  bins_ = std::max<Eigen::Index>(
      1, static_cast<Eigen::Index>(std::floor(horizon_s / shortest_bin_s + 1e-9)));
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    const RowRange& segment = dataset.segments[s];
    for (std::size_t k = segment.begin; k + rows_ < segment.end; k += rows_) {
      Window window;
      if (Collect(s, k, window)) windows_.push_back(std::move(window));
    }
  }
  const AugmentedModel alone{base, {}};
  const Eigen::MatrixXd errors = RawErrors(alone, Offset::Zero());
  for (Window& window : windows_) window.by_start.resize(Rows(), 6);
  for (Eigen::Index i = 0; i < 6; ++i) {
    Offset offset = Offset::Zero();
    offset[i] = kStartSteps[static_cast<std::size_t>(i)];
    const Eigen::MatrixXd moved = RawErrors(alone, offset);
    for (std::size_t w = 0; w < windows_.size(); ++w) {
      windows_[w].by_start.col(i) =
          (moved.col(static_cast<Eigen::Index>(w)) - errors.col(static_cast<Eigen::Index>(w))) /
          offset[i];
    }
  }
  const double position =
      std::max(dataset.sensors.position_noise_m, kDiagnosis.free_runs.minimum_position_noise_m);
  const double heading =
      std::max(dataset.sensors.heading_noise_rad, kDiagnosis.free_runs.minimum_heading_noise_rad);
  for (Window& window : windows_) {
    Eigen::VectorXd weights = window.per_bin;
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
      weights[i] /= i % 3 == 2 ? heading * heading : position * position;
    }
    const Eigen::Matrix<double, 6, Eigen::Dynamic> weighted =
        window.by_start.transpose() * weights.asDiagonal();
    // A start that a short window leaves open stays where it was measured.
    const Eigen::Matrix<double, 6, 6> information = weighted * window.by_start;
    const Eigen::Matrix<double, 6, 6> regularised =
        information + 1e-9 * Eigen::Matrix<double, 6, 6>(information.diagonal().asDiagonal());
    window.start_estimator = regularised.ldlt().solve(weighted);
  }
}

bool FreeRuns::Collect(std::size_t segment, std::size_t first_row, Window& window) const {
  window.segment = segment;
  window.first_row = first_row;
  window.per_bin = Eigen::VectorXd::Zero(Rows());
  const double from = dataset_->rows[first_row].time_s;
  const double bin_s = horizon_s_ / static_cast<double>(bins_);
  const double beyond = from + horizon_s_ + bin_s;
  const auto bin_of = [&](double time_s) {
    return static_cast<Eigen::Index>(std::ceil((time_s - from) / bin_s - kSameBin)) - 1;
  };
  const RawSignals& raw = dataset_->signals[segment];
  const auto& fix_times = raw.north_m.times_s;
  for (std::size_t i = FirstFrom(from, fix_times); i < fix_times.size() && fix_times[i] < beyond;
       ++i) {
    const Eigen::Index bin = bin_of(fix_times[i]);
    if (bin < 0 || bin >= bins_) continue;
    const double psi = MeasuredAt(*dataset_, dataset_->segments[segment], fix_times[i]).eta.psi_rad;
    window.fixes.push_back({fix_times[i], raw.north_m.values[i], raw.east_m.values[i],
                            std::cos(psi), std::sin(psi), bin});
    window.per_bin[3 * bin] += 1.0;
    window.per_bin[3 * bin + 1] += 1.0;
  }
  const auto& heading_times = raw.psi_rad.times_s;
  for (std::size_t i = FirstFrom(from, heading_times);
       i < heading_times.size() && heading_times[i] < beyond; ++i) {
    const Eigen::Index bin = bin_of(heading_times[i]);
    if (bin < 0 || bin >= bins_) continue;
    window.headings.push_back({heading_times[i], raw.psi_rad.values[i], bin});
    window.per_bin[3 * bin + 2] += 1.0;
  }
  return window.per_bin.minCoeff() > 0.0;
}

std::shared_ptr<const DrivesBySegment> FreeRuns::DrivesOf(const AugmentedBoat& boat) const {
  return drive_cache_->Of(boat, [&] {
    DrivesBySegment drives;
    for (std::size_t s = 0; s < dataset_->segments.size(); ++s) {
      const RowRange& segment = dataset_->segments[s];
      drives.push_back(boat.DrivesAlong(dataset_->commands[s], dataset_->rows[segment.begin].time_s,
                                        step_s_, segment.size() * steps_));
    }
    return drives;
  });
}

template <class Visit>
void FreeRuns::ForEachTrack(const AugmentedModel& model, const Offset& offset, Visit visit) const {
  const AugmentedBoat boat(model, RecordingFrameOf(*dataset_), dataset_->hull);
  const auto drives = DrivesOf(boat);
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    const Window& window = windows_[w];
    const RowRange& segment = dataset_->segments[window.segment];
    const double from_s = dataset_->rows[window.first_row].time_s;
    const std::size_t first_step = (window.first_row - segment.begin) * steps_;
    const Pose start = Moved(TrueStart(*dataset_, segment, from_s, boat), offset);
    const auto ahead = std::span((*drives)[window.segment]).subspan(first_step, rows_ * steps_);
    visit(w, boat, from_s, boat.Simulate(start, ahead, from_s, step_s_));
  }
}

Eigen::MatrixXd FreeRuns::NoErrors() const {
  return Eigen::MatrixXd::Zero(Rows(), static_cast<Eigen::Index>(windows_.size()));
}

void FreeRuns::AddRawErrors(const Window& window, const AugmentedBoat& boat, double from_s,
                            const std::vector<Pose>& track,
                            Eigen::Ref<Eigen::VectorXd> error) const {
  const double ahead = dataset_->sensors.antenna.forward_m + boat.AntennaShift().forward_m;
  const double aside = dataset_->sensors.antenna.starboard_m + boat.AntennaShift().starboard_m;
  TrackInterpolation predicted(track, step_s_);
  for (const Fix& fix : window.fixes) {
    const Eta eta = predicted.At(fix.time_s - boat.LatencyS() - from_s);
    const Eigen::Vector2d antenna =
        Eigen::Vector2d(eta.x_m, eta.y_m) + Turned(eta.psi_rad, ahead, aside);
    const double north = Limited(fix.north_m - antenna[0]);
    const double east = Limited(fix.east_m - antenna[1]);
    error[3 * fix.bin] += fix.cos_psi * north + fix.sin_psi * east;
    error[3 * fix.bin + 1] += -fix.sin_psi * north + fix.cos_psi * east;
  }
  for (const MeasuredHeading& heading : window.headings) {
    const double psi = predicted.HeadingAt(heading.time_s - from_s);
    error[3 * heading.bin + 2] += Limited(heading.psi_rad - boat.MeasuredHeadingRad(psi));
  }
  error.array() /= window.per_bin.array();
}

void FreeRuns::EstimateStarts(Eigen::MatrixXd& errors) const {
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    auto error = errors.col(static_cast<Eigen::Index>(w));
    const Eigen::Matrix<double, 6, 1> start = windows_[w].start_estimator * error;
    error -= windows_[w].by_start * start;
  }
}

Eigen::MatrixXd FreeRuns::RawErrors(const AugmentedModel& model, const Offset& offset) const {
  Eigen::MatrixXd errors = NoErrors();
  ForEachTrack(
      model, offset,
      [&](std::size_t w, const AugmentedBoat& boat, double from_s, const std::vector<Pose>& track) {
        AddRawErrors(windows_[w], boat, from_s, track, errors.col(static_cast<Eigen::Index>(w)));
      });
  return errors;
}

Eigen::MatrixXd FreeRuns::Errors(const AugmentedModel& model) const {
  Eigen::MatrixXd errors = RawErrors(model, Offset::Zero());
  EstimateStarts(errors);
  return errors;
}

FreeRuns::Outcome FreeRuns::OutcomeOf(const AugmentedModel& model) const {
  const Nu limits = kFreeRunDivergence.LimitsFor(FastestOf(*dataset_));
  Outcome outcome{NoErrors(), {}};
  ForEachTrack(
      model, Offset::Zero(),
      [&](std::size_t w, const AugmentedBoat& boat, double from_s, const std::vector<Pose>& track) {
        AddRawErrors(windows_[w], boat, from_s, track,
                     outcome.errors.col(static_cast<Eigen::Index>(w)));
        outcome.divergence.Add(DivergenceAlong(track, limits));
      });
  EstimateStarts(outcome.errors);
  return outcome;
}

Divergence FreeRuns::DivergenceOf(const AugmentedModel& model) const {
  const Nu limits = kFreeRunDivergence.LimitsFor(FastestOf(*dataset_));
  Divergence divergence;
  ForEachTrack(model, Offset::Zero(),
               [&](std::size_t, const AugmentedBoat&, double, const std::vector<Pose>& track) {
                 divergence.Add(DivergenceAlong(track, limits));
               });
  return divergence;
}

FreeRuns::Circumstances FreeRuns::Of(std::size_t window) const {
  const Window& it = windows_[window];
  return {dataset_->rows[it.first_row].time_s, it.first_row, rows_};
}

std::vector<std::vector<Eigen::Vector2d>> FreeRuns::Tracks(const AugmentedModel& model) const {
  std::vector<std::vector<Eigen::Vector2d>> tracks(windows_.size());
  ForEachTrack(model, Offset::Zero(),
               [&](std::size_t w, const AugmentedBoat&, double, const std::vector<Pose>& track) {
                 for (std::size_t k = 0; k < track.size(); k += steps_) {
                   tracks[w].emplace_back(track[k].eta.x_m, track[k].eta.y_m);
                 }
               });
  return tracks;
}

}  // namespace telltale
