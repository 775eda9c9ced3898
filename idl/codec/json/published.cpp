#include "telltale/idl/codec/json/published.hpp"

#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/json/report.hpp"

namespace telltale {

proto::Model ToProto(const PublishedModel& model) {
  proto::Model message = ToProto(model.identification);
  proto::Provenance& provenance = *message.mutable_provenance();
  provenance.set_revision(model.revision);
  provenance.set_published_unix_s(model.published_unix_s);
  if (model.promotion.verdict != PromotionVerdict::kUnknown) {
    provenance.set_verdict(std::string(Name(model.promotion.verdict)));
    provenance.set_verdict_reason(model.promotion.reason);
  }
  return message;
}

proto::Report ToProto(const PublishedDiagnosis& diagnosis) {
  proto::Report message = ToProto(diagnosis.diagnosis);
  message.set_model_revision(diagnosis.model_revision);
  message.set_published_unix_s(diagnosis.published_unix_s);
  return message;
}

std::string PrintModelJson(const PublishedModel& model) {
  return PrintJsonMessage(ToProto(model));
}

std::string PrintReportJson(const PublishedDiagnosis& diagnosis) {
  return PrintJsonMessage(ToProto(diagnosis));
}

}  // namespace telltale
