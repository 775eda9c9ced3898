#include "telltale/core/simulation/synthetic_dataset.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "telltale/core/base/gauss_markov.hpp"
#include "telltale/core/data/north_east_frame.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/simulation/divergence.hpp"
#include "telltale/core/vessel/body_dynamics.hpp"

namespace telltale {
namespace {

constexpr double kLongestStepS = 0.1;
// The sensors draw from the streams before it.
constexpr std::uint64_t kFirstDisturbanceStream = 10;
constexpr std::uint64_t kFirstDriftStream = 20;
// No fix wanders off for ever. Far longer than the windows that could tell.
constexpr double kDriftTimeConstantS = 30.0;
// Preparation averages headings over a row. So many of them are averaged as a faster sensor's are,
// to a twentieth of what averaging does; with two it would do half as much again.
constexpr double kHeadingsPerRow = 5.0;
// Between segments: longer than any gap that preparation bridges, and than commands reach back.
constexpr double kBetweenSegmentsS = 100.0;
constexpr std::array kVelocities = {&Nu::u, &Nu::v, &Nu::r};
constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

struct Instant {
  Instant(const Eta& at, const Nu& by) : eta(at), nu(by), eta_dot(EtaDot(at.psi_rad, by)) {}

  Eta eta;
  Nu nu;
  Eigen::Vector3d eta_dot;
};

/// Cubic through two instants and their slopes.
double Hermite(double a, double a_slope, double b, double b_slope, double step_s, double share) {
  const double s = share;
  const double left = 1.0 - s;
  return left * left * ((1.0 + 2.0 * s) * a + s * step_s * a_slope) +
         s * s * ((3.0 - 2.0 * s) * b - left * step_s * b_slope);
}

/// The course of one segment at equal steps.
class Course {
 public:
  Course(double start_s, double step_s, std::size_t steps) : start_s_(start_s), step_s_(step_s) {
    knots_.reserve(steps + 1);
  }

  void Add(const Instant& instant) { knots_.push_back({instant.eta, instant.eta_dot}); }

  Eta At(double time_s) const {
    const auto [a, b, share] = About(time_s);
    return {Hermite(a.eta.x_m, a.slope.x(), b.eta.x_m, b.slope.x(), step_s_, share),
            Hermite(a.eta.y_m, a.slope.y(), b.eta.y_m, b.slope.y(), step_s_, share),
            Hermite(a.eta.psi_rad, a.slope.z(), b.eta.psi_rad, b.slope.z(), step_s_, share)};
  }

  double HeadingAt(double time_s) const {
    const auto [a, b, share] = About(time_s);
    return Hermite(a.eta.psi_rad, a.slope.z(), b.eta.psi_rad, b.slope.z(), step_s_, share);
  }

 private:
  struct Knot {
    Eta eta;
    Eigen::Vector3d slope;
  };
  struct Piece {
    const Knot& before;
    const Knot& after;
    double share;
  };

  Piece About(double time_s) const {
    const double steps = std::max(0.0, (time_s - start_s_) / step_s_);
    const std::size_t last = knots_.size() - 2;
    const std::size_t before = std::min(static_cast<std::size_t>(steps), last);
    return {knots_[before], knots_[before + 1], steps - static_cast<double>(before)};
  }

  double start_s_;
  double step_s_;
  std::vector<Knot> knots_;
};

/// What segment s of the dataset started with, and when it is sailed on the twin's clock.
struct SimulatedSegment {
  const PreparedDataset& dataset;
  std::size_t segment;
  double start_s;
  double shift_s;  ///< from the dataset's clock to the twin's

