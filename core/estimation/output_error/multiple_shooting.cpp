#include "telltale/core/estimation/output_error/multiple_shooting.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/data/time_series.hpp"
#include "telltale/core/simulation/divergence.hpp"
#include "telltale/core/vessel/body_dynamics.hpp"
#include "telltale/core/vessel/runge_kutta.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {
namespace {

constexpr double kLongestStepS = 0.2;
constexpr std::size_t kFewestFixes = 4;
constexpr std::size_t kFewestHeadings = 3;

bool SameCommand(const PropellerCommand& a, const PropellerCommand& b) {
  return a.port == b.port && a.starboard == b.starboard;
}

/// Runs of rows of a segment that all enter every equation sought.
std::vector<RowRange> EnteringRuns(const PreparedDataset& dataset, const RowRange& segment,
                                   const RegressionOptions& regression,
                                   const SharedUnknowns& unknowns) {
  const auto enters = [&](const PreparedRow& row) {
    return std::all_of(kEquations.begin(), kEquations.end(), [&](Equation equation) {
      return unknowns.columns[IndexOf(equation)].empty() ||
             Enters(row.region, equation, regression);
    });
  };
  std::vector<RowRange> runs;
  bool open = false;
  for (std::size_t k = segment.begin; k < segment.end; ++k) {
    const bool entering = enters(dataset.rows[k]);
    if (entering && !open) runs.push_back({k, k});
    if (entering) runs.back().end = k + 1;
    open = entering;
  }
  return runs;
}

/// Equal parts of a run: each from its first row to the first of the next, or to the run's last.
std::vector<RowRange> CutRun(const RowRange& run, double rows_per_shooting_segment) {
  constexpr double kShortestShare = 0.5;
  const double intervals = static_cast<double>(run.size()) - 1.0;
  if (intervals < kShortestShare * rows_per_shooting_segment) return {};
  const auto parts =
      static_cast<std::size_t>(std::max(1.0, std::round(intervals / rows_per_shooting_segment)));
  std::vector<RowRange> cut;
  for (std::size_t i = 0; i < parts; ++i) {
    cut.push_back(
        {run.begin + (run.size() - 1) * i / parts, run.begin + (run.size() - 1) * (i + 1) / parts});
  }
  return cut;
}

/// Builds the shots of one segment.
class SegmentCutter {
 public:
  SegmentCutter(const PreparedDataset& dataset, std::size_t segment, const SharedUnknowns& unknowns,
                const ShootingOptions& options)
      : dataset_(dataset),
        commands_(dataset.commands[segment]),
        signals_(dataset.signals[segment]),
        unknowns_(unknowns),
        options_(options) {}

  /// The shot between two rows; measurements at `end_s` belong to it only if `closed`.
  ShootingSegment Between(const RowRange& rows, bool closed) const {
    const PreparedRow& first = dataset_.rows[rows.begin];
    const double end_s = dataset_.rows[rows.end].time_s;
    ShootingSegment shooting_segment;
    shooting_segment.guess << 0.0, 0.0, first.eta.psi_rad, first.nu.u, first.nu.v, first.nu.r;
    shooting_segment.before = Remembered(first.time_s);
    const std::vector<double> times = NodeTimes(first.time_s, end_s);
    for (std::size_t k = 0; k < times.size(); ++k) {
      const bool last = k + 1 == times.size();
      ShootingNode node;
      if (!last || closed) node.fix = FixAt(times[k], first.eta);
      if (!last) {
        node.leg_s = times[k + 1] - times[k];
        node.steady = Steady(commands_.At(times[k]));
        const bool closing = closed && k + 2 == times.size();
        node.heading = MeanOver(times[k], times[k + 1], closing);
      }
      shooting_segment.fixes += node.fix ? 1 : 0;
      shooting_segment.headings += node.heading ? 1 : 0;
      shooting_segment.nodes.push_back(node);
    }
    return shooting_segment;
  }

 private:
  ThrustRegressors Steady(const PropellerCommand& delta) const {
    return ThrustOf(unknowns_.parameterization, unknowns_.dead_zone.Apply(delta));
  }

