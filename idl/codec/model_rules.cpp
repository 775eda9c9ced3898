#include "telltale/idl/codec/model_rules.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "telltale/core/vessel/fossen_model.hpp"

namespace telltale {
namespace {

using Fault = std::optional<CodecError>;

std::string Place(std::size_t coefficient, const char* field) {
  return "coefficients[" + std::to_string(coefficient) + "]." + field;
}

Fault TextFault(std::string field, std::string_view value, std::string_view expected) {
  if (value == expected) return std::nullopt;
  return CodecError{std::move(field), Quoted(value), Quoted(expected)};
}

/// Whether the coefficient at a place is that of the regressor which the structure has there.
Fault PlaceFault(const Coefficient& coefficient, std::size_t place, Equation equation,
                 const Regressor& regressor) {
  if (coefficient.equation != equation) {
    return CodecError{Place(place, "equation"), std::string(Name(coefficient.equation)),
                      std::string(Name(equation)) + ", whose regressor " + Quoted(regressor.name) +
                          " is still missing"};
  }
  if (auto fault = TextFault(Place(place, "regressor"), coefficient.regressor, regressor.name)) {
    return fault;
  }
  if (auto fault = TextFault(Place(place, "symbol"), coefficient.symbol, regressor.symbol)) {
    return fault;
  }
  return TextFault(Place(place, "unit"), coefficient.unit, regressor.unit);
}

/// Checks the equation whose coefficients begin at `next`, and moves `next` past them. An equation
/// that does not begin there is absent, which is no fault.
Fault EquationFault(const Identification& identification, Equation equation, std::size_t& next) {
  const std::vector<Coefficient>& coefficients = identification.coefficients;
  if (next == coefficients.size() || coefficients[next].equation != equation) return std::nullopt;
  for (const Regressor& regressor : Regressors(equation, identification.parameterization)) {
    if (next == coefficients.size()) {
      return CodecError{
          "coefficients", std::to_string(coefficients.size()) + " entries",
          std::string(Name(equation)) + " goes on with regressor " + Quoted(regressor.name)};
    }
    if (auto fault = PlaceFault(coefficients[next], next, equation, regressor)) return fault;
    ++next;
  }
  return std::nullopt;
}

Fault CoefficientsFault(const Identification& identification) {
  const std::vector<Coefficient>& coefficients = identification.coefficients;
  if (coefficients.empty()) return CodecError{"coefficients", "(none)", "at least one equation"};
  std::size_t next = 0;
  for (const Equation equation : kEquations) {
    if (auto fault = EquationFault(identification, equation, next)) return fault;
  }
  if (next == coefficients.size()) return std::nullopt;
  return CodecError{Place(next, "equation"), std::string(Name(coefficients[next].equation)),
                    "SURGE, SWAY, YAW in this order, each at most once"};
}

CodecError CovarianceFaultAt(const Eigen::MatrixXd& covariance, Eigen::Index row,
                             Eigen::Index column, std::string allowed) {
  return {"covariance[" + std::to_string(row * covariance.cols() + column) + "]",
          NumberText(covariance(row, column)), std::move(allowed)};
}

bool AreSymmetric(double a, double b, double variance_a, double variance_b) {
  constexpr double kRounding = 1e-9;  // far above what printing 17 digits loses
  return std::abs(a - b) <= kRounding * std::sqrt(variance_a * variance_b) || a == b;
}

Fault CovarianceFault(const Eigen::MatrixXd& covariance) {
  for (Eigen::Index row = 0; row < covariance.rows(); ++row) {
    for (Eigen::Index column = 0; column < covariance.cols(); ++column) {
      const FieldRange range = row == column ? kNotNegative : kFinite;
      if (range.Contains(covariance(row, column))) continue;
      return CovarianceFaultAt(covariance, row, column, range.Text());
    }
  }
  for (Eigen::Index row = 0; row < covariance.rows(); ++row) {
    for (Eigen::Index column = 0; column < row; ++column) {
      const double mirrored = covariance(column, row);
      if (AreSymmetric(covariance(row, column), mirrored, covariance(row, row),
                       covariance(column, column))) {
        continue;
      }
      return CovarianceFaultAt(covariance, row, column,
                               "a symmetric matrix, so " + NumberText(mirrored));
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<CodecError> ModelFault(const Identification& identification) {
  if (auto fault = CoefficientsFault(identification)) return fault;
  return CovarianceFault(identification.covariance);
}

std::optional<CodecError> ParametersFault(const std::string& field,
                                          const std::vector<Coefficient>& parameters) {
  const auto& names = FossenParameterNames();
  if (parameters.size() != names.size()) {
    return CodecError{field, std::to_string(parameters.size()) + " items",
                      std::to_string(names.size()) + ", the parameters of FOSSEN"};
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string place = field + '[' + std::to_string(i) + "].symbol";
    if (auto fault = TextFault(place, parameters[i].symbol, names[i].symbol)) return fault;
  }
  return std::nullopt;
}

}  // namespace telltale
