#include "telltale/core/estimation/weak_form/weak_form.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/data/savitzky_golay.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {
namespace {

constexpr std::size_t kTerms = 8;  // of ThrustRegressors: four of surge, four of turning

using Terms = Eigen::Matrix<double, kTerms, 1>;
using TermSeries = Eigen::Matrix<double, kTerms, Eigen::Dynamic>;  // one column an instant

Terms Flat(const ThrustRegressors& thrust) {
  Terms terms;
  for (std::size_t i = 0; i < 4; ++i) {
    terms[static_cast<Eigen::Index>(i)] = thrust.surge[i];
    terms[static_cast<Eigen::Index>(i + 4)] = thrust.turning[i];
  }
  return terms;
}

ThrustRegressors Folded(const Terms& terms) {
  ThrustRegressors thrust;
  for (std::size_t i = 0; i < 4; ++i) {
    thrust.surge[i] = terms[static_cast<Eigen::Index>(i)];
    thrust.turning[i] = terms[static_cast<Eigen::Index>(i + 4)];
  }
  return thrust;
}

/// Thrusters told one command after the other, delivering what their lag lets through.
class FollowedThrust {
 public:
  FollowedThrust(const WeakProblem& problem, std::optional<double> time_constant_s,
                 const PropellerCommand& settled_on)
      : problem_(problem), time_constant_s_(time_constant_s.value_or(0.0)) {
    now_ = Steady(settled_on);
  }

  /// The mean over the next `duration_s` under `delta`, times that duration.
  Terms Advance(const PropellerCommand& delta, double duration_s) {
    const Terms disturbance_terms = Steady(delta);
    if (time_constant_s_ <= 0.0) {
      now_ = disturbance_terms;
      return duration_s * disturbance_terms;
    }
    const LagPerPeriod lag = LagOver(time_constant_s_ / duration_s);
    const Terms mean = Approach(now_, disturbance_terms, lag.mean);
    now_ = Approach(now_, disturbance_terms, lag.remaining);
    return duration_s * mean;
  }

 private:
  Terms Steady(const PropellerCommand& delta) {
    const bool same =
        steady_of_ && steady_of_->port == delta.port && steady_of_->starboard == delta.starboard;
    if (!same) {
      steady_ = Flat(ThrustOf(problem_.parameterization, problem_.dead_zone.Apply(delta)));
      steady_of_ = delta;
    }
    return steady_;
  }

  const WeakProblem& problem_;
  double time_constant_s_;
  Terms now_ = Terms::Zero();
  std::optional<PropellerCommand> steady_of_;
  Terms steady_ = Terms::Zero();
};

/// Means over the intervals between the rows of a segment; its last row's interval included.
TermSeries MeanThrustBetweenRows(const PreparedDataset& dataset, const WeakProblem& problem,
                                 std::size_t segment, std::optional<double> time_constant_s) {
  const RowRange& range = dataset.segments[segment];
  const HeldCommands& commands = dataset.commands[segment];
  const double h = dataset.sampling_period_s;
  const double start_s = dataset.rows[range.begin].time_s;
  FollowedThrust thrust(problem, time_constant_s, commands.Commands().front());
  const auto advance = [&](double from_s, double to_s) {
    Terms sum = Terms::Zero();
    commands.ForEachPiece(from_s, to_s,
                          [&](const PropellerCommand& delta, double start, double end) {
                            if (end > start) sum += thrust.Advance(delta, end - start);
                          });
    return sum;
  };
  const double remembered_s = commands.Times().front();
  if (time_constant_s && remembered_s < start_s) advance(remembered_s, start_s);
  TermSeries means(kTerms, static_cast<Eigen::Index>(range.size()));
  for (std::size_t k = 0; k < range.size(); ++k) {
    const double from_s = start_s + static_cast<double>(k) * h;
    means.col(static_cast<Eigen::Index>(k)) = advance(from_s, from_s + h) / h;
  }
  return means;
}

/// The filter's weights on intervals, as they apply to a series of means between rows.
TermSeries FilterAsVelocities(const SavitzkyGolay& filter, const TermSeries& between) {
  const auto rows = static_cast<std::size_t>(between.cols());
  TermSeries filtered(kTerms, between.cols());
  const std::size_t intervals = filter.WindowLength() - 1;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t start = filter.WindowStart(row, rows);
    Terms sum = Terms::Zero();
    for (std::size_t i = 0; i < intervals; ++i) {
      sum += filter.IncrementWeight(row - start, i) *
             between.col(static_cast<Eigen::Index>(start + i));
    }
    filtered.col(static_cast<Eigen::Index>(row)) = sum;
  }
  return filtered;
}

