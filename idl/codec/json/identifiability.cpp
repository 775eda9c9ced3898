#include "telltale/idl/codec/json/identifiability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/codec/json/proto_values.hpp"

namespace telltale {
namespace {

void Write(const Interval& interval, proto::Interval& message) {
  message.set_level(interval.level);
  message.set_lower(interval.lower);
  message.set_upper(interval.upper);
}

void Write(const ExcitationSummary& summary, Parameterization parameterization,
           proto::Excitation& message) {
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
}

void Write(const ManoeuvreAdvice& advice, proto::ManoeuvreAdvice& message) {
  message.set_manoeuvre(advice.manoeuvre);
  message.set_how(advice.how);
  message.set_duration_s(advice.duration_s);
  message.set_expected_nats(advice.expected_nats);
  for (const ExpectedBounds& expected : advice.expected) {
    proto::ExpectedBounds& item = *message.add_expected();
    item.set_equation(EnumCast<proto::Equation>(expected.equation));
    item.set_regressor(expected.regressor);
    item.set_unit(expected.unit);
    item.set_estimate(expected.estimate);
    item.set_half_width(expected.half_width);
    item.set_expected_half_width(expected.expected_half_width);
  }
}

void Write(const CoefficientCoverage& coverage, proto::CoefficientCoverage& message) {
  message.set_held(Saturated(coverage.tally.held));
  message.set_total(Saturated(coverage.tally.of));
  message.set_coverage(coverage.tally.Share());
  Write(coverage.Bounds(), *message.mutable_interval());
  message.set_bias_standard_errors(coverage.bias);
}

void Write(const CoverageCheck& coverage_check, const Identification& identification,
           proto::CoverageCheck& message) {
  message.set_replicates_requested(Saturated(coverage_check.replicates_requested));
  message.set_replicates_identified(Saturated(coverage_check.replicates_identified));
  message.set_seed(coverage_check.seed);
  message.set_level(coverage_check.level);
  for (std::size_t i = 0; i < coverage_check.coefficients.size(); ++i) {
    proto::CoefficientCoverage& item = *message.add_coefficients();
    item.set_equation(EnumCast<proto::Equation>(identification.coefficients[i].equation));
    item.set_regressor(identification.coefficients[i].regressor);
    Write(coverage_check.coefficients[i], item);
  }
  if (coverage_check.thruster_time_constant) {
    Write(*coverage_check.thruster_time_constant, *message.mutable_thruster_time_constant());
  }
  message.set_joint_held(Saturated(coverage_check.joint.held));
  message.set_joint_total(Saturated(coverage_check.joint.of));
  Write(BinomialInterval(coverage_check.joint, kCoverageLevel), *message.mutable_joint_interval());
  message.set_mean_coverage(coverage_check.mean_coverage);
  message.set_mean_coverage_error(coverage_check.mean_coverage_error);
  message.set_truth_is_reported_model(coverage_check.truth_is_reported_model);
}

// ---- from Protobuf ------------------------------------------------------------------------------

Equation ReadEquation(FieldReader& reader, proto::Equation equation) {
  if (equation < proto::SURGE || equation > proto::YAW) {
    reader.Fail("equation", std::to_string(static_cast<int>(equation)), "one of SURGE, SWAY, YAW");
    return Equation::kSurge;
  }
  return static_cast<Equation>(static_cast<int>(equation));
}

std::size_t ReadRegressor(FieldReader& reader, const std::string& name,
                          std::span<const Regressor> regressors) {
  for (std::size_t j = 0; j < regressors.size(); ++j) {
    if (regressors[j].name == name) return j;
  }
  reader.Fail("regressor", '"' + name + '"', "a regressor of this equation");
  return 0;
}

ExcitationSummary ReadExcitation(FieldReader reader, const proto::Excitation& message,
                                 Parameterization parameterization) {
  ExcitationSummary summary;
  summary.equation = ReadEquation(reader, message.equation());
  const auto regressors = Regressors(summary.equation, parameterization);
  summary.condition = reader.Number("condition", {1.0, kNotNegative.high});
  summary.variance_inflation.assign(regressors.size(), std::numeric_limits<double>::infinity());
  for (int i = 0; i < message.variance_inflation_size(); ++i) {
    FieldReader item = reader.Item("variance_inflation", i);
    const auto at = ReadRegressor(item, message.variance_inflation(i).regressor(), regressors);
    summary.variance_inflation[at] = item.Number("factor", kNotNegative);
  }
  for (int i = 0; i < message.least_separable_size(); ++i) {
    FieldReader item = reader.Item("least_separable", i);
    const auto at = ReadRegressor(item, message.least_separable(i).regressor(), regressors);
    summary.least_separable.push_back({at, item.Number("weight", {-1.0, 1.0})});
  }
  summary.rows = message.rows();
  summary.effective_rows = reader.Number("effective_rows", kFiniteNotNegative);
  return summary;
}

ManoeuvreAdvice ReadAdvice(FieldReader reader, const proto::ManoeuvreAdvice& message) {
  ManoeuvreAdvice advice;
  advice.manoeuvre = message.manoeuvre();
  advice.how = message.how();
  advice.duration_s = reader.Number("duration_s", kFiniteNotNegative);
  advice.expected_nats = reader.Number("expected_nats", kFinite);
  for (int i = 0; i < message.expected_size(); ++i) {
    FieldReader item = reader.Item("expected", i);
    const proto::ExpectedBounds& expected = message.expected(i);
    advice.expected.push_back({ReadEquation(item, expected.equation()), expected.regressor(),
                               expected.unit(), item.Number("estimate", kFinite),
                               item.Number("half_width", kNotNegative),
                               item.Number("expected_half_width", kNotNegative)});
  }
  return advice;
}

Tally ReadTally(FieldReader& reader, const char* field, std::uint32_t held, std::uint32_t total) {
  if (held > total) {
    reader.Fail(field, std::to_string(held), "not above the total of " + std::to_string(total));
    return {};
  }
  return {held, total};
}

CoefficientCoverage ReadCoverage(FieldReader reader, const proto::CoefficientCoverage& message) {
  return {ReadTally(reader, "held", message.held(), message.total()),
          reader.Number("bias_standard_errors", kFinite)};
}

CoverageCheck ReadCoverageCheck(FieldReader reader, const proto::CoverageCheck& message,
                                const Identification& identification) {
  CoverageCheck coverage_check;
  const Tally answered = ReadTally(reader, "replicates_identified", message.replicates_identified(), message.replicates_requested());
  coverage_check.replicates_requested = answered.of;
  coverage_check.replicates_identified = answered.held;
  coverage_check.seed = message.seed();
  coverage_check.level = reader.Number("level", kShare);
  const std::size_t expected = identification.coefficients.size();
  if (static_cast<std::size_t>(message.coefficients_size()) != expected) {
    reader.Fail("coefficients", std::to_string(message.coefficients_size()) + " entries",
                std::to_string(expected) + ", one for each of the model's");
  }
  for (int i = 0; i < message.coefficients_size(); ++i) {
    coverage_check.coefficients.push_back(
        ReadCoverage(reader.Item("coefficients", i), message.coefficients(i)));
  }
  if (message.has_thruster_time_constant()) {
    coverage_check.thruster_time_constant =
        ReadCoverage(reader.Optional("thruster_time_constant"), message.thruster_time_constant());
  }
  coverage_check.joint =
      ReadTally(reader, "joint_held", message.joint_held(), message.joint_total());
  coverage_check.mean_coverage = reader.Number("mean_coverage", kShare);
  coverage_check.mean_coverage_error = reader.Number("mean_coverage_error", kFiniteNotNegative);
  coverage_check.truth_is_reported_model = message.truth_is_reported_model();
  return coverage_check;
}

}  // namespace

void WriteIdentifiability(const Identification& identification, proto::Model& message) {
  for (const ExcitationSummary& summary : identification.excitation) {
    Write(summary, identification.parameterization, *message.add_excitation());
  }
  for (const ManoeuvreAdvice& advice : identification.advice) Write(advice, *message.add_advice());
  if (identification.coverage_check) {
    Write(*identification.coverage_check, identification, *message.mutable_coverage_check());
  }
}

void ReadIdentifiability(FieldReader& reader, const proto::Model& message,
                         Identification& identification) {
  for (int i = 0; i < message.excitation_size(); ++i) {
    identification.excitation.push_back(ReadExcitation(
        reader.Item("excitation", i), message.excitation(i), identification.parameterization));
  }
  for (int i = 0; i < message.advice_size(); ++i) {
    identification.advice.push_back(ReadAdvice(reader.Item("advice", i), message.advice(i)));
  }
  if (message.has_coverage_check()) {
    identification.coverage_check = ReadCoverageCheck(reader.Optional("coverage_check"),
                                                      message.coverage_check(), identification);
  }
}

}  // namespace telltale
