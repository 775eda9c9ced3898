// A long MAVLink telemetry log, to measure memory and rate with:
//
//   long_tlog LOG FILE MEGABYTES [SILENCE_S]
//
// Repeats the samples of LOG, such as deploy/sample, with SILENCE_S (2 s) between one time and the
// next until FILE holds as many megabytes. All messages count: GPS_RAW_INT, ATTITUDE,
// SERVO_OUTPUT_RAW, and before them the SERVOn parameters of a boat with port on output 1 and
// starboard on 3, 1100 to 1900 us.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "telltale/client/recording/load_recording.hpp"
#include "telltale/client/recording/mavlink/mavlink_checksum.hpp"
#include "telltale/client/recording/time_order.hpp"

namespace telltale {
namespace {

constexpr std::int64_t kStartUnixUs = 1'700'000'000'000'000;
constexpr double kMicroseconds = 1e6;

/// A payload of little-endian fields, in the order in which they travel.
class Payload {
 public:
  template <class Value>
  Payload& Put(Value value) {
    static_assert(std::endian::native == std::endian::little);
    const auto at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
    return *this;
  }
  Payload& Zeros(std::size_t count) {
    bytes_.resize(bytes_.size() + count);
    return *this;
  }
  Payload& Text(std::string_view text, std::size_t width) {
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    return Zeros(width - text.size());
  }
  const std::vector<std::uint8_t>& Bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

/// A message and its CRC_EXTRA, by MAVLink's common dialect.
struct MessageKind {
  std::uint8_t id;
  std::uint8_t extra;
};
constexpr MessageKind kParamValue{22, 220};
constexpr MessageKind kGpsRawInt{24, 24};
constexpr MessageKind kAttitude{30, 39};
constexpr MessageKind kServoOutputRaw{36, 222};

class TlogWriter {
 public:
  explicit TlogWriter(const char* file) : out_(file, std::ios::binary) {}

  /// One MAVLink 2 frame behind its time of arrival.
  void Write(double time_s, const MessageKind& kind, const Payload& payload) {
    const auto arrival =
        static_cast<std::uint64_t>(kStartUnixUs + std::llround(time_s * kMicroseconds));
    for (int shift = 56; shift >= 0; shift -= 8) {
      out_.put(static_cast<char>(arrival >> shift & 0xFFU));
    }
    frame_ = {0xFD,        static_cast<std::uint8_t>(payload.Bytes().size()),
              0,           0,
              sequence_++, 1,
              1,           kind.id,
              0,           0};
    frame_.insert(frame_.end(), payload.Bytes().begin(), payload.Bytes().end());
    const std::uint16_t checksum = MavlinkChecksum(std::span(frame_).subspan(1), kind.extra);
    frame_.push_back(static_cast<std::uint8_t>(checksum & 0xFFU));
    frame_.push_back(static_cast<std::uint8_t>(checksum >> 8U));
    out_.write(reinterpret_cast<const char*>(frame_.data()),
               static_cast<std::streamsize>(frame_.size()));
    written_ += sizeof arrival + frame_.size();
  }

  std::uint64_t Written() const { return written_; }
  bool Close() {
    out_.close();
    return out_.good();
  }