  std::vector<ShootingSegment::Held> Remembered(double until_s) const {
    std::vector<ShootingSegment::Held> before;
    const double from_s = std::max(until_s - kThrusterMemoryS, commands_.Times().front());
    // At least one, for thrusters to have settled on.
    if (!unknowns_.lagging || from_s >= until_s) return {{Steady(commands_.At(until_s)), 0.0}};
    std::optional<PropellerCommand> held;
    commands_.ForEachPiece(from_s, until_s,
                           [&](const PropellerCommand& delta, double start, double end) {
                             if (held && SameCommand(*held, delta)) {
                               before.back().duration_s += end - start;
                             } else {
                               before.push_back({Steady(delta), end - start});
                             }
                             held = delta;
                           });
    return before;
  }

  std::vector<double> NodeTimes(double begin_s, double end_s) const {
    std::vector<double> stops = {begin_s, end_s};
    const auto within = [&](double t) {
      return t > begin_s + kSameInstantS && t < end_s - kSameInstantS;
    };
    for (const double t : signals_.north_m.times_s) {
      if (within(t)) stops.push_back(t);
    }
    for (std::size_t i = 1; i < commands_.Times().size(); ++i) {
      const bool changes = !SameCommand(commands_.Commands()[i - 1], commands_.Commands()[i]);
      if (changes && within(commands_.Times()[i])) stops.push_back(commands_.Times()[i]);
    }
    std::sort(stops.begin(), stops.end());
    std::vector<double> times = {begin_s};
    for (const double stop : stops) {
      const double from = times.back();
      if (stop - from <= kSameInstantS) continue;
      const double steps = std::ceil((stop - from) / kLongestStepS - kSameInstantS);
      for (double i = 1.0; i < steps; ++i) times.push_back(from + i * (stop - from) / steps);
      times.push_back(stop);
    }
    return times;
  }

  std::optional<NorthEastPosition> FixAt(double t, const Eta& from) const {
    const auto& times = signals_.north_m.times_s;
    const auto at = std::lower_bound(times.begin(), times.end(), t - kSameInstantS);
    if (at == times.end() || *at > t + kSameInstantS) return std::nullopt;
    const auto i = static_cast<std::size_t>(at - times.begin());
    return NorthEastPosition{signals_.north_m.values[i] - from.x_m,
                             signals_.east_m.values[i] - from.y_m};
  }

  std::optional<MeanHeading> MeanOver(double from_s, double to_s, bool closing) const {
    const auto& times = signals_.psi_rad.times_s;
    const double until_s = closing ? to_s + kSameInstantS : to_s - kSameInstantS;
    const auto begin = std::lower_bound(times.begin(), times.end(), from_s - kSameInstantS);
    const auto end = std::lower_bound(begin, times.end(), until_s);
    if (begin == end) return std::nullopt;
    MeanHeading mean;
    const double leg_s = to_s - from_s;
    const double share = 1.0 / static_cast<double>(end - begin);
    for (auto at = begin; at != end; ++at) {
      const double s = (*at - from_s) / leg_s;
      const double left = 1.0 - s;
      mean.psi_before += share * left * left * (1.0 + 2.0 * s);
      mean.r_before += share * leg_s * s * left * left;
      mean.psi_after += share * s * s * (3.0 - 2.0 * s);
      mean.r_after -= share * leg_s * s * s * left;
      mean.psi_rad += share * signals_.psi_rad.values[static_cast<std::size_t>(at - times.begin())];
    }
    mean.noise_rad = std::max(options_.least_heading_noise_rad,
                              std::sqrt(share) * dataset_.sensors.heading_noise_rad);
    return mean;
  }

