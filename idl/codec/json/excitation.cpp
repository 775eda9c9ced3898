#include "telltale/idl/codec/json/excitation.hpp"

#include <limits>
#include <span>
#include <string>

#include "telltale/idl/codec/json/proto_values.hpp"
#include "telltale/idl/codec/model_rules.hpp"

namespace telltale {
namespace {

std::size_t ReadRegressor(FieldReader& reader, const std::string& name,
                          std::span<const Regressor> regressors) {
  for (std::size_t j = 0; j < regressors.size(); ++j) {
    if (regressors[j].name == name) return j;
  }
  reader.Fail("regressor", Quoted(name), "a regressor of this equation");
  return 0;
}

}  // namespace

proto::Excitation ToProto(const ExcitationSummary& summary, Parameterization parameterization) {
  proto::Excitation message;
  const auto regressors = Regressors(summary.equation, parameterization);
  message.set_equation(EnumCast<proto::Equation>(summary.equation));
  message.set_condition(summary.condition);
  for (std::size_t j = 0; j < summary.variance_inflation.size(); ++j) {
    proto::VarianceInflation& inflation = *message.add_variance_inflation();
    inflation.set_regressor(std::string(regressors[j].name));
    inflation.set_factor(summary.variance_inflation[j]);
  }
  for (const CombinationTerm& item : summary.least_separable) {
    proto::CombinationTerm& term = *message.add_least_separable();
    term.set_regressor(std::string(regressors[item.regressor].name));
    term.set_weight(item.weight);
  }
  message.set_rows(Saturated(summary.rows));
  message.set_effective_rows(summary.effective_rows);
  return message;
}

ExcitationSummary ReadExcitation(FieldReader reader, const proto::Excitation& message,
                                 Parameterization parameterization) {
  ExcitationSummary summary;
  summary.equation = ReadEnum<Equation>(reader, "equation", message.equation());
  if (summary.equation == Equation::kUnknown) return summary;
  const auto regressors = Regressors(summary.equation, parameterization);
  summary.condition = reader.Number("condition", kConditionNumber);
  summary.variance_inflation.assign(regressors.size(), std::numeric_limits<double>::infinity());
  for (int i = 0; i < message.variance_inflation_size(); ++i) {
    FieldReader item = reader.Item("variance_inflation", i);
    const auto at = ReadRegressor(item, message.variance_inflation(i).regressor(), regressors);
    summary.variance_inflation[at] = item.Number("factor", kNotNegative);
  }
  for (int i = 0; i < message.least_separable_size(); ++i) {
    FieldReader item = reader.Item("least_separable", i);
    const auto at = ReadRegressor(item, message.least_separable(i).regressor(), regressors);
    summary.least_separable.push_back({at, item.Number("weight", kCombinationWeight)});
  }
  summary.rows = message.rows();
  summary.effective_rows = reader.Number("effective_rows", kFiniteNotNegative);
  return summary;
}

}  // namespace telltale
