#include "telltale/client/cli/identifiability_table.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/client/cli/table.hpp"
#include "telltale/core/identification/experiment_design.hpp"

namespace telltale {
namespace {

constexpr std::size_t kManoeuvresShown = 2;

/// "v|v| - 0.9 v": the largest weights of coefficients times the norms of their columns.
std::string Combination(const ExcitationSummary& summary, Parameterization parameterization) {
  constexpr std::size_t kShown = 3;
  const auto regressors = Regressors(summary.equation, parameterization);
  std::vector<CombinationTerm> terms = summary.least_separable;
  std::stable_sort(terms.begin(), terms.end(), [](const auto& a, const auto& b) {
    return std::abs(a.weight) > std::abs(b.weight);
  });
  terms.resize(std::min(terms.size(), kShown));
  std::string text;
  for (const CombinationTerm& term : terms) {
    const double size = std::abs(term.weight);
    const bool minus = term.weight < 0.0;
    text += text.empty() ? (minus ? "-" : "") : (minus ? " - " : " + ");
    if (size < 0.995) text += Fixed(size, 1) + ' ';
    text += regressors[term.regressor].name;
  }
  return terms.size() < summary.least_separable.size() ? text + " ..." : text;
}

/// The largest, and whose it is; coefficients that were never moved have none.
std::string LargestInflation(const ExcitationSummary& summary, Parameterization parameterization) {
  const auto regressors = Regressors(summary.equation, parameterization);
  std::size_t largest = regressors.size();
  for (std::size_t j = 0; j < regressors.size(); ++j) {
    if (!std::isfinite(summary.variance_inflation[j])) continue;
    const bool first = largest == regressors.size();
    if (first || summary.variance_inflation[j] > summary.variance_inflation[largest]) largest = j;
  }
  if (largest == regressors.size()) return "∞";
  return Significant(summary.variance_inflation[largest], 3) + " of " +
         std::string(regressors[largest].name);
}

std::string Advice(const Identification& identification) {
  std::string text;
  std::size_t shown = 0;
  for (const ManoeuvreAdvice& advice : identification.advice) {
    if (shown == kManoeuvresShown) break;
    const std::string words = InWords(advice);
    if (words.empty()) continue;
    text += Wrapped(words, "  ") + Wrapped("-> " + advice.how, "     ");
    ++shown;
  }
  return text.empty() ? "" : "\nWhat would tell more, by simulation\n" + text;
}

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
  std::string text = "All bounds: " + PercentOf(coverage_check.mean_coverage) + " % held, +-" +
                     PercentOf(coverage_check.mean_coverage_error) + " (one sigma)";
  if (coverage_check.joint.of > 0) {
    const Interval joint = BinomialInterval(coverage_check.joint, kCoverageLevel);
    text += "; the ellipsoid of all coefficients: " + PercentOf(coverage_check.joint.Share()) +
            " %, between " + PercentOf(joint.lower) + " and " + PercentOf(joint.upper);
  }
  return Wrapped(text + ".");
}

std::string CoverageCheckConditions(const CoverageCheck& coverage_check) {
  std::string text = std::to_string(coverage_check.replicates_identified) + " of " +
                     std::to_string(coverage_check.replicates_requested) +
                     " simulated repeats of these data, seed " +
                     std::to_string(coverage_check.seed) +
                     ", could be identified. This is how bounds fare if the model is true; it says "
                     "nothing of what the model leaves out.";
  if (!coverage_check.truth_is_reported_model) {
    text += " The boat that was sailed is a tamer one than published, which runs away.";
  }
  return Wrapped(text);
}

}  // namespace

std::string IdentifiabilityTable(const Identification& identification) {
  if (identification.excitation.empty()) return "";
  const bool weak = identification.estimator == Estimator::kWeakIv;
  const bool counted = identification.excitation.front().rows > 0;
  std::vector<Column> columns = {{"excitation", Align::kLeft},
                                 {"condition", Align::kRight},
                                 {"largest variance inflation", Align::kRight}};
  if (counted) {
    columns.push_back({weak ? "windows" : "rows", Align::kRight});
    columns.push_back({"worth", Align::kRight});
  }
  columns.push_back({"least told apart", Align::kLeft});
  Table table(columns);
  for (const ExcitationSummary& summary : identification.excitation) {
    std::vector<std::string> cells = {std::string(Name(summary.equation)),
                                      Significant(summary.condition, 3),
                                      LargestInflation(summary, identification.parameterization)};
    if (counted) {
      cells.push_back(std::to_string(summary.rows));
      cells.push_back(Fixed(summary.effective_rows, 0));
    }
    cells.push_back(Combination(summary, identification.parameterization));
    table.AddRow(std::move(cells));
  }
  return table.Render() + Advice(identification);
}

std::string CoverageTable(const Identification& identification) {
  if (!identification.coverage_check) return "";
  const CoverageCheck& coverage_check = *identification.coverage_check;
  Table table({{"coverage_check", Align::kLeft},
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