  const PreparedDataset& dataset_;
  const HeldCommands& commands_;
  const RawSignals& signals_;
  const SharedUnknowns& unknowns_;
  const ShootingOptions& options_;
};

/// Propeller regressors in a row: four of surge, four of turning.
using Terms = Eigen::Array<double, 8, 1>;

Terms Flat(const ThrustRegressors& thrust) {
  Terms terms;
  terms << Eigen::Map<const Eigen::Array4d>(thrust.surge.data()),
      Eigen::Map<const Eigen::Array4d>(thrust.turning.data());
  return terms;
}

ThrustRegressors Folded(const Terms& terms) {
  ThrustRegressors thrust;
  std::copy_n(terms.data(), 4, thrust.surge.begin());
  std::copy_n(terms.data() + 4, 4, thrust.turning.begin());
  return thrust;
}

/// Thrust and how it moves with the time constant.
struct Thrust {
  Terms now;
  Terms by_lag;
};

/// Thrust at the start, the middle and the end of a step; the middle is such that Simpson's rule
/// gives the step's exact mean, however short the lag.
struct ThrustOverStep {
  Thrust start, middle, end;
};

class FollowingThrusters {
 public:
  FollowingThrusters(const ShootingSegment& shooting_segment, std::optional<double> time_constant_s)
      : time_constant_s_(time_constant_s) {
    now_ = {Flat(shooting_segment.before.front().steady), Terms::Zero()};
    for (const ShootingSegment::Held& held : shooting_segment.before) {
      if (held.duration_s > 0.0) Advance(held.steady, held.duration_s);
    }
  }

  ThrustOverStep Advance(const ThrustRegressors& steady_thrust, double duration_s) {
    const Terms steady = Flat(steady_thrust);
    if (!time_constant_s_) {
      now_ = {steady, Terms::Zero()};
      return {now_, now_, now_};
    }
    const LagPerPeriod lag = LagOver(*time_constant_s_ / duration_s);
    const Thrust start = now_;
    const Terms behind = start.now - steady;
    now_.now = Approach(start.now, steady, lag.remaining);
    now_.by_lag = lag.remaining * start.by_lag + lag.remaining_slope / duration_s * behind;
    const Terms mean = Approach(start.now, steady, lag.mean);
    const Terms mean_by_lag = lag.mean * start.by_lag + lag.mean_slope / duration_s * behind;
    const Thrust middle{(6.0 * mean - start.now - now_.now) / 4.0,
                        (6.0 * mean_by_lag - start.by_lag - now_.by_lag) / 4.0};
    return {start, middle, now_};
  }

 private:
  std::optional<double> time_constant_s_;
  Thrust now_;
};

// The three initial velocities, the time constant and at most 35 coefficients, made even.
constexpr Eigen::Index kColumns = 40;
constexpr Eigen::Index kFirstShared = 3;
constexpr Eigen::Index kPsi = 2;

/// Of x, y, psi, u, v, r by the initial velocities and then the shared unknowns.
using Sensitivity = Eigen::Matrix<double, 6, kColumns, Eigen::RowMajor>;
using SensitivityRow = Eigen::Matrix<double, 1, kColumns>;

struct Motion {
  ShootingState state;
  Sensitivity sensitivity;

  Nu Velocity() const { return {state[3], state[4], state[5]}; }
};

/// The equations of motion and their variational equations.
class VariedDynamics {
 public:
  VariedDynamics(const SharedUnknowns& unknowns, const Eigen::VectorXd& theta, bool varied)
      : dynamics_(unknowns.ModelWith(theta, 0.0)), unknowns_(unknowns), varied_(varied) {
    for (const Equation equation : kEquations) {
      first_[IndexOf(equation)] = kFirstShared + unknowns.First(equation);
    }
  }

  Motion Step(const Motion& from, const ThrustOverStep& thrust, double h) const {
    return RungeKuttaStep(
        from, h,
        [&](const Motion& at, StepStage stage) {
          return Slope(at, stage == StepStage::kStart    ? thrust.start
                           : stage == StepStage::kMiddle ? thrust.middle
                                                         : thrust.end);
        },
        [&](const Motion& at, const Motion& slope, double step_s) {
          return Along(at, slope, step_s);
        },
        [&](const Motion& k1, const Motion& k2, const Motion& k3, const Motion& k4) {
          Motion to;
          to.state = from.state + h / 6 * (k1.state + 2 * k2.state + 2 * k3.state + k4.state);
          if (varied_) {
            to.sensitivity =
                from.sensitivity +
                h / 6 * (k1.sensitivity + 2 * k2.sensitivity + 2 * k3.sensitivity + k4.sensitivity);
          }
          return to;
        });
  }

