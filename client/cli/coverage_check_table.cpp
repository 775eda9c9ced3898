#include "telltale/client/cli/coverage_check_table.hpp"

#include "telltale/client/cli/table.hpp"

namespace telltale {
namespace {

std::string PercentOf(double share) {
  return Fixed(100.0 * share, 1);
}

std::vector<std::string> Cells(const std::string& name, const CoefficientCoverage& coverage) {
  const Interval bounds = coverage.Bounds();
  return {name, std::to_string(coverage.tally.held) + " of " + std::to_string(coverage.tally.of),
          PercentOf(coverage.tally.Share()),
          '[' + PercentOf(bounds.lower) + ", " + PercentOf(bounds.upper) + ']',
          Fixed(coverage.bias, 2)};
}

std::string JointCoverageText(const CoverageCheck& coverage_check) {
  std::string text = "All bounds: " + PercentOf(coverage_check.mean_coverage) + " % held, ±" +
                     PercentOf(coverage_check.mean_coverage_error) + " (one sigma)";
  if (coverage_check.joint.of > 0) {
    const Interval joint = BinomialInterval(coverage_check.joint, kCoverageLevel);
    text += "; the ellipsoid of all coefficients: " + PercentOf(coverage_check.joint.Share()) +
            " %, between " + PercentOf(joint.lower) + " and " + PercentOf(joint.upper);
  }
  return Wrapped(text + ".");
}

std::string CoverageCheckConditions(const CoverageCheck& coverage_check) {
  std::string text =
      std::to_string(coverage_check.replicates_identified) + " of " +
      std::to_string(coverage_check.replicates_requested) +
      " simulated replicates of these data (seed " + std::to_string(coverage_check.seed) +
      ") could be identified. This is the coverage if the model is true; it does not "
      "measure what the model leaves out.";
  if (!coverage_check.truth_is_reported_model) {
    text +=
        " The simulated boat has the regularised parameters, because the reported ones diverge.";
  }
  return Wrapped(text);
}

}  // namespace

std::string CoverageTable(const Identification& identification) {
  if (!identification.coverage_check) return "";
  const CoverageCheck& coverage_check = *identification.coverage_check;
  Table table({{"coverage check", Align::kLeft},
               {"bounds held", Align::kRight},
               {"%", Align::kRight},
               {"known to lie in", Align::kRight},
               {"bias in std. errors", Align::kRight}});
  for (const Equation equation : kEquations) {
    if (!identification.Has(equation)) continue;
    table.AddHeading(std::string(Name(equation)));
    for (std::size_t i = 0; i < coverage_check.coefficients.size(); ++i) {
      const Coefficient& c = identification.coefficients[i];
      if (c.equation == equation) {
        table.AddRow(Cells(c.regressor, coverage_check.coefficients[i]));
      }
    }
  }
  if (coverage_check.thruster_time_constant) {
    table.AddHeading("THRUSTERS");
    table.AddRow(Cells("tau", *coverage_check.thruster_time_constant));
  }
  return table.Render() + JointCoverageText(coverage_check) +
         CoverageCheckConditions(coverage_check);
}

}  // namespace telltale
