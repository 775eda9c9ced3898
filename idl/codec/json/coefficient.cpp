#include "telltale/idl/codec/json/coefficient.hpp"

#include "telltale/idl/codec/json/proto_values.hpp"
#include "telltale/idl/codec/model_rules.hpp"

namespace telltale {
namespace {

Interval ReadBounds(FieldReader reader) {
  const Interval interval{reader.Number("level", kIntervalLevel), reader.Number("lower", kNotNan),
                          reader.Number("upper", kNotNan)};
  if (interval.lower > interval.upper) {
    reader.Fail("lower", NumberText(interval.lower),
                "not above upper = " + NumberText(interval.upper));
  }
  return interval;
}

}  // namespace

void Write(const Interval& interval, proto::Interval& message) {
  message.set_level(interval.level);
  message.set_lower(interval.lower);
  message.set_upper(interval.upper);
}

proto::Coefficient ToProto(const Coefficient& coefficient) {
  proto::Coefficient message;
  message.set_equation(EnumCast<proto::Equation>(coefficient.equation));
  message.set_regressor(coefficient.regressor);
  message.set_symbol(coefficient.symbol);
  message.set_estimate(coefficient.estimate);
  message.set_standard_error(coefficient.standard_error);
  Write(coefficient.interval, *message.mutable_interval());
  message.set_unit(coefficient.unit);
  message.set_status(EnumCast<proto::CoefficientStatus>(coefficient.status));
  return message;
}

Coefficient ReadCoefficient(FieldReader reader, const proto::Coefficient& message) {
  Coefficient coefficient;
  coefficient.equation = EnumCast<Equation>(message.equation());
  coefficient.regressor = message.regressor();
  coefficient.symbol = message.symbol();
  coefficient.estimate = reader.Number("estimate", kFinite);
  coefficient.standard_error = reader.Number("standard_error", kNotNegative);
  coefficient.interval = ReadBounds(reader.Required("interval"));
  coefficient.unit = message.unit();
  coefficient.status = ReadEnum<CoefficientStatus>(reader, "status", message.status());
  return coefficient;
}

}  // namespace telltale
