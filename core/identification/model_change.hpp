#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/core/vessel/model_structure.hpp"

namespace telltale {

/// kNoSignificantChange: two models of one boat may well be of the same boat unchanged. kChanged:
/// they differ by more than their errors. kInconclusive: there is no honest test, for a reason
/// given.
enum class ChangeVerdict { kUnknown, kNoSignificantChange, kChanged, kInconclusive };

std::string_view Name(ChangeVerdict verdict);

/// Models that differ this significantly are called different: one unchanged boat in a hundred.
inline constexpr double kSignificantChange = 0.01;

/// How one coefficient changed, later less earlier.
struct CoefficientChange {
  /// Unknown: the thruster time constant, or a parameter of the physical form.
  Equation equation = Equation::kUnknown;
  std::string regressor;
  std::string symbol;
  double difference = 0.0;
  double standard_error = 0.0;  ///< of the difference, positive
  double p_value = 1.0;         ///< of this coefficient alone, not corrected for looking at many

  double Sigmas() const { return difference / standard_error; }
};

/// What an earlier model of the same boat says of a later one.
struct ModelChange {
  std::uint64_t revision = 0;  ///< of the earlier model, 0 where it has none
  ChangeVerdict verdict = ChangeVerdict::kUnknown;
  double p_value = 1.0;    ///< that models of one unchanged boat differ this much
  double statistic = 0.0;  ///< d'V^+ d, docs/concepts/model.md (41)
  std::size_t degrees_of_freedom = 0;
  std::vector<CoefficientChange> coefficients;  ///< the most significant first
  std::string reason;                           ///< why there is no verdict
};

/// "differs from revision 3: p = 0.002, YAW r|r| by 3.4 sigma; fouling, damage or another load?"
std::string InWords(const ModelChange& change);

}  // namespace telltale
