#include "telltale/idl/codec/json/manoeuvre_advice.hpp"

#include "telltale/idl/codec/json/proto_values.hpp"

namespace telltale {
namespace {

ExpectedBounds ReadExpectedBounds(FieldReader reader, const proto::ExpectedBounds& message) {
  return {ReadEnum<Equation>(reader, "equation", message.equation()),
          message.regressor(),
          message.unit(),
          reader.Number("estimate", kFinite),
          reader.Number("half_width", kNotNegative),
          reader.Number("expected_half_width", kNotNegative)};
}

}  // namespace

proto::ManoeuvreAdvice ToProto(const ManoeuvreAdvice& advice) {
  proto::ManoeuvreAdvice message;
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
  return message;
}

ManoeuvreAdvice ReadManoeuvreAdvice(FieldReader reader, const proto::ManoeuvreAdvice& message) {
  return {message.manoeuvre(), message.how(), reader.Number("duration_s", kFiniteNotNegative),
          reader.Number("expected_nats", kFinite),
          ReadAll(reader, "expected", message.expected(), ReadExpectedBounds)};
}

}  // namespace telltale
