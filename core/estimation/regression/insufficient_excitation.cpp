#include "telltale/core/estimation/regression/insufficient_excitation.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "telltale/core/base/format_number.hpp"

namespace telltale {
namespace {

Eigen::Index ColumnOf(const EquationProblem& problem, std::string_view name) {
  const auto found = std::find_if(problem.regressors.begin(), problem.regressors.end(),
                                  [&](const Regressor& r) { return r.name == name; });
  return found == problem.regressors.end() ? -1 : found - problem.regressors.begin();
}

double Spread(const Eigen::VectorXd& x) {
  return std::sqrt((x.array() - x.mean()).square().mean());
}

/// Mean command for surge, port minus starboard for sway and yaw, read back from the thrust
/// columns.
Eigen::VectorXd CommandOf(const EquationProblem& problem) {
  const bool surge = problem.equation == Equation::kSurge;
  const Eigen::Index forward = ColumnOf(problem, "f:d");
  if (forward >= 0) {
    const Eigen::VectorXd sum =
        problem.phi.col(forward) + problem.phi.col(ColumnOf(problem, "r:d"));
    return surge ? Eigen::VectorXd(0.5 * sum) : sum;
  }
  if (surge) return problem.phi.col(ColumnOf(problem, "mean"));
  return 2.0 * problem.phi.col(ColumnOf(problem, "diff/2"));
}

std::optional<Refusal> RefuseShort(const EquationProblem& problem, const ExcitationLimits& limits) {
  const double needed =
      limits.rows_per_coefficient * static_cast<double>(problem.regressors.size());
  const auto rows = static_cast<double>(problem.phi.rows());
  if (rows >= needed) return std::nullopt;
  return Refusal{std::string(Name(problem.equation)),
                 "only " + FormatSignificant(rows, 3) + " usable rows, " +
                     FormatSignificant(needed, 3) + " are needed",
                 "record for longer with the propellers in the regions this equation uses"};
}

std::optional<Refusal> RefuseConstantMotion(const EquationProblem& problem,
                                            const ExcitationLimits& limits) {
  const bool surge = problem.equation == Equation::kSurge;
  const double motion = Spread(problem.phi.col(ColumnOf(problem, surge ? "u" : "r")));
  const double least = surge ? limits.surge_speed_spread_mps : limits.yaw_rate_spread_radps;
  const std::string what = surge ? "surge speed varies by only " : "yaw rate varies by only ";
  const std::string unit = surge ? " m/s" : " rad/s";
  const std::string advice = surge ? "add straight runs that step between low and high command"
                                   : "add zigzags at two speeds, circles both ways and a spin";
  if (motion < least) {
    return Refusal{std::string(Name(problem.equation)),
                   what + FormatSignificant(motion, 3) + unit + " (standard deviation), " +
                       FormatSignificant(least, 3) + unit + " are needed",
                   advice};
  }
  const double command = Spread(CommandOf(problem));
  if (command >= limits.command_spread) return std::nullopt;
  return Refusal{std::string(Name(problem.equation)),
                 std::string(surge ? "the mean command" : "the command difference") +
                     " varies by only " + FormatSignificant(command, 3) + " of full command, " +
                     FormatSignificant(limits.command_spread, 3) + " are needed",
                 advice};
}

}  // namespace

std::optional<Refusal> RefuseInsufficientExcitation(const EquationProblem& problem,
                                                    const ExcitationLimits& limits) {
  if (auto refusal = RefuseShort(problem, limits)) return refusal;
  return RefuseConstantMotion(problem, limits);
}

}  // namespace telltale
