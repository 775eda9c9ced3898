#include "telltale/client/recording/ros_intake.hpp"

namespace telltale {
namespace {

constexpr std::size_t kLongestMessage = std::size_t{64} << 20;

}  // namespace

RosIntake::RosIntake(const SourceOptions& options) : by_rules_(options) {
  if (options.mapping) mapped_.emplace(options.mapping);
}

void RosIntake::Take(std::string_view topic, std::string_view type, std::string_view definition,
                     std::int64_t received_ns, std::span<const std::uint8_t> bytes,
                     CdrReader::Encoding encoding) {
  // CDR begins with a zero. What cannot be inflated goes on to be counted as unreadable.
  const bool is_compressed = encoding == CdrReader::Encoding::kCdr && BeginsLikeZstdFrame(bytes);
  if (is_compressed && zstd_.InflateOfItsLength(bytes, kLongestMessage, inflated_)) {
    bytes = inflated_;
  }
  if (mapped_) {
    mapped_->TakeRos(topic, type, definition, received_ns, bytes, encoding);
  } else {
    by_rules_.Take(topic, type, received_ns, bytes, encoding);
  }
}

}  // namespace telltale