/// Whether rows [first, first + count) all enter the equation.
class EnteringRuns {
 public:
  EnteringRuns(const PreparedDataset& dataset, Equation equation,
               const RegressionOptions& regression)
      : entering_until_(dataset.rows.size() + 1, 0) {
    for (std::size_t k = dataset.rows.size(); k-- > 0;) {
      const bool enters = Enters(dataset.rows[k].region, equation, regression);
      entering_until_[k] = enters ? std::max(entering_until_[k + 1], k + 1) : 0;
    }
  }

  bool All(std::size_t first, std::size_t count) const {
    return entering_until_[first] >= first + count;
  }

 private:
  std::vector<std::size_t> entering_until_;  // one past the run of entering rows that k is in
};

/// Rows of one segment whose windows make up a cluster, by their centre.
std::vector<RowRange> CutClusters(const RowRange& segment, double cluster_rows) {
  const auto rows = static_cast<double>(segment.size());
  const auto parts = static_cast<std::size_t>(std::max(1.0, std::round(rows / cluster_rows)));
  std::vector<RowRange> clusters;
  for (std::size_t i = 0; i < parts; ++i) {
    clusters.push_back({segment.begin + segment.size() * i / parts,
                        segment.begin + segment.size() * (i + 1) / parts});
  }
  return clusters;
}

TestFunctionSupports WindowsOf(const PreparedDataset& dataset, Equation equation,
                               const RegressionOptions& regression, const TestFunction& phi,
                               double cluster_s) {
  const EnteringRuns runs(dataset, equation, regression);
  const double cluster_rows = cluster_s / dataset.sampling_period_s;
  // Nearer to the ends the filter is lopsided and changes from row to row.
  const std::size_t margin = dataset.options.smoothing_half_width;
  TestFunctionSupports supports;
  for (const RowRange& segment : dataset.segments) {
    for (const RowRange& cluster : CutClusters(segment, cluster_rows)) {
      const std::size_t before = supports.first_rows.size();
      for (std::size_t first = segment.begin + margin; first + phi.Rows() + margin <= segment.end;
           first += phi.stride) {
        const std::size_t centre = first + phi.Rows() / 2;
        if (centre < cluster.begin || centre >= cluster.end) continue;
        if (runs.All(first, phi.Rows())) supports.first_rows.push_back(first);
      }
      supports.clusters.push_back({before, supports.first_rows.size()});
    }
  }
  return supports;
}

}  // namespace

std::size_t SmoothingFor(const PreparedDataset& preview) {
  constexpr double kLeastS = 0.8;
  constexpr double kLeastOfLongS = 1.6;
  constexpr double kLongS = 900.0;
  constexpr std::size_t kMostRows = 16;
  constexpr double kMostNoise = 0.5;
  double sum = 0.0;
  double squares = 0.0;
  for (const PreparedRow& row : preview.rows) {
    sum += row.nu.v;
    squares += row.nu.v * row.nu.v;
  }
  const auto n = static_cast<double>(preview.rows.size());
  const double spread = std::sqrt(std::max(0.0, squares / n - (sum / n) * (sum / n)));
  const double h = preview.sampling_period_s;
  const double least_s = n * h < kLongS ? kLeastS : kLeastOfLongS;
  auto half_width = static_cast<std::size_t>(std::max(2.0, std::round(least_s / h)));
  const auto noise = [&](std::size_t width) {
    const SavitzkyGolay filter(width, preview.options.smoothing_degree);
    return preview.sensors.position_noise_m / h * filter.SlopeWeights(width).norm();
  };
  while (half_width < kMostRows && noise(half_width) > kMostNoise * spread) ++half_width;
  return half_width;
}

TestFunction TestFunction::On(double sampling_period_s, const WeakFormOptions& options) {
  constexpr double kLeastRows = 5.0;
  const double h = sampling_period_s;
  const double half_rows = std::max(kLeastRows, std::round(options.half_support_s / h));
  const auto rows = static_cast<Eigen::Index>(2.0 * half_rows) - 1;  // it is zero at both ends
  const Eigen::Index centre = rows / 2;
  const double T = half_rows * h;
  TestFunction phi{Eigen::VectorXd(rows), Eigen::VectorXd(rows), 1};
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double s = static_cast<double>(i - centre) * h / T;
    const double below = 1.0 - s * s;
    phi.value[i] = h * std::pow(below, 6);
    phi.slope[i] = h * -12.0 * s / T * std::pow(below, 5);
  }
  phi.stride = static_cast<std::size_t>(std::max(1.0, std::round(options.spacing_s / h)));
  return phi;
}

