#pragma once

#include <string>
#include <vector>

#include "inputs/reference_basis.hpp"

namespace blind::baselines {

/// Effects that a method takes for the cause, none for nothing, and its Bayesian information
/// criterion.
struct ScoredExplanation {
  std::vector<telltale::ModelledEffect> effects;
  double bic = 0.0;
};

/// The answers as a report.json that blind_score reads: the one of least criterion is the verdict,
/// probabilities are proportional to exp(-bic / 2), closure is that on the recording itself.
/// Requires: at least one answer.
std::string ReportOf(std::vector<ScoredExplanation> explanations, const ReferenceBasis& basis);

}  // namespace blind::baselines
