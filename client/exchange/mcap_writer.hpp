#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace telltale {

/// Gathers JSON messages and lays them out as an MCAP file: in order of time, in chunks compressed
/// with zstd, with the indexes by which viewers seek.
/// Source: MCAP file format specification, version 0.
class McapWriter {
 public:
  /// A channel of JSON messages; `json_schema` describes them. Returns its number.
  std::uint16_t AddChannel(const std::string& topic, const std::string& schema_name,
                           const std::string& json_schema);

  /// Requires: the channel exists; time_ns >= 0.
  void Add(std::uint16_t channel, std::int64_t time_ns, std::string json);

  /// The whole file.
  std::string Finish() const;

 private:
  struct Channel {
    std::string topic;
    std::string schema_name;
    std::string json_schema;
  };
  struct Message {
    std::uint16_t channel = 0;
    std::uint64_t time_ns = 0;
    std::string json;
  };

  std::string Definitions() const;

  std::vector<Channel> channels_;
  std::vector<Message> messages_;
};

}  // namespace telltale
