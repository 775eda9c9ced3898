#include "telltale/idl/codec/json/model_change.hpp"

#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/proto_values.hpp"

namespace telltale {
namespace {

CoefficientChange ReadCoefficientChange(FieldReader reader,
                                        const proto::CoefficientChange& message) {
  if (!proto::Equation_IsValid(message.equation())) {
    reader.Fail(
        "equation", std::to_string(static_cast<int>(message.equation())),
        "one of SURGE, SWAY, YAW, or unset for the thruster time constant and parameters of "
        "the physical form");
  }
  return {EnumCast<Equation>(message.equation()),
          message.regressor(),
          message.symbol(),
          reader.Number("difference", kFinite),
          reader.Number("standard_error", kFinitePositive),
          reader.Number("p_value", kShare)};
}

}  // namespace

proto::ModelChange ToProto(const ModelChange& change) {
  proto::ModelChange message;
  message.set_revision(change.revision);
  message.set_verdict(EnumCast<proto::ChangeVerdict>(change.verdict));
  message.set_p_value(change.p_value);
  message.set_statistic(change.statistic);
  message.set_degrees_of_freedom(static_cast<std::uint32_t>(change.degrees_of_freedom));
  message.set_reason(change.reason);
  for (const CoefficientChange& c : change.coefficients) {
    proto::CoefficientChange& item = *message.add_coefficients();
    item.set_equation(EnumCast<proto::Equation>(c.equation));
    item.set_regressor(c.regressor);
    item.set_symbol(c.symbol);
    item.set_difference(c.difference);
    item.set_standard_error(c.standard_error);
    item.set_p_value(c.p_value);
  }
  return message;
}

ModelChange ReadModelChange(FieldReader reader, const proto::ModelChange& message) {
  ModelChange change;
  change.revision = message.revision();
  if (message.verdict() == proto::UNKNOWN_CHANGE ||
      !proto::ChangeVerdict_IsValid(message.verdict())) {
    reader.Fail("verdict", "", "one of ALIKE, DIFFERS, CANNOT_TELL");
  }
  change.verdict = EnumCast<ChangeVerdict>(message.verdict());
  change.p_value = reader.Number("p_value", kShare);
  change.statistic = reader.Number("statistic", kFiniteNotNegative);
  change.degrees_of_freedom = message.degrees_of_freedom();
  change.reason = message.reason();
  for (int i = 0; i < message.coefficients_size(); ++i) {
    change.coefficients.push_back(
        ReadCoefficientChange(reader.Item("coefficients", i), message.coefficients(i)));
  }
  return change;
}

std::string PrintChangeJson(const ModelChange& change) {
  return PrintJsonMessage(ToProto(change));
}

}  // namespace telltale
