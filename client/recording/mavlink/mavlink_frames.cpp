#include "telltale/client/recording/mavlink/mavlink_frames.hpp"

#include "telltale/client/recording/mavlink/mavlink_checksum.hpp"
#include "telltale/client/recording/mavlink/mavlink_messages.hpp"
#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

constexpr std::uint8_t kMagic1 = 0xFE;
constexpr std::uint8_t kMagic2 = 0xFD;
constexpr std::size_t kHeader1 = 6;
constexpr std::size_t kHeader2 = 10;
constexpr std::size_t kChecksum = 2;
constexpr std::size_t kSignature = 13;
constexpr std::uint8_t kSigned = 0x01;
constexpr std::size_t kTimeBytes = 8;
constexpr std::uint64_t kYear2000Us = 946684800000000;
constexpr std::uint64_t kYear2100Us = 4102444800000000;

/// Version 2 leaves out the zeros at the end of a payload, but for its first byte.
std::span<const std::uint8_t> WithoutTrailingZeros(std::span<const std::uint8_t> payload) {
  while (payload.size() > 1 && payload.back() == 0) payload = payload.first(payload.size() - 1);
  return payload;
}

std::uint64_t BigEndian64(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < kTimeBytes; ++i) value = value << 8 | bytes[i];
  return value;
}

bool IsPlausibleArrival(std::uint64_t us) {
  return kYear2000Us <= us && us < kYear2100Us;
}

/// What stands before each frame, and what is told of it.
struct NoPrefix {
  static constexpr std::size_t kBytes = 0;
  static bool IsPlausible(std::span<const std::uint8_t>) { return true; }
};
struct ArrivalPrefix {
  static constexpr std::size_t kBytes = kTimeBytes;
  static bool IsPlausible(std::span<const std::uint8_t> bytes) {
    return IsPlausibleArrival(BigEndian64(bytes));
  }
};

bool IsMagic(std::uint8_t byte) {
  return byte == kMagic1 || byte == kMagic2;
}

using Outcome = MavlinkParse::Outcome;

/// Whether a prefix and a frame seem to begin at `bytes`.
template <class Prefix>
Outcome SeemsToBeginAt(std::span<const std::uint8_t> bytes) {
  if (bytes.size() <= Prefix::kBytes) return Outcome::kIncomplete;
  const bool seems = IsMagic(bytes[Prefix::kBytes]) && Prefix::IsPlausible(bytes);
  return seems ? Outcome::kFrame : Outcome::kNotAFrame;
}

/// The prefix and frame at `bytes`, whose length counts both. What its checksum cannot tell from
/// noise counts as a frame only where another one, or the end, follows it.
template <class Prefix>
MavlinkParse ParseAt(std::span<const std::uint8_t> bytes, bool at_end) {
  MavlinkParse parse;
  parse.outcome = SeemsToBeginAt<Prefix>(bytes);
  if (parse.outcome != Outcome::kFrame) return parse;
  parse = ParseMavlinkFrame(bytes.subspan(Prefix::kBytes));
  parse.length += Prefix::kBytes;
  if (parse.outcome != Outcome::kFrame || parse.checksum != MavlinkParse::Checksum::kUnknown) {
    return parse;
  }
  parse.outcome = SeemsToBeginAt<Prefix>(bytes.subspan(parse.length));
  if (parse.outcome == Outcome::kIncomplete && at_end) parse.outcome = Outcome::kFrame;
  return parse;
}

template <class Prefix, class Deliver>
std::size_t ConsumeFrames(std::span<const std::uint8_t> bytes, bool at_end, MavlinkDamage& damage,
                          Deliver deliver) {
  std::size_t at = 0;
  while (at < bytes.size()) {
    const auto rest = bytes.subspan(at);
    const MavlinkParse parse = ParseAt<Prefix>(rest, at_end);
    const bool is_corrupt = parse.checksum == MavlinkParse::Checksum::kWrong;
    if (parse.outcome == Outcome::kFrame && !is_corrupt) {
      deliver(rest, parse.frame);
      at += parse.length;
      continue;
    }
    if (parse.outcome == Outcome::kIncomplete) {
      if (!at_end) return at;
      // The seeming start of a frame may be noise with frames behind it.
      const bool holds_more = Prefix::kBytes == 0 && rest.size() > 1;
      if (!holds_more) {
        damage.truncated_bytes += rest.size();
        return bytes.size();
      }
    }
    if (is_corrupt) ++damage.corrupt_frames;
    ++damage.skipped_bytes;
    ++at;
  }
  return bytes.size();
}

}  // namespace

