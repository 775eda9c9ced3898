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

std::string ExcitationTable(const Identification& identification, bool counted) {
  const bool weak = identification.estimator == Estimator::kWeakIv;
  std::vector<Column> columns = {{"excitation", Align::kLeft},
                                 {"condition", Align::kRight},
                                 {"variance inflation", Align::kRight}};
  if (counted) {
    columns.push_back({weak ? "supports" : "rows", Align::kRight});
    columns.push_back({"effective sample size", Align::kRight});
  }
  Table table(columns);
  for (const ExcitationSummary& summary : identification.excitation) {
    std::vector<std::string> cells = {std::string(Name(summary.equation)),
                                      Significant(summary.condition, 3),
                                      LargestInflation(summary, identification.parameterization)};
    if (counted) {
      cells.push_back(std::to_string(summary.rows));
      cells.push_back(Fixed(summary.effective_rows, 0));
    }
    table.AddRow(std::move(cells));
  }
  return table.Render();
}

std::string CombinationsText(const Identification& identification) {
  std::string text = "least identifiable combination\n";
  for (const ExcitationSummary& summary : identification.excitation) {
    text += Wrapped(std::string(Name(summary.equation)) + ": " +
                        Combination(summary, identification.parameterization),
                    "  ");
  }
  return text;
}

std::string AdviceText(const Identification& identification) {
  std::string text;
  std::size_t shown = 0;
  for (const ManoeuvreAdvice& advice : identification.advice) {
    if (shown == kManoeuvresShown) break;
    const std::string words = InWords(advice);
    if (words.empty()) continue;
    text += Wrapped(words, "  ") + Wrapped("-> " + advice.how, "     ");
    ++shown;
  }
  return text.empty() ? "" : "\nRecommended manoeuvres, by simulation\n" + text;
}

}  // namespace

std::string IdentifiabilityTable(const Identification& identification) {
  if (identification.excitation.empty()) return "";
  const bool counted = identification.excitation.front().rows > 0;
  return ExcitationTable(identification, counted) + CombinationsText(identification) +
         AdviceText(identification);
}

}  // namespace telltale
