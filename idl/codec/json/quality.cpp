#include "telltale/idl/codec/json/quality.hpp"

#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/proto_values.hpp"
#include "telltale/idl/codec/json/provenance.hpp"

namespace telltale {
namespace {

void WriteReasons(const Quality& quality, proto::Quality& message) {
  for (const QualityReason& reason : quality.reasons) {
    proto::Quality::Reason& to = *message.add_reasons();
    to.set_code(reason.code);
    to.set_verdict(EnumCast<proto::Quality::Verdict>(reason.verdict));
    to.set_text(reason.text);
  }
}

void WriteTelemetry(const Quality& quality, proto::Quality& message) {
  message.set_silent_s(quality.silent_s);
  message.set_window_s(quality.window_s);
  message.set_window_fill(quality.window_fill);
  message.mutable_rates_hz()->set_gnss(quality.gnss_rate_hz);
  message.mutable_rates_hz()->set_heading(quality.heading_rate_hz);
  message.mutable_rates_hz()->set_thrusters(quality.thrusters_rate_hz);
  message.set_accepted(Saturated(quality.accepted));
  message.set_lost(Saturated(quality.lost));
  message.set_loss_share(quality.loss_share);
  message.set_reject_share(quality.reject_share);
  const auto& [gnss, heading, thrusters] = quality.shed;
  message.mutable_shed()->set_gnss(Saturated(gnss));
  message.mutable_shed()->set_heading(Saturated(heading));
  message.mutable_shed()->set_thrusters(Saturated(thrusters));
  message.set_shed_share(quality.shed_share);
  message.set_window_bytes(static_cast<double>(quality.window_bytes));
  for (const RejectEntry& entry : quality.rejected) {
    proto::Quality::Rejected& to = *message.add_rejected();
    to.set_channel(entry.channel);
    to.set_reason(entry.reason);
    to.set_count(Saturated(entry.count));
  }
}

void WriteModelState(const Quality& quality, proto::Quality::ModelState& model) {
  model.set_revision(Saturated(*quality.model_revision));
  model.set_age_s(quality.model_age_s);
  model.set_prediction_error(quality.prediction_error);
  model.set_drift(quality.drift);
  model.set_drift_since_unix_s(quality.drift_since_unix_s);
  model.set_drift_evidence(quality.drift_evidence);
  model.set_drift_untested(quality.drift_untested);
  model.set_coefficients(quality.coefficients);
  model.set_identified(quality.identified);
  model.set_relative_half_width(quality.relative_half_width);
  if (quality.model_verdict.verdict != PromotionVerdict::kUnknown) {
    model.set_verdict(std::string(Name(quality.model_verdict.verdict)));
    model.set_verdict_reason(quality.model_verdict.reason);
  }
  for (const ChannelDelay& delay : quality.delays) {
    proto::Quality::Delay& to = *model.add_delays();
    to.set_channel(std::string(Name(delay.channel)));
    to.set_estimate_s(delay.estimate_s);
    to.set_lower_s(delay.lower_s);
    to.set_upper_s(delay.upper_s);
  }
}

void WriteIndicative(const Quality& quality, proto::Quality& message) {
  for (const IndicativeCoefficient& coefficient : quality.indicative) {
    proto::Quality::Indicative& to = *message.add_indicative();
    to.set_equation(EnumCast<proto::Equation>(coefficient.equation));
    to.set_regressor(coefficient.regressor);
    to.set_estimate(coefficient.estimate);
    to.set_standard_error(coefficient.standard_error);
    to.set_unit(coefficient.unit);
  }
}

void WriteLastAnswers(const Quality& quality, proto::Quality& message) {
  if (quality.last_refusal) *message.mutable_last_refusal() = ToProto(*quality.last_refusal);
  if (quality.diagnosis_verdict.empty()) return;
  message.mutable_diagnosis()->set_verdict(quality.diagnosis_verdict);
  message.mutable_diagnosis()->set_sentence(quality.diagnosis_sentence);
  message.mutable_diagnosis()->set_published_unix_s(quality.diagnosed_unix_s);
}

}  // namespace

proto::Quality::Position ToProto(const QualityPosition& position) {
  proto::Quality::Position message;
  message.set_latitude_deg(position.latitude_deg);
  message.set_longitude_deg(position.longitude_deg);
  if (position.heading_deg) message.set_heading_deg(*position.heading_deg);
  return message;
}

proto::Quality ToProto(const Quality& quality, double time_unix_s) {
  proto::Quality message;
  message.set_vehicle_id(quality.vehicle_id);
  message.set_time_unix_s(time_unix_s);
  message.set_verdict(EnumCast<proto::Quality::Verdict>(quality.verdict));
  message.set_verdict_since_unix_s(quality.verdict_since_unix_s);
  WriteReasons(quality, message);
  WriteTelemetry(quality, message);
  if (quality.model_revision) WriteModelState(quality, *message.mutable_model());
  WriteIndicative(quality, message);
  message.set_proposal(quality.proposal);
  WriteLastAnswers(quality, message);
  if (quality.position) *message.mutable_position() = ToProto(*quality.position);
  return message;
}

std::string PrintQualityLine(const Quality& quality, double time_unix_s) {
  return PrintJsonLine(ToProto(quality, time_unix_s));
}

}  // namespace telltale
