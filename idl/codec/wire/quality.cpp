#include "telltale/idl/codec/wire/quality.hpp"

#include "telltale/idl/codec/wire/nested.hpp"
#include "telltale/idl/codec/wire/put.hpp"
#include "telltale/idl/codec/wire/read.hpp"

namespace telltale {
namespace wire {
namespace {

void FillIndicative(telltale_wire_IndicativeCoefficient& wire,
                    const IndicativeCoefficient& coefficient) {
  Put(wire.equation, Name(coefficient.equation));
  Put(wire.regressor, coefficient.regressor);
  Put(wire.symbol, coefficient.symbol);
  wire.estimate = coefficient.estimate;
  wire.standard_error = coefficient.standard_error;
  Put(wire.unit, coefficient.unit);
}

IndicativeCoefficient ReadIndicative(const std::string& field,
                                     const telltale_wire_IndicativeCoefficient& wire) {
  return {ReadName(field + ".equation", View(wire.equation), kEquations),
          TextOf(wire.regressor),
          TextOf(wire.symbol),
          ReadWithin(field + ".estimate", wire.estimate, kFinite),
          ReadWithin(field + ".standard_error", wire.standard_error, kFiniteNotNegative),
          TextOf(wire.unit)};
}

Quality ReadQuality(const telltale_wire_Quality& wire) {
  Quality quality;
  quality.vehicle_id = View(wire.vehicle_id) == kUnattributed
                           ? std::string(kUnattributed)
                           : ReadIdentifier("vehicle_id", wire.vehicle_id);
  quality.sequence_number = wire.sequence_number;
  quality.window_s = ReadWithin("window_s", wire.window_s, kFiniteNotNegative);
  quality.window_fill = ReadWithin("window_fill", wire.window_fill, kShare);
  quality.gnss_rate_hz = ReadWithin("gnss_rate_hz", wire.gnss_rate_hz, kFiniteNotNegative);
  quality.heading_rate_hz = ReadWithin("heading_rate_hz", wire.heading_rate_hz, kFiniteNotNegative);
  quality.thrusters_rate_hz =
      ReadWithin("thrusters_rate_hz", wire.thrusters_rate_hz, kFiniteNotNegative);
  quality.lost = wire.lost;
  quality.accepted = wire.accepted;
  quality.rejected = ReadSequence("rejected", wire.rejected, ReadRejectEntry);
  if (wire.has_model) quality.model_revision = wire.model_revision;
  quality.model_age_s = ReadWithin("model_age_s", wire.model_age_s, kFinite);
  quality.prediction_error =
      ReadWithin("prediction_error", wire.prediction_error, kFiniteNotNegative);
  quality.drift = ReadWithin("drift", wire.drift, kFinite);
  quality.indicative = ReadSequence("indicative", wire.indicative, ReadIndicative);
  quality.indicative_rows = wire.indicative_rows;
  quality.proposal = View(wire.proposal);
  return quality;
}

void FillQuality(telltale_wire_Quality& wire, const Quality& quality) {
  if (quality.vehicle_id == kUnattributed) {
    Put(wire.vehicle_id, kUnattributed);
  } else {
    PutIdentifier(wire.vehicle_id, quality.vehicle_id);
  }
  wire.sequence_number = quality.sequence_number;
  wire.window_s = quality.window_s;
  wire.window_fill = quality.window_fill;
  wire.gnss_rate_hz = quality.gnss_rate_hz;
  wire.heading_rate_hz = quality.heading_rate_hz;
  wire.thrusters_rate_hz = quality.thrusters_rate_hz;
  wire.lost = quality.lost;
  wire.accepted = quality.accepted;
  PutSequence(wire.rejected, quality.rejected, FillRejectCount);
  wire.has_model = quality.model_revision.has_value();
  wire.model_revision = quality.model_revision.value_or(0);
  wire.model_age_s = quality.model_age_s;
  wire.prediction_error = quality.prediction_error;
  wire.drift = quality.drift;
  PutSequence(wire.indicative, quality.indicative, FillIndicative);
  wire.indicative_rows = quality.indicative_rows;
  Put(wire.proposal, quality.proposal);
}

}  // namespace
}  // namespace wire

WireSample<telltale_wire_Quality> Encode(const Quality& quality) {
  WireSample<telltale_wire_Quality> sample;
  wire::FillQuality(*sample, quality);
  return sample;
}

Decoded<Quality> Decode(const telltale_wire_Quality& wire) {
  return wire::Guarded([&] { return wire::ReadQuality(wire); });
}

}  // namespace telltale