 private:
  Motion Along(const Motion& from, const Motion& slope, double h) const {
    Motion to;
    to.state = from.state + h * slope.state;
    if (varied_) to.sensitivity = from.sensitivity + h * slope.sensitivity;
    return to;
  }

  Motion Slope(const Motion& at, const Thrust& thrust) const {
    const Nu nu = at.Velocity();
    const ThrustRegressors applied = Folded(thrust.now);
    const NuDot nu_dot = dynamics_.Under(dynamics_.Propelled(applied), nu);
    const double c = std::cos(at.state[kPsi]);
    const double s = std::sin(at.state[kPsi]);
    Motion slope;
    slope.state << c * nu.u - s * nu.v, s * nu.u + c * nu.v, nu.r, nu_dot.u, nu_dot.v, nu_dot.r;
    if (!varied_) return slope;
    const Sensitivity& S = at.sensitivity;
    slope.sensitivity.row(0) = c * S.row(3) - s * S.row(4) - slope.state[1] * S.row(kPsi);
    slope.sensitivity.row(1) = s * S.row(3) + c * S.row(4) + slope.state[0] * S.row(kPsi);
    slope.sensitivity.row(2) = S.row(5);
    const Eigen::Matrix3d A = dynamics_.ByVelocity(nu);
    for (Eigen::Index j = 0; j < 3; ++j) {
      slope.sensitivity.row(3 + j) = A(j, 0) * S.row(3) + A(j, 1) * S.row(4) + A(j, 2) * S.row(5);
    }
    AddShared(nu, applied, Folded(thrust.by_lag), slope.sensitivity);
    return slope;
  }

  void AddShared(const Nu& nu, const ThrustRegressors& applied, const ThrustRegressors& by_lag,
                 Sensitivity& sensitivity) const {
    std::array<double, 16> row{};
    for (const Equation equation : kEquations) {
      const std::size_t j = IndexOf(equation);
      const auto& columns = unknowns_.columns[j];
      if (columns.empty()) continue;
      FillRow(equation, nu, applied,
              std::span(row).first(Regressors(equation, unknowns_.parameterization).size()));
      double* to = &sensitivity(3 + static_cast<Eigen::Index>(j), first_[j]);
      for (std::size_t i = 0; i < columns.size(); ++i) to[i] += row[columns[i]];
    }
    if (!unknowns_.lagging) return;
    const NuDot slope = dynamics_.Propelled(by_lag);
    sensitivity.col(kFirstShared).tail<3>() += Eigen::Vector3d(slope.u, slope.v, slope.r);
  }

  BodyDynamics dynamics_;
  const SharedUnknowns& unknowns_;
  bool varied_;
  std::array<Eigen::Index, 3> first_{};
};

/// Collects what is missed along a shot.
class ShootingResidualWriter {
 public:
  ShootingResidualWriter(const ShootingPlan& plan, const ShootingSegment& shooting_segment,
                         const SharedUnknowns& unknowns, const NoiseScale& noise_scale,
                         bool with_derivatives)
      : plan_(plan),
        noise_scale_(noise_scale),
        shared_(unknowns.Size()),
        varied_(with_derivatives) {
    shooting_residual_.residual.resize(shooting_segment.Residuals());
    if (!varied_) return;
    shooting_residual_.by_start = RowMajorMatrix::Zero(shooting_segment.Residuals(), 6);
    shooting_residual_.by_shared.resize(shooting_segment.Residuals(), shared_);
  }

  void Add(const NorthEastPosition& fix, const Motion& now) {
    const double c = std::cos(now.state[kPsi]);
    const double s = std::sin(now.state[kPsi]);
    const double ahead = c * plan_.antenna.forward_m - s * plan_.antenna.starboard_m;
    const double abeam = s * plan_.antenna.forward_m + c * plan_.antenna.starboard_m;
    const double noise = noise_scale_.position * plan_.position_noise_m;
    shooting_residual_.residual[row_] = (now.state[0] + ahead - fix.north_m) / noise;
    shooting_residual_.residual[row_ + 1] = (now.state[1] + abeam - fix.east_m) / noise;
    if (varied_) {
      const Sensitivity& S = now.sensitivity;
      // A shot turned about its start turns the whole way sailed since.
      const double x = now.state[0] - start_[0] + ahead;
      const double y = now.state[1] - start_[1] + abeam;
      shooting_residual_.by_start.block<2, 3>(row_, 0) << 1.0, 0.0, -y, 0.0, 1.0, x;
      shooting_residual_.by_start.block<2, 3>(row_, 0) /= noise;
      Write((S.row(0) - abeam * S.row(kPsi)) / noise, row_);
      Write((S.row(1) + ahead * S.row(kPsi)) / noise, row_ + 1);
    }
    Soften(2);
    row_ += 2;
  }

