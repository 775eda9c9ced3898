#include "telltale/core/estimation/weak_form/filtered_thrust.hpp"

#include "telltale/core/data/savitzky_golay.hpp"
#include "telltale/core/vessel/thrust_terms.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {
namespace {

constexpr Eigen::Index kTerms = ThrustTerms::RowsAtCompileTime;

/// One column an instant.
using ThrustSeries = Eigen::Matrix<double, kTerms, Eigen::Dynamic>;

/// The thrust of propellers that receive one command after another.
class LaggedThrusters {
 public:
  LaggedThrusters(const WeakProblem& problem, std::optional<double> time_constant_s,
                  const PropellerCommand& settled_on)
      : problem_(problem), time_constant_s_(time_constant_s.value_or(0.0)) {
    now_ = Steady(settled_on);
  }

  /// The integral of the thrust over the next `duration_s` under `delta`.
  ThrustTerms Advance(const PropellerCommand& delta, double duration_s) {
    const ThrustTerms steady = Steady(delta);
    if (time_constant_s_ <= 0.0) {
      now_ = steady;
      return duration_s * steady;
    }
    const LagPerPeriod lag = LagOver(time_constant_s_ / duration_s);
    const ThrustTerms mean = Approach(now_, steady, lag.mean);
    now_ = Approach(now_, steady, lag.remaining);
    return duration_s * mean;
  }

 private:
  /// What a held command leads to; the last one is kept, as commands rarely change.
  ThrustTerms Steady(const PropellerCommand& delta) {
    const bool same =
        steady_of_ && steady_of_->port == delta.port && steady_of_->starboard == delta.starboard;
    if (!same) {
      steady_ = TermsOf(ThrustOf(problem_.parameterization, problem_.dead_zone.Apply(delta)));
      steady_of_ = delta;
    }
    return steady_;
  }

  const WeakProblem& problem_;
  double time_constant_s_;
  ThrustTerms now_ = ThrustTerms::Zero();
  std::optional<PropellerCommand> steady_of_;
  ThrustTerms steady_ = ThrustTerms::Zero();
};

/// Means over the intervals that follow the rows of a segment, including that of its last row.
ThrustSeries MeanThrustBetweenRows(const PreparedDataset& dataset, const WeakProblem& problem,
                                   std::size_t segment, std::optional<double> time_constant_s) {
  const RowRange& range = dataset.segments[segment];
  const HeldCommands& commands = dataset.commands[segment];
  const double h = dataset.sampling_period_s;
  const double start_s = dataset.rows[range.begin].time_s;
  LaggedThrusters thrusters(problem, time_constant_s, commands.Commands().front());
  const auto advance = [&](double from_s, double to_s) {
    ThrustTerms sum = ThrustTerms::Zero();
    commands.ForEachPiece(from_s, to_s,
                          [&](const PropellerCommand& delta, double start, double end) {
                            if (end > start) sum += thrusters.Advance(delta, end - start);
                          });
    return sum;
  };
  const double remembered_s = commands.Times().front();
  if (time_constant_s && remembered_s < start_s) advance(remembered_s, start_s);
  ThrustSeries means(kTerms, static_cast<Eigen::Index>(range.size()));
  for (std::size_t k = 0; k < range.size(); ++k) {
    const double from_s = start_s + static_cast<double>(k) * h;
    means.col(static_cast<Eigen::Index>(k)) = advance(from_s, from_s + h) / h;
  }
  return means;
}

/// The filter of the velocities, applied to means between rows.
ThrustSeries FilterAsVelocities(const SavitzkyGolay& filter, const ThrustSeries& between) {
  const auto rows = static_cast<std::size_t>(between.cols());
  ThrustSeries filtered(kTerms, between.cols());
  const std::size_t intervals = filter.WindowLength() - 1;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t start = filter.WindowStart(row, rows);
    ThrustTerms sum = ThrustTerms::Zero();
    for (std::size_t i = 0; i < intervals; ++i) {
      sum += filter.IncrementWeight(row - start, i) *
             between.col(static_cast<Eigen::Index>(start + i));
    }
    filtered.col(static_cast<Eigen::Index>(row)) = sum;
  }
  return filtered;
}

}  // namespace

FilteredThrust FilterThrust(const PreparedDataset& dataset, const WeakProblem& problem,
                            std::optional<double> time_constant_s) {
  const SavitzkyGolay filter(dataset.options.smoothing_half_width,
                             dataset.options.smoothing_degree);
  FilteredThrust thrust;
  thrust.interval.reserve(dataset.rows.size());
  thrust.filtered.reserve(dataset.rows.size());
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    const ThrustSeries between = MeanThrustBetweenRows(dataset, problem, s, time_constant_s);
    const ThrustSeries filtered = FilterAsVelocities(filter, between);
    for (Eigen::Index k = 0; k < between.cols(); ++k) {
      thrust.interval.push_back(RegressorsOf(between.col(k)));
      thrust.filtered.push_back(RegressorsOf(filtered.col(k)));
    }
  }
  return thrust;
}

}  // namespace telltale