  const PreparedRow& First() const { return dataset.rows[dataset.segments[segment].begin]; }
  Nu MeasuredAt(double since_start_s) const {
    const RowRange& rows = dataset.segments[segment];
    const double at = since_start_s / dataset.sampling_period_s;
    const std::size_t before = std::min(static_cast<std::size_t>(at), rows.size() - 2);
    const double share = at - static_cast<double>(before);
    const Nu& a = dataset.rows[rows.begin + before].nu;
    const Nu& b = dataset.rows[rows.begin + before + 1].nu;
    return {a.u + share * (b.u - a.u), a.v + share * (b.v - a.v), a.r + share * (b.r - a.r)};
  }
  double Duration() const {
    return static_cast<double>(dataset.segments[segment].size() - 1) * dataset.sampling_period_s;
  }
  const HeldCommands& Commands() const { return dataset.commands[segment]; }
};

/// Thrusters as they stand when the voyage begins, after the commands it remembers.
ThrustRegressors ThrustAtStart(const SimulatedSegment& simulated_segment,
                               const VesselModel& model) {
  const HeldCommands& commands = simulated_segment.Commands();
  ThrustRegressors thrust = model.SteadyThrust(commands.Commands().front());
  const double start_s = simulated_segment.First().time_s;
  if (commands.Times().front() >= start_s) return thrust;
  commands.ForEachPiece(commands.Times().front(), start_s,
                        [&](const PropellerCommand& delta, double from, double to) {
                          if (to > from) thrust = model.ThrustAfter(thrust, delta, to - from);
                        });
  return thrust;
}

/// Midway along a step, by the cubic through the velocities at its ends and their slopes.
Nu Midway(const Nu& before, const NuDot& leaving, const Nu& after, const NuDot& arriving,
          double step_s) {
  const double bend_s = step_s / 8.0;
  return {(before.u + after.u) / 2.0 + bend_s * (leaving.u - arriving.u),
          (before.v + after.v) / 2.0 + bend_s * (leaving.v - arriving.v),
          (before.r + after.r) / 2.0 + bend_s * (leaving.r - arriving.r)};
}

/// A step later, the pose by Simpson's rule. By the mean of both ends a boat that settles within
/// half a second would turn 0.3 % too little or too far in steps of a tenth: more than the standard
/// errors of a calm day, and twins would show a bias that the boat does not have.
Instant Later(const Instant& now, const Nu& midway, const Nu& after, double step_s) {
  const double turning = step_s / 24.0 * (5.0 * now.nu.r + 8.0 * midway.r - after.r);
  const double turned = step_s / 6.0 * (now.nu.r + 4.0 * midway.r + after.r);
  const double psi_rad = now.eta.psi_rad + turned;
  const Eigen::Vector3d step =
      step_s / 6.0 *
      (now.eta_dot + 4.0 * EtaDot(now.eta.psi_rad + turning, midway) + EtaDot(psi_rad, after));
  return {{now.eta.x_m + step.x(), now.eta.y_m + step.y(), psi_rad}, after};
}

Result<Course> SimulateSegment(const SimulatedSegment& simulated_segment, const VesselModel& model,
                               const BodyDynamics& dynamics, const Nu& limits, double step_s,
                               const std::array<bool, 3>& as_measured,
                               const ConstantDisturbance& constant_disturbances,
                               std::array<GaussMarkov, 3>& disturbance) {
  const auto steps = static_cast<std::size_t>(std::lround(simulated_segment.Duration() / step_s));
  Course course(simulated_segment.start_s, step_s, steps);
  Instant now{simulated_segment.First().eta, simulated_segment.First().nu};
  ThrustRegressors thrust = ThrustAtStart(simulated_segment, model);
  course.Add(now);
  for (std::size_t k = 0; k < steps; ++k) {
    const double from_s = simulated_segment.First().time_s + static_cast<double>(k) * step_s;
    NuDot applied;
    simulated_segment.Commands().ForEachPiece(
        from_s, from_s + step_s, [&](const PropellerCommand& delta, double from, double to) {
          if (to <= from) return;
          const double share = (to - from) / step_s;
          const NuDot part = dynamics.Propelled(model.MeanThrust(thrust, delta, to - from));
          thrust = model.ThrustAfter(thrust, delta, to - from);
          applied = {applied.u + share * part.u, applied.v + share * part.v,
                     applied.r + share * part.r};
        });
    const NuDot constant = constant_disturbances.At(now.eta.psi_rad);
    applied = {applied.u + constant.u + disturbance[0].Next(),
               applied.v + constant.v + disturbance[1].Next(),
               applied.r + constant.r + disturbance[2].Next()};
    const Nu measured = simulated_segment.MeasuredAt(static_cast<double>(k + 1) * step_s);
    Nu next = dynamics.Step(applied, now.nu, step_s);
    Nu midway = Midway(now.nu, dynamics.Under(applied, now.nu), next, dynamics.Under(applied, next),
                       step_s);
    for (std::size_t j = 0; j < as_measured.size(); ++j) {
      if (!as_measured[j]) continue;
      const auto velocity = kVelocities[j];
      next.*velocity = measured.*velocity;
      midway.*velocity = (now.nu.*velocity + measured.*velocity) / 2.0;
    }
    now = Later(now, midway, next, step_s);
    if (!Within(next, limits)) {
      return Refuse("simulated repeat", "the model runs away under the recorded commands",
                    "record more of the manoeuvres in which it does");
    }
    course.Add(now);
  }
  return course;
}

/// Share of the variance of white noise that is left of the mean of a signal joined up linearly
/// over `samples` sampling intervals: whole weights within, halves at both ends.
double VarianceAfterAveraging(double samples) {
  return samples < 2.0 ? 1.0 : (samples - 0.5) / (samples * samples);
}

/// What fixes that wander off by so much within a second are off by, one axis.
GaussMarkov DriftProcess(double within_a_second_m, double step_s, WhiteSource source) {
  const double sigma_m = within_a_second_m * std::sqrt(0.5 * kDriftTimeConstantS);
  return {sigma_m, kDriftTimeConstantS, step_s, source};
}

/// Fixes, headings and commands as sensors would give them along the way.
class SyntheticSensors {
 public:
  SyntheticSensors(const PreparedDataset& dataset, const SyntheticDatasetOptions& options)
      : sensors_(dataset.sensors),
        frame_(dataset.origin),
        north_(options.seed, 0),
        east_(options.seed, 1),
        heading_(options.seed, 2),
        drift_north_(DriftProcess(options.disturbance.gnss_drift_m, sensors_.gnss_period_s,
                                  WhiteSource(options.seed, kFirstDriftStream))),
        drift_east_(DriftProcess(options.disturbance.gnss_drift_m, sensors_.gnss_period_s,
                                 WhiteSource(options.seed, kFirstDriftStream + 1))) {
    const double shortest_s = dataset.sampling_period_s / kHeadingsPerRow;
    heading_period_s_ = std::max(sensors_.heading_period_s, shortest_s);
    position_noise_m_ = options.noise_scale * sensors_.position_noise_m;
    heading_noise_rad_ =
        options.noise_scale * sensors_.heading_noise_rad *
        std::sqrt(VarianceAfterAveraging(dataset.sampling_period_s / sensors_.heading_period_s) /
                  VarianceAfterAveraging(dataset.sampling_period_s / heading_period_s_));
  }

