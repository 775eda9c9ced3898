#include "telltale/idl/codec/wire/quality.hpp"

#include "telltale/idl/codec/wire/choices.hpp"
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

void FillReason(telltale_wire_QualityReason& wire, const QualityReason& reason) {
  Put(wire.code, reason.code);
  Put(wire.verdict, Name(reason.verdict));
  Put(wire.text, reason.text);
}

QualityReason ReadReason(const std::string& field, const telltale_wire_QualityReason& wire) {
  return {TextOf(wire.code), ReadName(field + ".verdict", View(wire.verdict), kQualityVerdicts),
          TextOf(wire.text)};
}

void FillPosition(telltale_wire_Position& wire, const QualityPosition& position) {
  wire.latitude_deg = position.latitude_deg;
  wire.longitude_deg = position.longitude_deg;
  wire.has_heading = position.heading_deg.has_value();
  wire.heading_deg = position.heading_deg.value_or(0.0);
}

QualityPosition ReadPosition(const std::string& field, const telltale_wire_Position& wire) {
  QualityPosition position;
  position.latitude_deg = ReadWithin(field + ".latitude_deg", wire.latitude_deg, {-90.0, 90.0});
  position.longitude_deg =
      ReadWithin(field + ".longitude_deg", wire.longitude_deg, {-180.0, 180.0});
  if (wire.has_heading) {
    position.heading_deg = ReadWithin(field + ".heading_deg", wire.heading_deg, {-360.0, 720.0});
  }
  return position;
}

void FillDelay(telltale_wire_ChannelDelay& wire, const ChannelDelay& delay) {
  Put(wire.channel, Name(delay.channel));
  wire.estimate_s = delay.estimate_s;
  wire.lower_s = delay.lower_s;
  wire.upper_s = delay.upper_s;
}

ChannelDelay ReadDelay(const std::string& field, const telltale_wire_ChannelDelay& wire) {
  return {ReadName(field + ".channel", View(wire.channel), kChannels),
          ReadWithin(field + ".estimate_s", wire.estimate_s, kFinite),
          ReadWithin(field + ".lower_s", wire.lower_s, kFinite),
          ReadWithin(field + ".upper_s", wire.upper_s, kFinite)};
}

/// What the verdict rests on besides the counts: fields that older writers lack.
void ReadAssessment(const telltale_wire_Quality& wire, Quality& quality) {
  quality.verdict = ReadOptionalName("verdict", View(wire.verdict), kQualityVerdicts);
  quality.verdict_since_unix_s =
      ReadWithin("verdict_since_unix_s", wire.verdict_since_unix_s, kFinite);
  quality.reasons = ReadSequence("reasons", wire.reasons, ReadReason);
  quality.silent_s = ReadWithin("silent_s", wire.silent_s, kFiniteNotNegative);
  quality.loss_share = ReadWithin("loss_share", wire.loss_share, kShare);
  quality.reject_share = ReadWithin("reject_share", wire.reject_share, kShare);
  quality.drift_since_unix_s = ReadWithin("drift_since_unix_s", wire.drift_since_unix_s, kFinite);
  quality.coefficients = wire.coefficients;
  quality.identified = wire.identified;
  quality.relative_half_width =
      ReadWithin("relative_half_width", wire.relative_half_width, kFiniteNotNegative);
  quality.last_refusal = ReadOptional("last_refusal", wire.last_refusal, ReadRefusal);
  quality.diagnosis_verdict = View(wire.diagnosis_verdict);
  quality.diagnosis_sentence = View(wire.diagnosis_sentence);
  quality.diagnosed_unix_s = ReadWithin("diagnosed_unix_s", wire.diagnosed_unix_s, kFinite);
  quality.position = ReadOptional("position", wire.position, ReadPosition);
  quality.model_verdict = {
      ReadOptionalName("model_verdict", View(wire.model_verdict), kPromotionVerdicts),
      TextOf(wire.model_verdict_reason)};
  quality.delays = ReadSequence("delays", wire.delays, ReadDelay);
  quality.shed = {wire.gnss_shed, wire.heading_shed, wire.thrusters_shed};
  quality.shed_share = ReadWithin("shed_share", wire.shed_share, kShare);
  quality.window_bytes = wire.window_bytes;
  quality.drift_evidence = View(wire.drift_evidence);
  quality.drift_untested = View(wire.drift_untested);
}

void FillAssessment(telltale_wire_Quality& wire, const Quality& quality) {
  Put(wire.verdict, Name(quality.verdict));
  wire.verdict_since_unix_s = quality.verdict_since_unix_s;
  PutSequence(wire.reasons, quality.reasons, FillReason);
  wire.silent_s = quality.silent_s;
  wire.loss_share = quality.loss_share;
  wire.reject_share = quality.reject_share;
  wire.drift_since_unix_s = quality.drift_since_unix_s;
  wire.coefficients = quality.coefficients;
  wire.identified = quality.identified;
  wire.relative_half_width = quality.relative_half_width;
  PutOptional(wire.last_refusal, quality.last_refusal, FillRefusal);
  Put(wire.diagnosis_verdict, quality.diagnosis_verdict);
  Put(wire.diagnosis_sentence, quality.diagnosis_sentence);
  wire.diagnosed_unix_s = quality.diagnosed_unix_s;
  PutOptional(wire.position, quality.position, FillPosition);
  PutVerdict(wire.model_verdict, quality.model_verdict.verdict);
  Put(wire.model_verdict_reason, quality.model_verdict.reason);
  PutSequence(wire.delays, quality.delays, FillDelay);
  wire.gnss_shed = quality.shed[static_cast<std::size_t>(Channel::kGnss)];
  wire.heading_shed = quality.shed[static_cast<std::size_t>(Channel::kHeading)];
  wire.thrusters_shed = quality.shed[static_cast<std::size_t>(Channel::kThrusters)];
  wire.shed_share = quality.shed_share;
  wire.window_bytes = quality.window_bytes;
  Put(wire.drift_evidence, quality.drift_evidence);
  Put(wire.drift_untested, quality.drift_untested);
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
  ReadAssessment(wire, quality);
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
  FillAssessment(wire, quality);
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
