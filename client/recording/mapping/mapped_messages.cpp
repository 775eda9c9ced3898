#include "telltale/client/recording/mapping/mapped_messages.hpp"

#include <utility>

#include <nlohmann/json.hpp>

#include "telltale/client/recording/field_path.hpp"

namespace telltale {
namespace {

using JsonValue = nlohmann::json;

constexpr std::size_t kMostTopics = 20;  // told of a recording in which a channel is missing

double Seconds(std::int64_t ns) {
  return 1e-9 * static_cast<double>(ns);
}

/// What stands at "message.servos[2]"; null where the path leads nowhere.
const JsonValue* ValueAt(const JsonValue& root, std::string_view path) {
  const auto steps = StepsOf(path);
  if (!steps) return nullptr;
  const JsonValue* value = &root;
  for (const PathStep& step : *steps) {
    if (!step.name.empty()) {
      if (!value->is_object()) return nullptr;
      const auto found = value->find(std::string(step.name));
      if (found == value->end()) return nullptr;
      value = &*found;
    }
    if (!step.index) continue;
    if (!value->is_array() || *step.index >= value->size()) return nullptr;
    value = &(*value)[*step.index];
  }
  return value;
}

class JsonFields : public MessageFields {
 public:
  explicit JsonFields(const JsonValue& root) : root_(root) {}

  std::optional<double> Number(std::string_view path) const override {
    const JsonValue* value = ValueAt(root_, path);
    if (value == nullptr || !value->is_number()) return std::nullopt;
    return value->get<double>();
  }

 private:
  const JsonValue& root_;
};

}  // namespace

MappedMessages::MappedMessages(std::shared_ptr<const Mapping> mapping, std::size_t most_bytes)
    : mapping_(std::move(mapping)), recording_(*mapping_, most_bytes) {}

bool MappedMessages::Names(std::string_view topic) {
  if (recording_.Names(topic)) return true;
  const bool is_new = other_topics_.size() < kMostTopics && !other_topics_.contains(topic);
  if (is_new) other_topics_.emplace(topic);
  return false;
}

MessageTaker MappedMessages::OpenRos(const RosChannel& channel, CdrReader::Encoding encoding) {
  if (!Names(channel.topic)) return nullptr;
  const RosMessageType* const known = types_.Find(channel.type, channel.definition, encoding);
  if (known == nullptr) return nullptr;
  return [this, topic = std::string(channel.topic), known, encoding](
             std::int64_t received_ns, std::span<const std::uint8_t> message) {
    recording_.Take(topic, Seconds(received_ns), RosFields(*known, message, encoding));
  };
}

MessageTaker MappedMessages::OpenJson(std::string_view topic) {
  if (!Names(topic)) return nullptr;
  return [this, topic = std::string(topic)](std::int64_t received_ns,
                                            std::span<const std::uint8_t> message) {
    const JsonValue root = JsonValue::parse(message.begin(), message.end(), nullptr, false);
    if (root.is_discarded()) {
      ++unreadable_;
    } else {
      recording_.Take(topic, Seconds(received_ns), JsonFields(root));
    }
  };
}

SourceLog MappedMessages::Finish() && {
  SourceLog log = std::move(recording_).Finish("messages");
  for (const std::string& name : types_.Unknown()) {
    log.summary += "; the recording does not define " + name;
  }
  if (!log.Lacks().empty() && !other_topics_.empty()) {
    log.summary += "; topics that it does not name:";
    for (const std::string& topic : other_topics_) log.summary += ' ' + topic;
  }
  if (unreadable_ > 0) log.summary += "; " + std::to_string(unreadable_) + " are no JSON";
  return log;
}

}  // namespace telltale
