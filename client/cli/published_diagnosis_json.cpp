#include "telltale/client/cli/published_diagnosis_json.hpp"

#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/report.hpp"

namespace telltale {

std::string PrintReportJson(const PublishedDiagnosis& diagnosis) {
  proto::Report message = ToProto(diagnosis.diagnosis);
  message.set_model_revision(diagnosis.model_revision);
  message.set_published_unix_s(diagnosis.published_unix_s);
  return PrintJsonMessage(message);
}

}  // namespace telltale