  void Record(const SimulatedSegment& simulated_segment, const Course& course,
              Recording& recording) {
    const double end_s = simulated_segment.start_s + simulated_segment.Duration() + 1e-6;
    for (std::size_t i = 0;; ++i) {
      const double t = simulated_segment.start_s + static_cast<double>(i) * sensors_.gnss_period_s;
      if (t > end_s) break;
      recording.gnss.push_back(Fix(t, course.At(t)));
    }
    for (std::size_t i = 0;; ++i) {
      const double t = simulated_segment.start_s + static_cast<double>(i) * heading_period_s_;
      if (t > end_s) break;
      const double psi = course.HeadingAt(t) + heading_noise_rad_ * heading_();
      recording.heading.push_back({t, WrapAngle(psi) * kDegreesPerRadian});
    }
    const HeldCommands& commands = simulated_segment.Commands();
    const PwmChannel pwm;
    for (std::size_t i = 0; i < commands.Times().size(); ++i) {
      const double t = commands.Times()[i] + simulated_segment.shift_s;
      if (t > end_s + 1.0) break;
      const PropellerCommand& delta = commands.Commands()[i];
      recording.thrusters.push_back(
          {t, pwm.PulseWidth(delta.port), pwm.PulseWidth(delta.starboard)});
    }
  }

