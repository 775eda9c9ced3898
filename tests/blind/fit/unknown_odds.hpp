#pragma once

#include <map>
#include <string>
#include <vector>

#include "score/figures.hpp"

namespace blind::fit {

/// The likeliest hypothesis of a report: what speaks for another cause, and whether there is one.
struct Observation {
  std::map<std::string, double> regressors;
  bool is_weather = false;  // and no fault of the boat
  bool is_another = false;
  bool is_left_out = false;  // diagnosed without the true effect
};

/// Of each report that sees a gap: the likeliest cause of the library is another one unless it is
/// the true effects, with or without the weather beside them, or the weather that is there of a
/// nominal boat; outside the library it is another one always. Without the true effect it is
/// another one too; there neither the weather that is there counts nor what is known to look like
/// the true effects, of which a diagnosis cannot know.
std::vector<Observation> ObservationsOf(const std::vector<score::Scored>& cases);

/// The log odds that the cause is another: one weight a regressor.
struct LogisticModel {
  std::map<std::string, double> weights;

  double Probability(const Observation& observation) const;
};

/// Maximum likelihood with a ridge: the least mean logarithmic loss, plus `ridge` times the squares
/// of the weights but for that of "constant". By Newton's method; Bishop, Pattern Recognition and
/// Machine Learning, 2006, section 4.3.3. Throws std::invalid_argument where there is no
/// observation of either kind, one lacks a regressor, or no weights are the likeliest.
LogisticModel FitLogistic(const std::vector<Observation>& observations,
                          const std::vector<std::string>& regressors, double ridge);

/// The mean of -ln of the probability of what was the case.
double LogarithmicLoss(const LogisticModel& model, const std::vector<Observation>& observations);

}  // namespace blind::fit