WeakProblem BuildWeakForm(const PreparedDataset& dataset, const RegressionOptions& regression,
                          const WeakFormOptions& options) {
  Require(dataset.options.preset == Preset::kRobust, "data prepared with one kernel");
  Require(dataset.sampling_period_s > 0.0, "a positive sampling period");
  Require(dataset.commands.size() == dataset.segments.size(), "the commands of every segment");
  WeakProblem problem;
  problem.parameterization = regression.parameterization;
  problem.dead_zone = regression.dead_zone;
  problem.disturbance_terms = {regression.recording_bias, dataset.Recordings()};
  problem.phi = TestFunction::On(dataset.sampling_period_s, options);
  const double recorded_s = static_cast<double>(dataset.rows.size()) * dataset.sampling_period_s;
  const double cluster_s = std::clamp(recorded_s / static_cast<double>(options.wanted_clusters),
                                      options.shortest_cluster_s, options.longest_cluster_s);
  for (const Equation equation : kEquations) {
    problem.supports[IndexOf(equation)] =
        WindowsOf(dataset, equation, regression, problem.phi, cluster_s);
  }
  problem.clusters = problem.supports[0].clusters.size();
  problem.bodies.reserve(dataset.rows.size());
  for (const PreparedRow& row : dataset.rows) {
    problem.bodies.push_back(NoiseCorrectedBodyRow(row.nu, dataset.nu_noise));
  }
  return problem;
}

FilteredThrust FilterThrust(const PreparedDataset& dataset, const WeakProblem& problem,
                            std::optional<double> time_constant_s) {
  const SavitzkyGolay filter(dataset.options.smoothing_half_width,
                             dataset.options.smoothing_degree);
  FilteredThrust thrust;
  thrust.interval.reserve(dataset.rows.size());
  thrust.filtered.reserve(dataset.rows.size());
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    const TermSeries between = MeanThrustBetweenRows(dataset, problem, s, time_constant_s);
    const TermSeries filtered = FilterAsVelocities(filter, between);
    for (Eigen::Index k = 0; k < between.cols(); ++k) {
      thrust.interval.push_back(Folded(between.col(k)));
      thrust.filtered.push_back(Folded(filtered.col(k)));
    }
  }
  return thrust;
}

Eigen::VectorXd FilterOnIntervals(const PreparedDataset& dataset) {
  const std::size_t centre = dataset.options.smoothing_half_width;
  const SavitzkyGolay filter(centre, dataset.options.smoothing_degree);
  Eigen::VectorXd weights(static_cast<Eigen::Index>(filter.WindowLength()) - 1);
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    weights[i] = filter.IncrementWeight(centre, static_cast<std::size_t>(i));
  }
  return weights;
}

Eigen::VectorXd FilteredTestFunction(const Eigen::VectorXd& filter, const TestFunction& phi) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(phi.value.size() + filter.size() - 1);
  for (Eigen::Index i = 0; i < phi.value.size(); ++i) {
    weights.segment(i, filter.size()) += phi.value[i] * filter;
  }
  return weights;
}

RegressorRows RowsOf(const PreparedDataset& dataset, const WeakProblem& problem,
                     const FilteredThrust& thrust, Equation equation) {
  const std::size_t columns = Regressors(equation, problem.parameterization).size();
  const std::size_t disturbance_terms = problem.disturbance_terms.Count();
  RegressorRows rows(static_cast<Eigen::Index>(dataset.rows.size()),
                     static_cast<Eigen::Index>(columns + disturbance_terms));
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    for (std::size_t k = dataset.segments[s].begin; k < dataset.segments[s].end; ++k) {
      double* const row = rows.row(static_cast<Eigen::Index>(k)).data();
      FillRow(equation, problem.bodies[k], thrust.filtered[k], {row, columns});
      problem.disturbance_terms.Fill(dataset.RecordingOf(s), dataset.rows[k].eta.psi_rad,
                                     {row + columns, disturbance_terms});
    }
  }
  return rows;
}

Eigen::MatrixXd Project(const WeakProblem& problem, const TestFunctionSupports& supports,
                        const RegressorRows& rows) {
  const Eigen::Index length = problem.phi.value.size();
  Eigen::MatrixXd projected(static_cast<Eigen::Index>(supports.first_rows.size()), rows.cols());
  Eigen::RowVectorXd sum(rows.cols());
  for (std::size_t k = 0; k < supports.first_rows.size(); ++k) {
    const auto first = static_cast<Eigen::Index>(supports.first_rows[k]);
    sum.noalias() = problem.phi.value.transpose() * rows.middleRows(first, length);
    projected.row(static_cast<Eigen::Index>(k)) = sum;
  }
  return projected;
}

Eigen::VectorXd ProjectAcceleration(const WeakProblem& problem,
                                    const TestFunctionSupports& supports,
                                    const PreparedDataset& dataset, Equation equation) {
  Eigen::VectorXd projected(static_cast<Eigen::Index>(supports.first_rows.size()));
  for (std::size_t k = 0; k < supports.first_rows.size(); ++k) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < problem.phi.slope.size(); ++i) {
      const PreparedRow& row = dataset.rows[supports.first_rows[k] + static_cast<std::size_t>(i)];
      sum -= problem.phi.slope[i] * ComponentOf(row.nu, equation);
    }
    projected[static_cast<Eigen::Index>(k)] = sum;
  }
  return projected;
}

}  // namespace telltale
