#include "telltale/client/cli/published_model_json.hpp"

#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/model.hpp"

namespace telltale {

std::string PrintModelJson(const PublishedModel& model) {
  proto::Model message = ToProto(model.identification);
  message.mutable_provenance()->set_revision(model.revision);
  message.mutable_provenance()->set_published_unix_s(model.published_unix_s);
  return PrintJsonMessage(message);
}

}  // namespace telltale