 private:
  GnssFix Fix(double t, const Eta& eta) {
    const double c = std::cos(eta.psi_rad);
    const double s = std::sin(eta.psi_rad);
    const LeverArm& arm = sensors_.antenna;
    const double north = eta.x_m + c * arm.forward_m - s * arm.starboard_m +
                         position_noise_m_ * north_() + drift_north_.Next();
    const double east = eta.y_m + s * arm.forward_m + c * arm.starboard_m +
                        position_noise_m_ * east_() + drift_east_.Next();
    const GeographicPosition place = frame_.Inverse({north, east});
    return {t, place.latitude_deg, place.longitude_deg};
  }

  SensorProperties sensors_;
  NorthEastFrame frame_;
  WhiteSource north_;
  WhiteSource east_;
  WhiteSource heading_;
  GaussMarkov drift_north_;
  GaussMarkov drift_east_;
  double heading_period_s_ = 0.0;
  double position_noise_m_ = 0.0;
  double heading_noise_rad_ = 0.0;
};

Vehicle VehicleOf(const PreparedDataset& dataset) {
  Vehicle vehicle;
  vehicle.gnss_antenna = dataset.sensors.antenna;
  return vehicle;
}

}  // namespace

Result<SyntheticRecording> SimulateRecording(const PreparedDataset& dataset,
                                             const VesselModel& model,
                                             const SyntheticDatasetOptions& options) {
  const double h = dataset.sampling_period_s;
  const double step_s = h / std::ceil(h / kLongestStepS - 1e-9);
  const BodyDynamics dynamics(model);
  const Nu limits = kSyntheticDatasetDivergence.LimitsFor(FastestOf(dataset));
  auto disturbance =
      DrawDisturbances(options.disturbance, step_s, options.seed, kFirstDisturbanceStream);
  SyntheticSensors synthetic_sensors(dataset, options);
  SyntheticRecording synthetic{{}, VehicleOf(dataset)};
  double start_s = 0.0;
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    SimulatedSegment simulated_segment{dataset, s, start_s, 0.0};
    simulated_segment.shift_s = start_s - simulated_segment.First().time_s;
    const std::size_t of = dataset.RecordingOf(s);
    if (s == 0 || of != dataset.RecordingOf(s - 1)) synthetic.recording.starts_s.push_back(start_s);
    const auto course =
        SimulateSegment(simulated_segment, model, dynamics, limits, step_s, options.as_measured,
                        options.constant_disturbances.empty() ? ConstantDisturbance()
                                                              : options.constant_disturbances[of],
                        disturbance);
    if (!course) return tl::unexpected(course.error());
    synthetic_sensors.Record(simulated_segment, *course, synthetic.recording);
    start_s += simulated_segment.Duration() + kBetweenSegmentsS;
  }
  return synthetic;
}

Result<PreparedDataset> SimulateDataset(const PreparedDataset& dataset, const VesselModel& model,
                                        const SyntheticDatasetOptions& options) {
  const auto synthetic = SimulateRecording(dataset, model, options);
  if (!synthetic) return tl::unexpected(synthetic.error());
  PrepareOptions prepare = dataset.options;
  prepare.sampling_period_s = dataset.sampling_period_s;
  prepare.longest_segment_s.reset();
  return Prepare(synthetic->recording, synthetic->vehicle, prepare);
}

}  // namespace telltale
