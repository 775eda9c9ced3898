#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/gauss_markov.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/simulation/synthetic_dataset.hpp"
#include "telltale/core/vessel/body_dynamics.hpp"
#include "telltale/core/vessel/motion.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// A pose, the velocity at it and the pose's rate.
struct TrackInstant {
  TrackInstant(const Eta& at, const Nu& by) : eta(at), nu(by), eta_dot(EtaDot(at.psi_rad, by)) {}

  Eta eta;
  Nu nu;
  Eigen::Vector3d eta_dot;
};

/// The poses of one simulated segment at equal steps, with cubic Hermite interpolation between.
class SyntheticTrack {
 public:
  SyntheticTrack(double start_s, double step_s, std::size_t steps);

  void Add(const TrackInstant& instant) { knots_.push_back({instant.eta, instant.eta_dot}); }

  /// The pose, or its heading alone, at a time along the track. Requires: two instants or more.
  Eta At(double time_s) const;
  double HeadingAt(double time_s) const;

 private:
  struct Knot {
    Eta eta;
    Eigen::Vector3d slope;
  };
  struct Piece {
    const Knot& before;
    const Knot& after;
    double share = 0.0;
  };

  Piece About(double time_s) const;

  double start_s_;
  double step_s_;
  std::vector<Knot> knots_;
};

/// One segment of a dataset and when its simulation begins on the synthetic clock.
struct SimulatedSegment {
  const PreparedDataset& dataset;
  std::size_t segment = 0;
  double start_s = 0.0;
  double shift_s = 0.0;  ///< from the dataset's clock to the synthetic one

  const PreparedRow& First() const { return dataset.rows[dataset.segments[segment].begin]; }
  const HeldCommands& Commands() const { return dataset.commands[segment]; }
  double Duration() const;
  /// The measured velocity, interpolated linearly between rows.
  Nu MeasuredAt(double since_start_s) const;
};

/// Simulates the segments of a dataset in their order, with one disturbance process throughout.
/// Model: nu_dot = Phi(nu, T) theta + constant disturbance + d; velocities by a Runge-Kutta step of
/// order four at a tenth of a second or less, poses by Simpson's rule. Commands change about their
/// stamps as SensorProperties::command_spread_s says.
class SegmentSimulator {
 public:
  SegmentSimulator(const PreparedDataset& dataset, const VesselModel& model,
                   const SyntheticDatasetOptions& options);

  /// Refuses when: the simulation exceeds kSyntheticDatasetDivergence.
  Result<SyntheticTrack> Simulate(const SimulatedSegment& segment,
                                  const ConstantDisturbance& constant_disturbance);

 private:
  HeldCommands AsTheyAct(HeldCommands recorded);
  ThrustRegressors ThrustAtStart(const HeldCommands& commands, double start_s) const;
  NuDot PropelledOver(const HeldCommands& commands, double from_s, ThrustRegressors& thrust) const;
  TrackInstant Advance(const TrackInstant& now, const NuDot& applied, const Nu& measured) const;

  const VesselModel& model_;
  BodyDynamics dynamics_;
  Nu limits_;
  double step_s_;
  std::array<bool, 3> as_measured_;
  std::array<GaussMarkov, 3> disturbance_;
  double command_spread_s_;
  RandomEngine command_times_;
};

}  // namespace telltale
