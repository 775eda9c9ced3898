#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "insist.hpp"
#include "memory_file.hpp"
#include "telltale/client/recording/block_reader.hpp"
#include "telltale/client/recording/mavlink/mavlink_frames.hpp"
#include "telltale/client/recording/mavlink/mavlink_recording.hpp"

namespace {

using telltale::Insist;
using telltale::MavlinkFrame;

struct Outcome {
  std::uint64_t frames = 0;
  std::uint64_t payload_bytes = 0;
  telltale::MavlinkDamage damage;
};

template <class Stream, class Take>
Outcome Frame(std::span<const std::uint8_t> bytes, std::size_t block, Take take) {
  Outcome outcome;
  Stream stream;
  const auto frame = [&](const MavlinkFrame& one) {
    ++outcome.frames;
    outcome.payload_bytes += one.payload.size();
    take(one);
  };
  const auto consume = [&](std::span<const std::uint8_t> part, bool at_end) {
    if constexpr (std::is_same_v<Stream, telltale::MavlinkStream>) {
      return stream.Consume(part, at_end, frame);
    } else {
      return stream.Consume(part, at_end,
                            [&](std::uint64_t, const MavlinkFrame& one) { frame(one); });
    }
  };
  Insist(telltale::TakeInBlocks(bytes, block, consume) == bytes.size());
  outcome.damage = stream.Damage();
  return outcome;
}

bool Same(const Outcome& a, const Outcome& b) {
  return a.frames == b.frames && a.payload_bytes == b.payload_bytes &&
         a.damage.corrupt_frames == b.damage.corrupt_frames &&
         a.damage.skipped_bytes == b.damage.skipped_bytes &&
         a.damage.truncated_bytes == b.damage.truncated_bytes;
}

template <class Stream>
void Read(std::span<const std::uint8_t> bytes) {
  telltale::MavlinkRecording recording;
  const Outcome whole = Frame<Stream>(bytes, std::max<std::size_t>(bytes.size(), 1),
                                      [&](const MavlinkFrame& frame) { recording.Take(frame); });
  Insist(Same(whole, Frame<Stream>(bytes, 1 + bytes.size() % 300, [](const MavlinkFrame&) {})));
  Insist(whole.payload_bytes + whole.damage.skipped_bytes + whole.damage.truncated_bytes <=
         bytes.size());
  telltale::SourceOptions options;
  if (bytes.size() % 3 == 0) options.system_id = 1;
  if (bytes.size() % 2 == 0) options.port_channel = 16;
  if (bytes.size() % 5 == 0) options.starboard_channel = 1;
  const telltale::SourceLog log = std::move(recording).Finish(options);
  Insist(log.gnss.size() + log.heading.size() + log.thrusters.size() <= 2 * whole.frames);
  for (const telltale::Refusal& lack : log.Lacks()) Insist(!lack.reason.empty());
}

/// Messages out of the bytes, each after its id and its length: no checksum stands in the way.
void TakeMessages(std::span<const std::uint8_t> bytes) {
  telltale::MavlinkRecording recording;
  std::size_t messages = 0;
  for (std::size_t at = 0; at + 2 <= bytes.size(); ++messages) {
    const std::size_t length = std::min<std::size_t>(bytes[at + 1], bytes.size() - at - 2);
    recording.Take({2, 1, 1, bytes[at], bytes.subspan(at + 2, length)});
    at += 2 + length;
  }
  const telltale::SourceLog log = std::move(recording).Finish({});
  Insist(log.gnss.size() + log.heading.size() + log.thrusters.size() <= 2 * messages);
}

/// A file of either kind, which its beginning tells.
void ReadFile(std::span<const std::uint8_t> bytes) {
  const telltale::MemoryFile file(bytes);
  const auto log = telltale::ReadMavlinkTelemetryLog(file.Path(), {});
  Insist(log ? !log->summary.empty() : !log.error().reason.empty());
}

}  // namespace

/// Blocks change nothing, no byte counts twice, and nothing of a log is more than its frames.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Read<telltale::MavlinkTelemetryLog>({data, size});
  Read<telltale::MavlinkStream>({data, size});
  TakeMessages({data, size});
  if (size % 16 == 0) ReadFile({data, size});  // a file takes as long as a hundred inputs else
  return 0;
}
