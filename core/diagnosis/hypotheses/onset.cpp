#include "telltale/core/diagnosis/hypotheses/onset.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace telltale {
namespace {

constexpr double kOnsetDeviance = 20.0;  // -2 ln likelihood, beyond what looking everywhere gains
constexpr double kChiSquared95 = 3.84;
constexpr std::size_t kFewestWindows = 4;  // on either side

Eigen::VectorXd SquaresOf(const ResidualMetric& metric, const Eigen::MatrixXd& errors) {
  const Eigen::VectorXd left = metric.Unexplained(metric.Whiten(errors));
  const auto windows = static_cast<Eigen::Index>(metric.Windows().size());
  return left.reshaped(left.size() / windows, windows).colwise().squaredNorm();
}

}  // namespace

std::optional<Onset> OnsetOf(const EffectFit& fit, const DiagnosisProblem& problem) {
  const Eigen::VectorXd without = SquaresOf(problem.metric, problem.recording.errors);
  const Eigen::VectorXd with = SquaresOf(problem.metric, fit.errors);
  const auto windows = static_cast<std::size_t>(with.size());
  if (windows < 3 * kFewestWindows) return std::nullopt;
  // By how much the windows before each one are better without.
  std::vector<double> gain(windows, 0.0);
  for (std::size_t w = 1; w < windows; ++w) {
    const auto before = static_cast<Eigen::Index>(w - 1);
    gain[w] = gain[w - 1] + with[before] - without[before];
  }
  const auto from = gain.begin() + static_cast<std::ptrdiff_t>(kFewestWindows);
  const auto to = gain.end() - static_cast<std::ptrdiff_t>(kFewestWindows);
  const auto best = std::max_element(from, to);
  if (*best < kOnsetDeviance + 2.0 * std::log(static_cast<double>(windows))) return std::nullopt;
  const auto near = [&](double value) { return value >= *best - kChiSquared95; };
  const auto first = std::find_if(from, to, near);
  const auto last =
      std::find_if(std::make_reverse_iterator(to), std::make_reverse_iterator(from), near);
  const auto time_of = [&](auto place) {
    return problem.runs.Of(problem.metric.Windows()[static_cast<std::size_t>(place - gain.begin())])
        .time_s;
  };
  return Onset{time_of(best), time_of(first), time_of(last.base() - 1)};
}

}  // namespace telltale
