#include "telltale/service/monitoring/fleet_json.hpp"

#include <limits>

#include "telltale/idl/codec/json/proto_values.hpp"
#include "telltale/idl/codec/json/provenance.hpp"
#include "telltale/idl/codec/json/quality.hpp"

namespace telltale {

proto::VehicleSummary SummaryOf(const Quality& quality) {
  proto::VehicleSummary summary;
  summary.set_vehicle_id(quality.vehicle_id);
  summary.set_verdict(EnumCast<proto::Quality::Verdict>(quality.verdict));
  summary.set_verdict_since_unix_s(quality.verdict_since_unix_s);
  if (!quality.reasons.empty()) summary.set_reason(quality.reasons.front().text);
  summary.set_window_fill(quality.window_fill);
  summary.set_loss_share(quality.loss_share);
  summary.set_reject_share(quality.reject_share);
  summary.set_model_revision(Saturated(quality.model_revision.value_or(0)));
  summary.set_model_age_s(quality.model_age_s);
  summary.set_prediction_error(quality.prediction_error);
  summary.set_drifts(quality.drift_since_unix_s > 0.0);
  if (quality.position) *summary.mutable_position() = ToProto(*quality.position);
  return summary;
}

proto::Job ToProto(const JobView& job) {
  proto::Job message;
  message.set_id(job.id);
  message.set_vehicle_id(job.vehicle_id);
  message.set_kind(EnumCast<proto::Job::Kind>(job.kind));
  message.set_state(EnumCast<proto::Job::State>(job.state));
  message.set_stage(job.stage);
  message.set_fraction(job.fraction);
  message.set_message(job.message);
  for (const Refusal& refusal : job.refusals) *message.add_refusals() = ToProto(refusal);
  message.set_revision(Saturated(job.revision));
  return message;
}

proto::DiagnosisList ToProto(std::span<const PublishedDiagnosis> diagnoses) {
  proto::DiagnosisList list;
  for (const auto& [diagnosis, model_revision, published_unix_s] : diagnoses) {
    proto::DiagnosisList::Entry& entry = *list.add_diagnoses();
    entry.set_published_unix_s(published_unix_s);
    entry.set_model_revision(Saturated(model_revision));
    entry.set_verdict(EnumCast<proto::DiagnosisVerdict>(diagnosis.verdict));
    entry.set_sentence(diagnosis.sentence);
  }
  return list;
}

proto::History ToProto(std::span<const PastPoint> past) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  proto::History message;
  for (const PastPoint& point : past) {
    message.add_time_unix_s(point.time_unix_s);
    message.add_prediction_error(point.prediction_error);
    message.add_latitude_deg(point.position ? point.position->latitude_deg : kUnknown);
    message.add_longitude_deg(point.position ? point.position->longitude_deg : kUnknown);
  }
  return message;
}

}  // namespace telltale