MavlinkParse ParseMavlinkFrame(std::span<const std::uint8_t> bytes) {
  MavlinkParse parse;
  parse.outcome = Outcome::kIncomplete;
  if (bytes.empty()) return parse;
  if (!IsMagic(bytes[0])) {
    parse.outcome = Outcome::kNotAFrame;
    return parse;
  }
  const bool is_v2 = bytes[0] == kMagic2;
  const std::size_t header = is_v2 ? kHeader2 : kHeader1;
  if (bytes.size() < header) return parse;
  if (is_v2 && (bytes[2] & ~kSigned) != 0) {
    parse.outcome = Outcome::kNotAFrame;  // incompatible flags that no version defines yet
    return parse;
  }
  const std::size_t payload = bytes[1];
  const bool is_signed = is_v2 && (bytes[2] & kSigned) != 0;
  parse.length = header + payload + kChecksum + (is_signed ? kSignature : 0);
  if (bytes.size() < parse.length) return parse;

  MavlinkFrame& frame = parse.frame;
  frame.version = is_v2 ? 2 : 1;
  frame.system = is_v2 ? bytes[5] : bytes[3];
  frame.component = is_v2 ? bytes[6] : bytes[4];
  frame.message =
      is_v2 ? static_cast<std::uint32_t>(bytes[7] | bytes[8] << 8 | bytes[9] << 16) : bytes[5];
  frame.payload = bytes.subspan(header, payload);
  frame.sequence = is_v2 ? bytes[4] : bytes[2];
  parse.outcome = Outcome::kFrame;
  if (const auto extra = MavlinkCrcExtra(frame.message)) {
    const std::size_t end = header + payload;
    const auto stated = static_cast<std::uint16_t>(bytes[end] | bytes[end + 1] << 8);
    const bool is_right = MavlinkChecksum(bytes.subspan(1, end - 1), *extra) == stated;
    parse.checksum = is_right ? MavlinkParse::Checksum::kRight : MavlinkParse::Checksum::kWrong;
  }
  return parse;
}

std::vector<std::uint8_t> SerializeMavlinkFrame(const MavlinkFrame& frame) {
  const auto extra = MavlinkCrcExtra(frame.message);
  Require(extra.has_value(), "a message whose checksum is known");
  Require(frame.payload.size() <= 255, "a payload of at most 255 bytes");
  const auto low = [](std::uint32_t value) { return static_cast<std::uint8_t>(value & 0xFF); };
  const bool is_v2 = frame.version == 2;
  const auto payload = is_v2 ? WithoutTrailingZeros(frame.payload) : frame.payload;
  const std::uint8_t length = low(static_cast<std::uint32_t>(payload.size()));
  std::vector<std::uint8_t> bytes =
      is_v2 ? std::vector<std::uint8_t>{kMagic2,
                                        length,
                                        0,
                                        0,
                                        frame.sequence,
                                        frame.system,
                                        frame.component,
                                        low(frame.message),
                                        low(frame.message >> 8),
                                        low(frame.message >> 16)}
            : std::vector<std::uint8_t>{kMagic1,      length,          frame.sequence,
                                        frame.system, frame.component, low(frame.message)};
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  const std::uint16_t checksum = MavlinkChecksum(std::span(bytes).subspan(1), *extra);
  bytes.push_back(low(checksum));
  bytes.push_back(low(checksum >> 8));
  return bytes;
}

std::size_t MavlinkStream::Consume(std::span<const std::uint8_t> bytes, bool at_end,
                                   const Visit& visit) {
  return ConsumeFrames<NoPrefix>(bytes, at_end, damage_,
                                 [&](auto, const MavlinkFrame& frame) { visit(frame); });
}

std::size_t MavlinkTelemetryLog::Consume(std::span<const std::uint8_t> bytes, bool at_end,
                                         const Visit& visit) {
  return ConsumeFrames<ArrivalPrefix>(
      bytes, at_end, damage_, [&](std::span<const std::uint8_t> from, const MavlinkFrame& frame) {
        visit(BigEndian64(from), frame);
      });
}

bool BeginsLikeMavlinkTelemetryLog(std::span<const std::uint8_t> bytes) {
  if (bytes.size() <= kTimeBytes || !IsPlausibleArrival(BigEndian64(bytes))) return false;
  return IsMagic(bytes[kTimeBytes]);
}

bool BeginsLikeMavlinkStream(std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || !IsMagic(bytes[0])) return false;
  const MavlinkParse parsed = ParseMavlinkFrame(bytes);
  return parsed.outcome == Outcome::kFrame && parsed.checksum == MavlinkParse::Checksum::kRight;
}

}  // namespace telltale
