#include "telltale/core/simulation/synthetic_track.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <boost/random/uniform_real_distribution.hpp>

#include "telltale/core/simulation/divergence.hpp"

namespace telltale {
namespace {

constexpr double kLongestStepS = 0.1;
// The sensors draw from the streams before it.
constexpr std::uint64_t kFirstDisturbanceStream = 10;
constexpr std::uint64_t kCommandTimesStream = 15;
constexpr std::array kVelocities = {&Nu::u, &Nu::v, &Nu::r};

/// The cubic through two values and their slopes, at `share` of the step.
double Hermite(double a, double a_slope, double b, double b_slope, double step_s, double share) {
  const double s = share;
  const double left = 1.0 - s;
  return left * left * ((1.0 + 2.0 * s) * a + s * step_s * a_slope) +
         s * s * ((3.0 - 2.0 * s) * b - left * step_s * b_slope);
}

/// The velocity midway along a step, by the cubic through the velocities at its ends and their
/// slopes.
Nu Midway(const Nu& before, const NuDot& leaving, const Nu& after, const NuDot& arriving,
          double step_s) {
  const double bend_s = step_s / 8.0;
  return {(before.u + after.u) / 2.0 + bend_s * (leaving.u - arriving.u),
          (before.v + after.v) / 2.0 + bend_s * (leaving.v - arriving.v),
          (before.r + after.r) / 2.0 + bend_s * (leaving.r - arriving.r)};
}

/// The instant a step later, its pose by Simpson's rule. The mean of both ends would turn a boat
/// that settles within half a second 0.3 % too little or too far in steps of a tenth: more than the
/// standard errors of a calm day, so that synthetic datasets would show a bias.
TrackInstant Later(const TrackInstant& now, const Nu& midway, const Nu& after, double step_s) {
  const double turning = step_s / 24.0 * (5.0 * now.nu.r + 8.0 * midway.r - after.r);
  const double turned = step_s / 6.0 * (now.nu.r + 4.0 * midway.r + after.r);
  const double psi_rad = now.eta.psi_rad + turned;
  const Eigen::Vector3d step =
      step_s / 6.0 *
      (now.eta_dot + 4.0 * EtaDot(now.eta.psi_rad + turning, midway) + EtaDot(psi_rad, after));
  return {{now.eta.x_m + step.x(), now.eta.y_m + step.y(), psi_rad}, after};
}

}  // namespace

SyntheticTrack::SyntheticTrack(double start_s, double step_s, std::size_t steps)
    : start_s_(start_s), step_s_(step_s) {
  knots_.reserve(steps + 1);
}

Eta SyntheticTrack::At(double time_s) const {
  const auto [a, b, share] = About(time_s);
  return {Hermite(a.eta.x_m, a.slope.x(), b.eta.x_m, b.slope.x(), step_s_, share),
          Hermite(a.eta.y_m, a.slope.y(), b.eta.y_m, b.slope.y(), step_s_, share),
          Hermite(a.eta.psi_rad, a.slope.z(), b.eta.psi_rad, b.slope.z(), step_s_, share)};
}

double SyntheticTrack::HeadingAt(double time_s) const {
  const auto [a, b, share] = About(time_s);
  return Hermite(a.eta.psi_rad, a.slope.z(), b.eta.psi_rad, b.slope.z(), step_s_, share);
}

SyntheticTrack::Piece SyntheticTrack::About(double time_s) const {
  const double steps = std::max(0.0, (time_s - start_s_) / step_s_);
  const std::size_t last = knots_.size() - 2;
  const std::size_t before = std::min(static_cast<std::size_t>(steps), last);
  return {knots_[before], knots_[before + 1], steps - static_cast<double>(before)};
}

double SimulatedSegment::Duration() const {
  return static_cast<double>(dataset.segments[segment].size() - 1) * dataset.sampling_period_s;
}

Nu SimulatedSegment::MeasuredAt(double since_start_s) const {
  const RowRange& rows = dataset.segments[segment];
  const double at = since_start_s / dataset.sampling_period_s;
  const std::size_t before = std::min(static_cast<std::size_t>(at), rows.size() - 2);
  const double share = at - static_cast<double>(before);
  const Nu& a = dataset.rows[rows.begin + before].nu;
  const Nu& b = dataset.rows[rows.begin + before + 1].nu;
  return {a.u + share * (b.u - a.u), a.v + share * (b.v - a.v), a.r + share * (b.r - a.r)};
}

SegmentSimulator::SegmentSimulator(const PreparedDataset& dataset, const VesselModel& model,
                                   const SyntheticDatasetOptions& options)
    : model_(model),
      dynamics_(model),
      limits_(kSyntheticDatasetDivergence.LimitsFor(FastestOf(dataset))),
      step_s_(dataset.sampling_period_s /
              std::ceil(dataset.sampling_period_s / kLongestStepS - 1e-9)),
      as_measured_(options.as_measured),
      disturbance_(
          DrawDisturbances(options.disturbance, step_s_, options.seed, kFirstDisturbanceStream)),
      command_spread_s_(dataset.sensors.command_spread_s),
      command_times_(RandomEngine::Stream(options.seed, kCommandTimesStream)) {}

Result<SyntheticTrack> SegmentSimulator::Simulate(const SimulatedSegment& segment,
                                                  const ConstantDisturbance& constant_disturbance) {
  const auto steps = static_cast<std::size_t>(std::lround(segment.Duration() / step_s_));
  SyntheticTrack track(segment.start_s, step_s_, steps);
  TrackInstant now{segment.First().eta, segment.First().nu};
  const HeldCommands commands = AsTheyAct(segment.Commands());
  ThrustRegressors thrust = ThrustAtStart(commands, segment.First().time_s);
  track.Add(now);
  for (std::size_t k = 0; k < steps; ++k) {
    const double from_s = segment.First().time_s + static_cast<double>(k) * step_s_;
    NuDot applied = PropelledOver(commands, from_s, thrust);
    const NuDot constant = constant_disturbance.At(now.eta.psi_rad);
    applied = {applied.u + constant.u + disturbance_[0].Next(),
               applied.v + constant.v + disturbance_[1].Next(),
               applied.r + constant.r + disturbance_[2].Next()};
    now = Advance(now, applied, segment.MeasuredAt(static_cast<double>(k + 1) * step_s_));
    if (!Within(now.nu, limits_)) {
      return Refuse("synthetic dataset", "the model diverges under the recorded commands",
                    "record more of the manoeuvres in which it does");
    }
    track.Add(now);
  }
  return track;
}

/// The commands as they act when they were sampled out of something that changes in between.
HeldCommands SegmentSimulator::AsTheyAct(HeldCommands recorded) {
  if (command_spread_s_ <= 0.0) return recorded;
  boost::random::uniform_real_distribution<double> share(-0.5, 0.5);
  recorded.ForEachTime([&](double before_s, double time_s) {
    return time_s + std::min(command_spread_s_, time_s - before_s) * share(command_times_);
  });
  return recorded;
}

/// The thrust as the segment begins, after the commands that precede it.
ThrustRegressors SegmentSimulator::ThrustAtStart(const HeldCommands& commands,
                                                 double start_s) const {
  ThrustRegressors thrust = model_.SteadyThrust(commands.Commands().front());
  if (commands.Times().front() >= start_s) return thrust;
  commands.ForEachPiece(commands.Times().front(), start_s,
                        [&](const PropellerCommand& delta, double from, double to) {
                          if (to > from) thrust = model_.ThrustAfter(thrust, delta, to - from);
                        });
  return thrust;
}

/// The propellers' mean acceleration over a step; advances `thrust` to the step's end.
NuDot SegmentSimulator::PropelledOver(const HeldCommands& commands, double from_s,
                                      ThrustRegressors& thrust) const {
  NuDot propelled;
  commands.ForEachPiece(
      from_s, from_s + step_s_, [&](const PropellerCommand& delta, double from, double to) {
        if (to <= from) return;
        const double share = (to - from) / step_s_;
        const NuDot part = dynamics_.Propelled(model_.MeanThrust(thrust, delta, to - from));
        thrust = model_.ThrustAfter(thrust, delta, to - from);
        propelled = {propelled.u + share * part.u, propelled.v + share * part.v,
                     propelled.r + share * part.r};
      });
  return propelled;
}

/// The instant a step later; velocities without an equation take the measured value.
TrackInstant SegmentSimulator::Advance(const TrackInstant& now, const NuDot& applied,
                                       const Nu& measured) const {
  Nu next = dynamics_.Step(applied, now.nu, step_s_);
  Nu midway = Midway(now.nu, dynamics_.Under(applied, now.nu), next, dynamics_.Under(applied, next),
                     step_s_);
  for (std::size_t j = 0; j < as_measured_.size(); ++j) {
    if (!as_measured_[j]) continue;
    const auto velocity = kVelocities[j];
    next.*velocity = measured.*velocity;
    midway.*velocity = (now.nu.*velocity + measured.*velocity) / 2.0;
  }
  return Later(now, midway, next, step_s_);
}

}  // namespace telltale
