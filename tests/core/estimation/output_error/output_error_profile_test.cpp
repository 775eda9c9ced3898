// A boat on a straight course, u_dot = -d u + b delta. For a fixed d its track is a linear function
// of b and of the initial state of each shooting segment, so the exact profile of d follows from
// linear least squares in closed form.
#include "telltale/core/estimation/output_error/output_error_profile.hpp"
#include "telltale/core/estimation/output_error/output_error_covariance.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "support/stable_boat.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/simulation/simulator.hpp"
#include "telltale/core/uncertainty/profile_interval.hpp"

namespace telltale {
namespace {

constexpr std::size_t kDrag = 3;    // surge's u
constexpr std::size_t kThrust = 6;  // surge's f:d
constexpr double kTrueDrag = 2.0;
constexpr double kTrueThrust = 4.0;

std::array<std::vector<std::size_t>, 3> DragAndThrust() {
  return {{{kDrag, kThrust}, {}, {}}};
}

VesselModel StraightBoat() {
  VesselModel boat = VesselModel::OfZeros(Structure::kStaticQuadratic, Parameterization::kPropeller,
                                          Discretisation::kContinuous, 0.2);
  boat.theta[0][kDrag] = -kTrueDrag;
  boat.theta[0][kThrust] = kTrueThrust;
  return boat;
}

/// `position_noise_m` decides how far from quadratic the profile is within the reach of a bound.
PreparedDataset StraightRun(double position_noise_m, std::uint64_t seed) {
  std::vector<TimedCommand> commands;
  for (int i = 0; i < 12; ++i) {
    const double share = i % 2 == 0 ? 0.9 : 0.2;
    commands.push_back({5.0 * i, {share, share}});
  }
  const Vehicle vehicle = testing::StableBoatVehicle();
  SensorOptions sensors = testing::NoisySensors(1.0, seed);
  sensors.position_noise_m = position_noise_m;
  return Prepare(Measure(Simulate(StraightBoat(), {}, commands, 60.0, 0.02), vehicle, sensors),
                 vehicle, {})
      .value();
}

/// Sum of squares of all fixes northwards, in sizes of the sensor, with b and the states of the
/// shooting segments fitted to them.
double ExactSum(const ShootingPlan& plan, double size_m, double drag) {
  const auto shooting_segments = static_cast<Eigen::Index>(plan.shooting_segments.size());
  std::vector<Eigen::RowVectorXd> rows;
  std::vector<double> measured;
  for (Eigen::Index s = 0; s < shooting_segments; ++s) {
    // North and speed as coefficients of b, of the first north and of the first speed.
    Eigen::Vector3d north(0.0, 1.0, 0.0);
    Eigen::Vector3d speed(0.0, 0.0, 1.0);
    for (const ShootingNode& node : plan.shooting_segments[static_cast<std::size_t>(s)].nodes) {
      if (node.fix) {
        Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(1 + 2 * shooting_segments);
        row[0] = north[0];
        row[1 + 2 * s] = north[1];
        row[2 + 2 * s] = north[2];
        rows.push_back(row / size_m);
        measured.push_back(node.fix->north_m / size_m);
      }
      const double left = std::exp(-drag * node.leg_s);
      const Eigen::Vector3d push = Eigen::Vector3d(node.steady.surge[kThrust - 5], 0.0, 0.0) / drag;
      north += push * node.leg_s + (speed - push) * (1.0 - left) / drag;
      speed = push + (speed - push) * left;
    }
  }
  Eigen::MatrixXd A(static_cast<Eigen::Index>(rows.size()), 1 + 2 * shooting_segments);
  Eigen::VectorXd z(A.rows());
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    A.row(i) = rows[static_cast<std::size_t>(i)];
    z[i] = measured[static_cast<std::size_t>(i)];
  }
  return (z - A * Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(A).solve(z)).squaredNorm();
}

/// Where a function that rises from `inside` to `outside` reaches zero.
double Root(const std::function<double(double)>& f, double inside, double outside) {
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (inside + outside);
    (f(middle) > 0.0 ? outside : inside) = middle;
  }
  return inside;
}