  void Add(const MeanHeading& heading, const Motion& before, const Motion& after) {
    const auto mean = [&](const auto& psi_a, const auto& r_a, const auto& psi_b, const auto& r_b) {
      return heading.psi_before * psi_a + heading.r_before * r_a + heading.psi_after * psi_b +
             heading.r_after * r_b;
    };
    const double noise = noise_scale_.heading * heading.noise_rad;
    const double psi = mean(before.state[kPsi], before.state[5], after.state[kPsi], after.state[5]);
    shooting_residual_.residual[row_] = (psi - heading.psi_rad) / noise;
    if (varied_) {
      const Sensitivity& A = before.sensitivity;
      const Sensitivity& B = after.sensitivity;
      shooting_residual_.by_start(row_, kPsi) = 1.0 / noise;
      Write(mean(A.row(kPsi), A.row(5), B.row(kPsi), B.row(5)) / noise, row_);
    }
    Soften(1);
    ++row_;
  }

  void StartAt(const ShootingState& start) { start_ = start; }
  ShootingResidual Take() && { return std::move(shooting_residual_); }

 private:
  void Write(const SensitivityRow& by, Eigen::Index row) {
    shooting_residual_.by_start.row(row).tail<3>() = by.head<kFirstShared>();
    shooting_residual_.by_shared.row(row) = by.segment(kFirstShared, shared_);
  }

  /// Huber: the square of what is left is s^2 up to the knee and 2 knee s - knee^2 beyond.
  void Soften(Eigen::Index rows) {
    const double huber_threshold = noise_scale_.huber_threshold;
    auto residual = shooting_residual_.residual.segment(row_, rows);
    const double size = residual.norm();
    if (size <= huber_threshold) return;
    const Eigen::VectorXd along = residual / size;
    const double softened = std::sqrt(huber_threshold * (2.0 * size - huber_threshold));
    residual = softened * along;
    if (!varied_) return;
    const auto soften = [&](auto block) {
      const Eigen::RowVectorXd radial = along.transpose() * block;
      block *= softened / size;
      block += (huber_threshold / softened - softened / size) * along * radial;
    };
    soften(shooting_residual_.by_start.middleRows(row_, rows));
    soften(shooting_residual_.by_shared.middleRows(row_, rows));
  }

  const ShootingPlan& plan_;
  const NoiseScale& noise_scale_;
  Eigen::Index shared_;
  bool varied_;
  ShootingState start_ = ShootingState::Zero();
  Eigen::Index row_ = 0;
  ShootingResidual shooting_residual_;
};

bool HasDiverged(const ShootingState& state) {
  return !Within({state[3], state[4], state[5]}, kShootingLimits);
}

}  // namespace

Eigen::Index SharedUnknowns::Size() const {
  return First(Equation::kYaw) + static_cast<Eigen::Index>(columns[2].size());
}

Eigen::Index SharedUnknowns::First(Equation equation) const {
  std::size_t first = lagging ? 1 : 0;
  for (std::size_t j = 0; j < IndexOf(equation); ++j) first += columns[j].size();
  return static_cast<Eigen::Index>(first);
}

VesselModel SharedUnknowns::ModelWith(const Eigen::VectorXd& theta,
                                      double sampling_period_s) const {
  Require(theta.size() == Size(), "as many values as unknowns");
  VesselModel model =
      VesselModel::OfZeros(lagging ? Structure::kFirstOrderDynamic : Structure::kStaticQuadratic,
                           parameterization, Discretisation::kContinuous, sampling_period_s);
  model.dead_zone = dead_zone;
  if (lagging) model.thruster_time_constant_s = std::max(theta[0], kShortestSimulatedTimeConstantS);
  for (const Equation equation : kEquations) {
    const std::size_t j = IndexOf(equation);
    Eigen::Index next = First(equation);
    for (const std::size_t column : columns[j]) {
      model.theta[j][static_cast<Eigen::Index>(column)] = theta[next++];
    }
  }
  return model;
}