 private:
  std::ofstream out_;
  std::vector<std::uint8_t> frame_;
  std::uint8_t sequence_ = 0;
  std::uint64_t written_ = 0;
};

void WriteParameter(TlogWriter& tlog, std::string_view name, float value) {
  constexpr std::size_t kNameBytes = 16;
  constexpr std::uint8_t kReal32 = 9;
  tlog.Write(0.0, kParamValue,
             Payload()
                 .Put(value)
                 .Put(std::uint16_t{8})
                 .Put(std::uint16_t{0})
                 .Text(name, kNameBytes)
                 .Put(kReal32));
}

void WriteOutput(TlogWriter& tlog, const std::string& channel, float function) {
  WriteParameter(tlog, "SERVO" + channel + "_FUNCTION", function);
  WriteParameter(tlog, "SERVO" + channel + "_MIN", 1100.0F);
  WriteParameter(tlog, "SERVO" + channel + "_TRIM", 1500.0F);
  WriteParameter(tlog, "SERVO" + channel + "_MAX", 1900.0F);
}

template <class Integer>
Integer Rounded(double value) {
  return static_cast<Integer>(std::llround(value));
}

void WriteSample(TlogWriter& tlog, double time_s, const GnssFix& fix) {
  constexpr double kPerDegree = 1e7;
  constexpr std::uint8_t kFix3d = 3;
  constexpr std::uint8_t kSatellites = 12;
  tlog.Write(time_s, kGpsRawInt,
             Payload()
                 .Put(Rounded<std::uint64_t>(time_s * kMicroseconds))
                 .Put(Rounded<std::int32_t>(fix.latitude_deg * kPerDegree))
                 .Put(Rounded<std::int32_t>(fix.longitude_deg * kPerDegree))
                 .Zeros(12)
                 .Put(kFix3d)
                 .Put(kSatellites));
}

void WriteSample(TlogWriter& tlog, double time_s, const HeadingSample& sample) {
  const double yaw_rad = std::remainder(sample.heading_deg, 360.0) * std::numbers::pi / 180.0;
  constexpr float kRate = 0.1F;  // a zero at the end would not travel
  tlog.Write(time_s, kAttitude,
             Payload()
                 .Put(Rounded<std::uint32_t>(time_s * 1e3))
                 .Zeros(8)
                 .Put(static_cast<float>(yaw_rad))
                 .Zeros(8)
                 .Put(kRate));
}

void WriteSample(TlogWriter& tlog, double time_s, const ThrusterSample& sample) {
  const auto time_us = Rounded<std::uint64_t>(time_s * kMicroseconds);
  tlog.Write(time_s, kServoOutputRaw,
             Payload()
                 .Put(static_cast<std::uint32_t>(time_us))  // it begins anew every 71.6 minutes
                 .Put(Rounded<std::uint16_t>(sample.port_us))
                 .Zeros(2)
                 .Put(Rounded<std::uint16_t>(sample.starboard_us))
                 .Zeros(10)
                 .Put(std::uint8_t{0}));
}

int Repeat(const char* log, const char* file, double megabytes, double silence_s) {
  const auto loaded = ReadLog(log);
  if (!loaded || !loaded->lacks.empty()) {
    std::fprintf(stderr, "%s is no log with all three channels\n", log);
    return 1;
  }
  const std::vector<RawSample> samples = InOrderOfTime(loaded->channels);
  const double first_s = TimeOf(samples.front());
  const double duration_s = TimeOf(samples.back()) - first_s + silence_s;
  TlogWriter tlog(file);
  WriteOutput(tlog, "1", 73.0F);
  WriteOutput(tlog, "3", 74.0F);
  double start_s = 1.0;
  for (; static_cast<double>(tlog.Written()) < megabytes * 1e6; start_s += duration_s) {
    for (const RawSample& sample : samples) {
      const double time_s = start_s + TimeOf(sample) - first_s;
      std::visit([&](const auto& one) { WriteSample(tlog, time_s, one); }, sample);
    }
  }
  if (!tlog.Close()) {
    std::fprintf(stderr, "%s cannot be written\n", file);
    return 1;
  }
  std::printf("%s: %.0f MB, %.1f h\n", file, static_cast<double>(tlog.Written()) / 1e6,
              start_s / 3600.0);
  return 0;
}

}  // namespace
}  // namespace telltale

int main(int argc, char** argv) {
  if (argc < 4 || argc > 5) {
    std::fprintf(stderr, "usage: long_tlog LOG FILE MEGABYTES [SILENCE_S]\n");
    return 2;
  }
  return telltale::Repeat(argv[1], argv[2], std::atof(argv[3]),
                          argc > 4 ? std::atof(argv[4]) : 2.0);
}
