#include "telltale/client/recording/mcap/mcap_recording.hpp"

#include <string>
#include <string_view>
#include <utility>

#include "telltale/client/recording/mavlink/mavlink_json.hpp"
#include "telltale/client/recording/mavlink/mavlink_recording.hpp"
#include "telltale/client/recording/mcap/mcap_file.hpp"
#include "telltale/client/recording/ros_intake.hpp"

namespace telltale {
namespace {

/// "ATTITUDE" of "mavlink/1/1/ATTITUDE"; empty of any other topic.
std::string_view MavlinkTypeOf(std::string_view topic) {
  if (topic.find("mavlink/") == std::string_view::npos) return {};
  return topic.substr(topic.rfind('/') + 1);
}

/// What the messages of one file say; which of ROS 2 and BlueOS counts, the most messages of use
/// say.
class McapRecording {
 public:
  explicit McapRecording(const SourceOptions& options)
      : options_(options), ros_(options), mavlink_(options.memory_bytes) {}

  McapVisitor Visitor() {
    return {[this](const McapChannel& channel) { return Open(channel); }, options_.progress};
  }

  SourceLog Finish(const McapDamage& damage) && {
    const bool is_of_mavlink = of_mavlink_ > damage.messages - of_mavlink_;
    SourceLog log = is_of_mavlink ? std::move(mavlink_).Finish(options_) : std::move(ros_).Finish();
    if (unreadable_ > 0) log.summary += "; " + std::to_string(unreadable_) + " unreadable messages";
    log.summary += damage.Summary();
    return log;
  }

 private:
  MessageTaker Open(const McapChannel& channel) {
    if (channel.encoding == "cdr") {
      return ros_.Open({channel.topic, channel.schema, channel.definition});
    }
    if (channel.encoding == "ros1") {
      return ros_.Open({channel.topic, TypeOfRos2(channel.schema), channel.definition},
                       CdrReader::Encoding::kRos1);
    }
    const bool is_json = channel.encoding == "json";
    if (is_json && ros_.Mapped() != nullptr) return ros_.Mapped()->OpenJson(channel.topic);
    if (!is_json || !IsMavlinkMessageOfUse(MavlinkTypeOf(channel.topic))) {
      ros_.Leave(channel.topic, channel.encoding);
      return nullptr;
    }
    return [this](std::int64_t, std::span<const std::uint8_t> message) {
      ++of_mavlink_;
      if (!json_.Take(message, mavlink_)) ++unreadable_;
    };
  }

  const SourceOptions& options_;
  RosIntake ros_;
  MavlinkRecording mavlink_;
  MavlinkJson json_;
  std::uint64_t of_mavlink_ = 0;
  std::uint64_t unreadable_ = 0;
};

}  // namespace

SourceLog ParseMcap(std::span<const std::uint8_t> bytes, std::size_t block,
                    const SourceOptions& options) {
  McapRecording recording(options);
  const McapDamage damage = ForEachMcapMessage(bytes, block, recording.Visitor());
  return std::move(recording).Finish(damage);
}

Result<SourceLog> ReadMcap(const std::filesystem::path& file, const SourceOptions& options) {
  if (auto refusal = options.Validate()) return tl::unexpected(*std::move(refusal));
  McapRecording recording(options);
  const auto damage = ForEachMcapMessage(file, recording.Visitor());
  if (!damage) return tl::unexpected(damage.error());
  return std::move(recording).Finish(*damage);
}

}  // namespace telltale