Eigen::VectorXd SharedUnknowns::In(const VesselModel& model) const {
  Require(model.parameterization == parameterization, "a model of the same parameterization");
  Eigen::VectorXd theta(Size());
  if (lagging) theta[0] = model.thruster_time_constant_s.value_or(kShortestSimulatedTimeConstantS);
  for (const Equation equation : kEquations) {
    const std::size_t j = IndexOf(equation);
    Eigen::Index next = First(equation);
    for (const std::size_t column : columns[j]) {
      theta[next++] = model.theta[j][static_cast<Eigen::Index>(column)];
    }
  }
  return theta;
}

ShootingPlan CutShootingSegments(const PreparedDataset& dataset,
                                 const RegressionOptions& regression,
                                 const SharedUnknowns& unknowns, const ShootingOptions& options) {
  Require(dataset.signals.size() == dataset.segments.size(), "raw signals of every segment");
  const double h = dataset.sampling_period_s;
  const double recorded_s = static_cast<double>(dataset.rows.size()) * h;
  const double cluster_s = std::clamp(recorded_s / static_cast<double>(options.wanted_clusters),
                                      options.shortest_cluster_s, options.longest_cluster_s);
  ShootingPlan plan;
  plan.position_noise_m =
      std::max(options.least_position_noise_m, dataset.sensors.position_noise_m);
  plan.antenna = dataset.sensors.antenna;
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    const RowRange& segment = dataset.segments[s];
    const SegmentCutter cutter(dataset, s, unknowns, options);
    const double parts =
        std::max(1.0, std::round(static_cast<double>(segment.size()) * h / cluster_s));
    std::optional<std::size_t> part;
    for (const RowRange& run : EnteringRuns(dataset, segment, regression, unknowns)) {
      for (const RowRange& rows : CutRun(run, options.length_s / h)) {
        ShootingSegment shooting_segment = cutter.Between(rows, rows.end + 1 == run.end);
        if (shooting_segment.fixes < kFewestFixes || shooting_segment.headings < kFewestHeadings)
          continue;
        const double centre = 0.5 * static_cast<double>(rows.begin + rows.end - 2 * segment.begin);
        const auto in =
            static_cast<std::size_t>(parts * centre / static_cast<double>(segment.size()));
        if (part != in) ++plan.clusters;
        part = in;
        shooting_segment.cluster = plan.clusters - 1;
        plan.shooting_segments.push_back(std::move(shooting_segment));
      }
    }
  }
  return plan;
}

std::optional<ShootingResidual> ComputeShootingResidual(
    const ShootingPlan& plan, const ShootingSegment& shooting_segment,
    const SharedUnknowns& unknowns, const Eigen::VectorXd& theta, const ShootingState& start,
    const NoiseScale& noise_scale, bool with_derivatives) {
  const VariedDynamics dynamics(unknowns, theta, with_derivatives);
  std::optional<double> time_constant_s;
  if (unknowns.lagging) time_constant_s = std::max(theta[0], kShortestSimulatedTimeConstantS);
  FollowingThrusters thrusters(shooting_segment, time_constant_s);
  ShootingResidualWriter writer(plan, shooting_segment, unknowns, noise_scale, with_derivatives);
  writer.StartAt(start);
  Motion now;
  now.state = start;
  now.sensitivity.setZero();
  now.sensitivity.block<3, 3>(3, 0).setIdentity();
  for (const ShootingNode& node : shooting_segment.nodes) {
    if (node.fix) writer.Add(*node.fix, now);
    if (node.leg_s <= 0.0) break;
    const Motion next = dynamics.Step(now, thrusters.Advance(node.steady, node.leg_s), node.leg_s);
    if (HasDiverged(next.state)) return std::nullopt;
    if (node.heading) writer.Add(*node.heading, now, next);
    now = next;
  }
  return std::move(writer).Take();
}

}  // namespace telltale
