#include "telltale/client/cli/discrete_table.hpp"

#include <cmath>

#include "telltale/client/cli/coefficient_text.hpp"
#include "telltale/client/cli/table.hpp"

namespace telltale {
namespace {

/// alpha = exp(-h / tau) rises with tau, so the bounds of tau carry over.
std::string AlphaText(const Identification& model) {
  if (!model.thruster_time_constant) return "";
  const Coefficient& tau = *model.thruster_time_constant;
  const auto alpha = [h = model.sampling_period_s](double time_constant_s) {
    return time_constant_s > 0.0 ? std::exp(-h / time_constant_s) : 0.0;
  };
  const Interval bounds{tau.interval.level, alpha(tau.interval.lower), alpha(tau.interval.upper)};
  return Wrapped("alpha = exp(-h / tau) = " + Significant(alpha(tau.estimate)) + ", " +
                 BoundsTitle(model) + ' ' + BoundsText(bounds) + "; beta = 1 - alpha");
}

}  // namespace

std::string DiscreteTable(const Identification& identification) {
  const double h = identification.sampling_period_s;
  return "Coefficients times h = " + Plain(h) + " s\n" +
         CoefficientRows(identification,
                         {{"regressor", Align::kLeft},
                          {"symbol", Align::kLeft},
                          {"estimate h", Align::kRight},
                          {"std. error h", Align::kRight},
                          {BoundsTitle(identification), Align::kRight}},
                         [h](const Coefficient& c, std::size_t) -> std::vector<std::string> {
                           return {c.regressor, c.symbol, Significant(h * c.estimate),
                                   Significant(h * c.standard_error, 3), BoundsText(c.interval, h)};
                         }) +
         AlphaText(identification);
}

}  // namespace telltale