struct Profiled {
  double estimate = 0.0;  ///< of the drag
  double naive = 0.0;     ///< its standard error
  double asymmetry_estimate = 0.0;
  Interval by_profile;
  Interval exact;
};

Profiled ProfileDrag(double position_noise_m, std::uint64_t seed) {
  constexpr double kQuantile = 1.96;
  OutputErrorOptions options;
  options.huber_threshold = 100.0;  // least squares, as the closed form
  const PreparedDataset dataset = StraightRun(position_noise_m, seed);
  const auto fit =
      EstimateOutputError(dataset, {}, DragAndThrust(), StraightBoat(), options).value();
  const OutputErrorProfile profile(dataset, {}, fit, options);
  Profiled found;
  found.estimate = -fit.theta[0];
  found.naive = std::sqrt(NaiveCovariance(fit)(0, 0));
  const double half_width = kQuantile * found.naive;
  found.asymmetry_estimate = profile.Asymmetry(0, half_width);
  const Interval of_coefficient =
      ProfileInterval([&](double value) { return profile.Deviance(0, value); },
                      {fit.theta[0], half_width, fit.theta[0] - 10.0 * half_width,
                       fit.theta[0] + 10.0 * half_width},
                      kQuantile * kQuantile, 0.95);
  found.by_profile = {0.95, -of_coefficient.upper, -of_coefficient.lower};

  const ShootingPlan plan =
      CutShootingSegments(dataset, {}, fit.unknowns, options.shooting_segments);
  const double size_m = plan.position_noise_m * fit.position_misfit;
  const auto sum = [&](double drag) { return ExactSum(plan, size_m, drag); };
  double least = found.estimate;
  for (double step = 0.5 * found.naive; step > 1e-6; step *= 0.5) {
    for (const double to : {least - step, least + step}) {
      if (to > 0.0 && sum(to) < sum(least)) least = to;
    }
  }
  const auto beyond = [&, least_sum = sum(least)](double drag) {
    return (sum(drag) - least_sum) / fit.residual_variance - kQuantile * kQuantile;
  };
  found.exact = {0.95, Root(beyond, least, 1e-3), Root(beyond, least, least + 12.0 * half_width)};
  return found;
}

/// Of so much drag the track shows how far the boat lags behind its steady speed, which goes with
/// 1 / d: noisy fixes rule out little drag sooner than much of it, and a bound by standard error
/// says too much below and too little above. Ends are known to a hundredth of the way; headings
/// move them by another.
TEST(OutputErrorProfile, IsThatOfTheClosedFormWhereItIsAsymmetric) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Profiled found = ProfileDrag(1.0, seed);
    const double below = found.estimate - found.exact.lower;
    const double above = found.exact.upper - found.estimate;
    EXPECT_NEAR(found.by_profile.lower, found.exact.lower, 0.03 * below) << seed;
    EXPECT_NEAR(found.by_profile.upper, found.exact.upper, 0.03 * above) << seed;
    EXPECT_GT(found.by_profile.upper, found.estimate + 1.05 * 1.96 * found.naive) << seed;
    EXPECT_GT(found.by_profile.lower, found.estimate - 0.97 * 1.96 * found.naive) << seed;
    EXPECT_GT(found.asymmetry_estimate, 1.15) << seed;  // above the threshold for a profile
  }
}

/// With fixes to the centimetre the track is linear over the reach of the bound.
TEST(OutputErrorProfile, IsThatOfTheStandardErrorWhereTheModelIsAllButLinear) {
  const Profiled found = ProfileDrag(0.01, 4);
  EXPECT_LT(found.asymmetry_estimate, 1.05);
  const double half = 1.96 * found.naive;
  EXPECT_NEAR(found.by_profile.upper, found.estimate + half, 0.05 * half);
  EXPECT_NEAR(found.by_profile.lower, found.estimate - half, 0.05 * half);
}

}  // namespace
}  // namespace telltale
