#include "telltale/idl/codec/json/coverage_check.hpp"

#include <string>

#include "telltale/idl/codec/json/coefficient.hpp"
#include "telltale/idl/codec/json/proto_values.hpp"

namespace telltale {
namespace {

void Write(const CoefficientCoverage& coverage, proto::CoefficientCoverage& message) {
  message.set_held(Saturated(coverage.tally.held));
  message.set_total(Saturated(coverage.tally.of));
  message.set_coverage(coverage.tally.Share());
  Write(coverage.Bounds(), *message.mutable_interval());
  message.set_bias_standard_errors(coverage.bias);
}

Tally ReadHeld(FieldReader& reader, const char* field, std::uint32_t held, std::uint32_t total) {
  if (held > total) {
    reader.Fail(field, std::to_string(held), "not above the total of " + std::to_string(total));
    return {};
  }
  return {held, total};
}

CoefficientCoverage ReadCoverage(FieldReader reader, const proto::CoefficientCoverage& message) {
  return {ReadHeld(reader, "held", message.held(), message.total()),
          reader.Number("bias_standard_errors", kFinite)};
}

}  // namespace

proto::CoverageCheck ToProto(const CoverageCheck& coverage_check,
                             const std::vector<Coefficient>& coefficients) {
  proto::CoverageCheck message;
  message.set_replicates_requested(Saturated(coverage_check.replicates_requested));
  message.set_replicates_identified(Saturated(coverage_check.replicates_identified));
  message.set_seed(coverage_check.seed);
  message.set_level(coverage_check.level);
  for (std::size_t i = 0; i < coverage_check.coefficients.size(); ++i) {
    proto::CoefficientCoverage& item = *message.add_coefficients();
    item.set_equation(EnumCast<proto::Equation>(coefficients[i].equation));
    item.set_regressor(coefficients[i].regressor);
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
  return message;
}

CoverageCheck ReadCoverageCheck(FieldReader reader, const proto::CoverageCheck& message,
                                std::size_t coefficients) {
  CoverageCheck coverage_check;
  const Tally identified =
      ReadHeld(reader, "replicates_identified", message.replicates_identified(),
               message.replicates_requested());
  coverage_check.replicates_requested = identified.of;
  coverage_check.replicates_identified = identified.held;
  coverage_check.seed = message.seed();
  coverage_check.level = reader.Number("level", kShare);
  if (static_cast<std::size_t>(message.coefficients_size()) != coefficients) {
    reader.Fail("coefficients", std::to_string(message.coefficients_size()) + " entries",
                std::to_string(coefficients) + ", one for each of the model's");
  }
  coverage_check.coefficients =
      ReadAll(reader, "coefficients", message.coefficients(), ReadCoverage);
  if (message.has_thruster_time_constant()) {
    coverage_check.thruster_time_constant =
        ReadCoverage(reader.Optional("thruster_time_constant"), message.thruster_time_constant());
  }
  coverage_check.joint =
      ReadHeld(reader, "joint_held", message.joint_held(), message.joint_total());
  coverage_check.mean_coverage = reader.Number("mean_coverage", kShare);
  coverage_check.mean_coverage_error = reader.Number("mean_coverage_error", kFiniteNotNegative);
  coverage_check.truth_is_reported_model = message.truth_is_reported_model();
  return coverage_check;
}

}  // namespace telltale
