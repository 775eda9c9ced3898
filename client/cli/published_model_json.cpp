#include "telltale/client/cli/published_model_json.hpp"

#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/model.hpp"

namespace telltale {

std::string PrintModelJson(const PublishedModel& model) {
  proto::Model message = ToProto(model.identification);
  message.mutable_provenance()->set_revision(model.revision);
  message.mutable_provenance()->set_published_unix_s(model.published_unix_s);
  if (model.promotion.verdict != PromotionVerdict::kUnknown) {
    message.mutable_provenance()->set_verdict(std::string(Name(model.promotion.verdict)));
    message.mutable_provenance()->set_verdict_reason(model.promotion.reason);
  }
  return PrintJsonMessage(message);
}

}  // namespace telltale
