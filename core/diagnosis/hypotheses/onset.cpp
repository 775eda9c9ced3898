#include "telltale/core/diagnosis/hypotheses/onset.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

/// Squared norm of what the metric leaves unexplained, by window.
Eigen::VectorXd SquaresOf(const ResidualMetric& metric, const Eigen::MatrixXd& errors) {
  const Eigen::VectorXd unexplained = metric.Unexplained(metric.Whiten(errors));
  const auto windows = static_cast<Eigen::Index>(metric.Windows().size());
  return unexplained.reshaped(unexplained.size() / windows, windows).colwise().squaredNorm();
}

/// For each window, by how much the windows before it are more likely without the hypothesis.
std::vector<double> GainsOf(const Eigen::VectorXd& without, const Eigen::VectorXd& with) {
  const auto windows = static_cast<std::size_t>(with.size());
  std::vector<double> gains(windows, 0.0);
  for (std::size_t w = 1; w < windows; ++w) {
    const auto before = static_cast<Eigen::Index>(w - 1);
    gains[w] = gains[w - 1] + with[before] - without[before];
  }
  return gains;
}

}  // namespace

std::optional<Onset> OnsetOf(const EffectFit& fit, const DiagnosisProblem& problem) {
  constexpr OnsetConstants kOnset = kDiagnosis.onset;
  const std::vector<double> gains = GainsOf(SquaresOf(problem.metric, problem.recording.errors),
                                            SquaresOf(problem.metric, fit.errors));
  if (gains.size() < 3 * kOnset.minimum_windows) return std::nullopt;
  const auto from = gains.begin() + static_cast<std::ptrdiff_t>(kOnset.minimum_windows);
  const auto to = gains.end() - static_cast<std::ptrdiff_t>(kOnset.minimum_windows);
  const auto best = std::max_element(from, to);
  // Trying every window costs 2 ln of their number.
  const double cost_of_search = 2.0 * std::log(static_cast<double>(gains.size()));
  if (*best < kOnset.minimum_deviance + cost_of_search) return std::nullopt;
  const auto near = [&](double gain) { return gain >= *best - kOnset.interval_deviance; };
  const auto first = std::find_if(from, to, near);
  const auto last =
      std::find_if(std::make_reverse_iterator(to), std::make_reverse_iterator(from), near);
  const auto time_of = [&](auto place) {
    return problem.runs
        .Of(problem.metric.Windows()[static_cast<std::size_t>(place - gains.begin())])
        .time_s;
  };
  return Onset{time_of(best), time_of(first), time_of(last.base() - 1)};
}

}  // namespace telltale
