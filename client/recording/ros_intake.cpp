#include "telltale/client/recording/ros_intake.hpp"

namespace telltale {
namespace {

constexpr std::size_t kLongestMessage = std::size_t{64} << 20;
constexpr std::size_t kMostLeft = 12;  // that are named

}  // namespace

RosIntake::RosIntake(const SourceOptions& options) : by_rules_(options) {
  if (options.mapping) mapped_.emplace(options.mapping, options.memory_bytes);
}

MessageTaker RosIntake::Open(const RosChannel& channel, CdrReader::Encoding encoding) {
  MessageTaker take =
      mapped_ ? mapped_->OpenRos(channel, encoding) : by_rules_.Open(channel, encoding);
  if (!take && !mapped_) Leave(channel.topic, channel.type);
  if (!take || encoding != CdrReader::Encoding::kCdr) return take;
  return [this, take = std::move(take)](std::int64_t received_ns,
                                        std::span<const std::uint8_t> message) {
    // CDR begins with a zero.
    take(received_ns, BeginsLikeZstdFrame(message) ? Inflated(message) : message);
  };
}

void RosIntake::Leave(std::string_view topic, std::string_view what) {
  if (left_.size() < kMostLeft) left_.insert(std::string(topic) + " (" + std::string(what) + ')');
}

SourceLog RosIntake::Finish() && {
  if (mapped_) return std::move(*mapped_).Finish();
  SourceLog log = std::move(by_rules_).Finish();
  if (log.Lacks().empty() || left_.empty()) return log;
  log.summary += "; topics of no use, which a mapping may name:";
  for (const std::string& topic : left_) log.summary += ' ' + topic;
  return log;
}

/// What cannot be inflated goes on as it is, to be counted as unreadable.
std::span<const std::uint8_t> RosIntake::Inflated(std::span<const std::uint8_t> message) {
  return zstd_.InflateOfItsLength(message, kLongestMessage, inflated_) ? inflated_ : message;
}

}  // namespace telltale
