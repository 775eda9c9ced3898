#include <algorithm>

#include "telltale/idl/codec/model_rules.hpp"
#include "telltale/idl/codec/wire/nested.hpp"
#include "telltale/idl/codec/wire/put.hpp"
#include "telltale/idl/codec/wire/read.hpp"

namespace telltale::wire {
namespace {

/// Regressors go by name, since their places depend on the parameterization.
void FillExcitation(telltale_wire_Excitation& wire, const ExcitationSummary& summary,
                    Parameterization parameterization) {
  const auto regressors = Regressors(summary.equation, parameterization);
  Put(wire.equation, Name(summary.equation));
  wire.condition = summary.condition;
  PutNumbers(wire.variance_inflation, summary.variance_inflation);
  PutSequence(wire.least_separable, summary.least_separable,
              [&](telltale_wire_CombinationTerm& term, const CombinationTerm& item) {
                Put(term.regressor, regressors[item.regressor].name);
                term.weight = item.weight;
              });
  wire.rows = summary.rows;
  wire.effective_rows = summary.effective_rows;
}

void FillExpectedBounds(telltale_wire_ExpectedBounds& wire, const ExpectedBounds& expected) {
  Put(wire.equation, Name(expected.equation));
  Put(wire.regressor, expected.regressor);
  Put(wire.unit, expected.unit);
  wire.estimate = expected.estimate;
  wire.half_width = expected.half_width;
  wire.expected_half_width = expected.expected_half_width;
}

void FillAdvice(telltale_wire_ManoeuvreAdvice& wire, const ManoeuvreAdvice& advice) {
  Put(wire.manoeuvre, advice.manoeuvre);
  Put(wire.how, advice.how);
  wire.duration_s = advice.duration_s;
  wire.expected_nats = advice.expected_nats;
  PutSequence(wire.expected, advice.expected, FillExpectedBounds);
}

void FillCoverage(telltale_wire_CoefficientCoverage& wire, const CoefficientCoverage& coverage) {
  wire = {coverage.tally.held, coverage.tally.of, coverage.bias};
}

void FillCoverageCheck(telltale_wire_CoverageCheck& wire, const CoverageCheck& coverage_check) {
  wire.replicates_requested = coverage_check.replicates_requested;
  wire.replicates_identified = coverage_check.replicates_identified;
  wire.seed = coverage_check.seed;
  wire.level = coverage_check.level;
  PutSequence(wire.coefficients, coverage_check.coefficients, FillCoverage);
  PutOptional(wire.thruster_time_constant, coverage_check.thruster_time_constant, FillCoverage);
  wire.joint_held = coverage_check.joint.held;
  wire.joint_total = coverage_check.joint.of;
  wire.mean_coverage = coverage_check.mean_coverage;
  wire.mean_coverage_error = coverage_check.mean_coverage_error;
  wire.truth_is_reported_model = coverage_check.truth_is_reported_model;
}

std::vector<double> ReadVarianceInflation(const std::string& field, const dds_sequence_double& wire,
                                          std::size_t regressors) {
  if (wire._length != regressors) {
    Reject(field, std::to_string(wire._length) + " numbers",
           std::to_string(regressors) + ", one for each regressor");
  }
  return ReadSequence(field, wire, [](const std::string& name, double factor) {
    return ReadWithin(name, factor, kNotNegative);
  });
}

CombinationTerm ReadTerm(const std::string& field, const telltale_wire_CombinationTerm& wire,
                         std::span<const Regressor> regressors) {
  const std::string_view name = View(wire.regressor);
  const auto found = std::ranges::find(regressors, name, &Regressor::name);
  if (found == regressors.end()) {
    Reject(field + ".regressor", std::string(name), "a regressor of this equation");
  }
  return {static_cast<std::size_t>(found - regressors.begin()),
          ReadWithin(field + ".weight", wire.weight, kCombinationWeight)};
}

ExcitationSummary ReadExcitation(const std::string& field, const telltale_wire_Excitation& wire,
                                 Parameterization parameterization) {
  ExcitationSummary summary;
  summary.equation = ReadName(field + ".equation", View(wire.equation), kEquations);
  const auto regressors = Regressors(summary.equation, parameterization);
  summary.condition = ReadWithin(field + ".condition", wire.condition, kConditionNumber);
  summary.variance_inflation = ReadVarianceInflation(field + ".variance_inflation",
                                                     wire.variance_inflation, regressors.size());
  summary.least_separable =
      ReadSequence(field + ".least_separable", wire.least_separable,
                   [&](const std::string& name, const telltale_wire_CombinationTerm& term) {
                     return ReadTerm(name, term, regressors);
                   });
  summary.rows = wire.rows;
  summary.effective_rows =
      ReadWithin(field + ".effective_rows", wire.effective_rows, kFiniteNotNegative);
  return summary;
}

ExpectedBounds ReadExpectedBounds(const std::string& field,
                                  const telltale_wire_ExpectedBounds& wire) {
  ExpectedBounds expected;
  expected.equation = ReadName(field + ".equation", View(wire.equation), kEquations);
  expected.regressor = View(wire.regressor);
  expected.unit = View(wire.unit);
  expected.estimate = ReadWithin(field + ".estimate", wire.estimate, kFinite);
  expected.half_width = ReadWithin(field + ".half_width", wire.half_width, kNotNegative);
  expected.expected_half_width =
      ReadWithin(field + ".expected_half_width", wire.expected_half_width, kNotNegative);
  return expected;
}

ManoeuvreAdvice ReadAdvice(const std::string& field, const telltale_wire_ManoeuvreAdvice& wire) {
  ManoeuvreAdvice advice;
  advice.manoeuvre = View(wire.manoeuvre);
  advice.how = View(wire.how);
  advice.duration_s = ReadWithin(field + ".duration_s", wire.duration_s, kFiniteNotNegative);
  advice.expected_nats = ReadWithin(field + ".expected_nats", wire.expected_nats, kFinite);
  advice.expected = ReadSequence(field + ".expected", wire.expected, ReadExpectedBounds);
  return advice;
}

CoefficientCoverage ReadCoverage(const std::string& field,
                                 const telltale_wire_CoefficientCoverage& wire) {
  return {ReadTally(field + ".held", wire.held, wire.total),
          ReadWithin(field + ".bias", wire.bias, kFinite)};
}

CoverageCheck ReadCoverageCheck(const std::string& field, const telltale_wire_CoverageCheck& wire,
                                std::size_t coefficients) {
  CoverageCheck coverage_check;
  const Tally identified = ReadTally(field + ".replicates_identified", wire.replicates_identified,
                                     wire.replicates_requested);
  coverage_check.replicates_requested = identified.of;
  coverage_check.replicates_identified = identified.held;
  coverage_check.seed = wire.seed;
  coverage_check.level = ReadWithin(field + ".level", wire.level, kShare);
  if (wire.coefficients._length != coefficients) {
    Reject(field + ".coefficients", std::to_string(wire.coefficients._length) + " items",
           std::to_string(coefficients) + ", one for each coefficient");
  }
  coverage_check.coefficients =
      ReadSequence(field + ".coefficients", wire.coefficients, ReadCoverage);
  coverage_check.thruster_time_constant =
      ReadOptional(field + ".thruster_time_constant", wire.thruster_time_constant, ReadCoverage);
  coverage_check.joint = ReadTally(field + ".joint_held", wire.joint_held, wire.joint_total);
  coverage_check.mean_coverage = ReadWithin(field + ".mean_coverage", wire.mean_coverage, kShare);
  coverage_check.mean_coverage_error =
      ReadWithin(field + ".mean_coverage_error", wire.mean_coverage_error, kFiniteNotNegative);
  coverage_check.truth_is_reported_model = wire.truth_is_reported_model;
  return coverage_check;
}

}  // namespace

void FillIdentifiability(telltale_wire_Model& wire, const Identification& identification) {
  PutSequence(wire.excitation, identification.excitation,
              [&](telltale_wire_Excitation& element, const ExcitationSummary& summary) {
                FillExcitation(element, summary, identification.parameterization);
              });
  PutSequence(wire.advice, identification.advice, FillAdvice);
  PutOptional(wire.coverage_check, identification.coverage_check, FillCoverageCheck);
}

void ReadIdentifiability(const telltale_wire_Model& wire, Identification& identification) {
  identification.excitation =
      ReadSequence("excitation", wire.excitation,
                   [&](const std::string& field, const telltale_wire_Excitation& element) {
                     return ReadExcitation(field, element, identification.parameterization);
                   });
  identification.advice = ReadSequence("advice", wire.advice, ReadAdvice);
  identification.coverage_check =
      ReadOptional("coverage_check", wire.coverage_check,
                   [&](const std::string& field, const telltale_wire_CoverageCheck& element) {
                     return ReadCoverageCheck(field, element, identification.coefficients.size());
                   });
}

}  // namespace telltale::wire
