#include "telltale/client/recording/mavlink/mavlink_frames.hpp"

#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "telltale/client/recording/mavlink/mavlink_messages.hpp"

namespace telltale {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Written by node-mavlink 2.3.0: GPS_RAW_INT {timeUsec: 123456789012, lat: 634000000,
// lon: -104000000, fixType: 3, ...} of system 7 by MavLinkProtocolV2 and V1.
const Bytes kGps2 = {0xfd, 0x1e, 0x00, 0x00, 0x05, 0x07, 0x01, 0x18, 0x00, 0x00, 0x14,
                     0x1a, 0x99, 0xbe, 0x1c, 0x00, 0x00, 0x00, 0x80, 0x12, 0xca, 0x25,
                     0x00, 0x16, 0xcd, 0xf9, 0xe8, 0x03, 0x00, 0x00, 0x64, 0x00, 0xc8,
                     0x00, 0x32, 0x00, 0x28, 0x23, 0x03, 0x0b, 0x4e, 0x16};
// SERVO_OUTPUT_RAW {timeUsec: 4000000, servo1Raw: 1600, servo3Raw: 1400}: trailing zeros are cut.
const Bytes kServo = {0xfd, 0x0a, 0x00, 0x00, 0x06, 0x07, 0x01, 0x24, 0x00, 0x00, 0x00,
                      0x09, 0x3d, 0x00, 0x40, 0x06, 0x00, 0x00, 0x78, 0x05, 0x95, 0x35};
// ATTITUDE {timeBootMs: 2500, yaw: 0.5}, signed.
const Bytes kSigned = {0xfd, 0x10, 0x01, 0x00, 0x07, 0x07, 0x01, 0x1e, 0x00, 0x00, 0xc4,
                       0x09, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
                       0x00, 0x00, 0x00, 0x3f, 0x35, 0x09, 0x01, 0x00, 0xe0, 0x6f, 0x9e,
                       0x75, 0x19, 0x59, 0x20, 0x7a, 0x61, 0x39, 0x22};

Bytes Joined(std::initializer_list<Bytes> parts) {
  Bytes joined;
  for (const Bytes& part : parts) joined.insert(joined.end(), part.begin(), part.end());
  return joined;
}

std::vector<std::uint32_t> MessagesIn(const Bytes& bytes, MavlinkDamage& damage) {
  std::vector<std::uint32_t> messages;
  MavlinkStream stream;
  EXPECT_EQ(
      stream.Consume(bytes, true, [&](const MavlinkFrame& f) { messages.push_back(f.message); }),
      bytes.size());
  damage = stream.Damage();
  return messages;
}

TEST(MavlinkFrames, ReadVersionTwo) {
  const MavlinkParse parse = ParseMavlinkFrame(kGps2);
  ASSERT_EQ(parse.outcome, MavlinkParse::Outcome::kFrame);
  EXPECT_EQ(parse.checksum, MavlinkParse::Checksum::kRight);
  EXPECT_EQ(parse.length, kGps2.size());
  EXPECT_EQ(parse.frame.system, 7);
  const MavlinkGpsRawInt fix = GpsRawIntOf(parse.frame);
  EXPECT_EQ(fix.time_us, 123456789012u);
  EXPECT_DOUBLE_EQ(fix.latitude_deg, 63.4);
  EXPECT_DOUBLE_EQ(fix.longitude_deg, -10.4);
  EXPECT_EQ(fix.fix_type, 3);
}

TEST(MavlinkFrames, FillUpWhatVersionTwoCuts) {
  const MavlinkServoOutputRaw output = ServoOutputRawOf(ParseMavlinkFrame(kServo).frame);
  EXPECT_EQ(output.time_us, 4000000u);
  EXPECT_EQ(output.pulse_us[0], 1600);
  EXPECT_EQ(output.pulse_us[1], 0);
  EXPECT_EQ(output.pulse_us[2], 1400);
  EXPECT_EQ(output.pulse_us[15], 0);
}

TEST(MavlinkFrames, PassOverASignature) {
  MavlinkDamage damage;
  EXPECT_THAT(MessagesIn(Joined({kSigned, kServo}), damage), testing::ElementsAre(30u, 36u));
  EXPECT_EQ(damage.skipped_bytes, 0u);
  EXPECT_FLOAT_EQ(AttitudeOf(ParseMavlinkFrame(kSigned).frame).yaw_rad, 0.5F);
}

TEST(MavlinkFrames, FindTheNextAfterNoise) {
  MavlinkDamage damage;
  const Bytes noise = {0x00, 0xfd, 0x03, 0x17};
  EXPECT_THAT(MessagesIn(Joined({kGps2, noise, kServo}), damage), testing::ElementsAre(24u, 36u));
  EXPECT_EQ(damage.skipped_bytes, noise.size());
}

// HIGHRES_IMU, whose checksum is not known here, of three bytes.
const Bytes kForeign = {0xfd, 0x03, 0x00, 0x00, 0x08, 0x07, 0x01, 0x69,
                        0x00, 0x00, 0x01, 0x02, 0x03, 0x12, 0x34};

TEST(MavlinkFrames, OfUnknownMessagesCountBetweenOthersAndAtTheEnd) {
  MavlinkDamage damage;
  EXPECT_THAT(MessagesIn(Joined({kForeign, kForeign, kServo, kForeign}), damage),
              testing::ElementsAre(105u, 105u, 36u, 105u));
  EXPECT_EQ(damage.skipped_bytes, 0u);
}

TEST(MavlinkFrames, BehindNoiseInTheFormOfAnUnknownMessageAreFound) {
  MavlinkDamage damage;
  Bytes too_long = kForeign;
  too_long[1] = 20;  // would end in the midst of the message behind it
  EXPECT_THAT(MessagesIn(Joined({too_long, kServo, kGps2}), damage),
              testing::ElementsAre(36u, 24u));
  EXPECT_EQ(damage.skipped_bytes, too_long.size());
}

TEST(MavlinkFrames, CountAWrongChecksumAndGoOn) {
  Bytes corrupt = kGps2;
  corrupt[20] ^= 0x10;
  MavlinkDamage damage;
  EXPECT_THAT(MessagesIn(Joined({corrupt, kServo}), damage), testing::ElementsAre(36u));
  EXPECT_EQ(damage.corrupt_frames, 1u);
  EXPECT_EQ(damage.skipped_bytes, corrupt.size());
}

TEST(MavlinkFrames, ComeTheSameHoweverTheBytesArrive) {
  const Bytes bytes = Joined({kGps2, kSigned, kServo});
  for (const std::size_t block : {1u, 7u, 30u}) {
    MavlinkStream stream;
    std::vector<std::uint32_t> messages;
    Bytes held;
    for (std::size_t at = 0; at < bytes.size(); at += block) {
      const std::size_t end = std::min(at + block, bytes.size());
      held.insert(held.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                  bytes.begin() + static_cast<std::ptrdiff_t>(end));
      const std::size_t done = stream.Consume(
          held, end == bytes.size(), [&](const MavlinkFrame& f) { messages.push_back(f.message); });
      held.erase(held.begin(), held.begin() + static_cast<std::ptrdiff_t>(done));
    }
    EXPECT_THAT(messages, testing::ElementsAre(24u, 30u, 36u)) << "blocks of " << block;
    EXPECT_EQ(stream.Damage().skipped_bytes, 0u);
  }
}

TEST(MavlinkFrames, OfATelemetryLogFollowTheirTimeOfArrival) {
  const Bytes time = {0x00, 0x05, 0xfa, 0xea, 0x6c, 0xd6, 0x2a, 0x00};  // in 2023
  const Bytes bytes = Joined({time, kGps2, time, kServo, time, {0xfd, 0x1e}});
  EXPECT_TRUE(BeginsLikeMavlinkTelemetryLog(bytes));
  EXPECT_FALSE(BeginsLikeMavlinkTelemetryLog(kGps2));
  MavlinkTelemetryLog log;
  std::vector<std::uint32_t> messages;
  log.Consume(bytes, true,
              [&](std::uint64_t, const MavlinkFrame& f) { messages.push_back(f.message); });
  EXPECT_THAT(messages, testing::ElementsAre(24u, 36u));
  EXPECT_EQ(log.Damage().truncated_bytes, 10u);
}

}  // namespace
}  // namespace telltale
