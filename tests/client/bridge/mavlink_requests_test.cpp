#include "telltale/client/bridge/mavlink_requests.hpp"

#include <bit>

#include <gtest/gtest.h>

#include "telltale/client/bridge/mavlink_address.hpp"
#include "telltale/client/bridge/mavlink_sequence_gaps.hpp"
#include "telltale/client/recording/mavlink/mavlink_frames.hpp"
#include "telltale/client/recording/mavlink/mavlink_messages.hpp"

namespace telltale {
namespace {

using Kind = MavlinkAddress::Kind;

TEST(MavlinkAddress, HasThreeKinds) {
  const auto udp = ParseMavlinkAddress("udp:127.0.0.1:14550");
  ASSERT_TRUE(udp);
  EXPECT_EQ(udp->kind, Kind::kUdp);
  EXPECT_EQ(udp->place, "127.0.0.1");
  EXPECT_EQ(udp->number, 14550u);
  const auto tcp = ParseMavlinkAddress("tcp:[::1]:5760");
  ASSERT_TRUE(tcp);
  EXPECT_EQ(tcp->kind, Kind::kTcp);
  EXPECT_EQ(tcp->place, "::1");
  const auto serial = ParseMavlinkAddress("serial:/dev/ttyUSB0:57600");
  ASSERT_TRUE(serial);
  EXPECT_EQ(serial->kind, Kind::kSerial);
  EXPECT_EQ(serial->place, "/dev/ttyUSB0");
  EXPECT_EQ(serial->number, 57600u);
}

TEST(MavlinkAddress, NamesWhatIsWrong) {
  for (const char* text : {"", "14550", "http:a:1", "udp", "udp:", "udp:14550", "udp::14550"}) {
    const auto address = ParseMavlinkAddress(text);
    ASSERT_FALSE(address) << text;
    EXPECT_NE(address.error().find("must be udp:HOST:PORT"), std::string::npos) << address.error();
  }
  for (const char* text : {"udp:a:0", "udp:a:65536", "tcp:a:12x", "tcp:a:-1", "tcp:a:"}) {
    const auto address = ParseMavlinkAddress(text);
    ASSERT_FALSE(address) << text;
    EXPECT_NE(address.error().find("[1, 65535]"), std::string::npos) << address.error();
  }
  const auto baud = ParseMavlinkAddress("serial:/dev/ttyS0:300");
  ASSERT_FALSE(baud);
  EXPECT_NE(baud.error().find("[1200, 4000000]"), std::string::npos) << baud.error();
}

TEST(MavlinkRequests, AskForIntervalsOfWhatIsTaken) {
  const auto requests = MessageIntervalRequests(7, 1, 10.0);
  std::vector<float> messages;
  for (const MavlinkRequest& request : requests) {
    const auto float_at = [&](std::size_t at) {
      return std::bit_cast<float>(static_cast<std::uint32_t>(
          request.payload[at] | request.payload[at + 1] << 8 | request.payload[at + 2] << 16 |
          request.payload[at + 3] << 24));
    };
    EXPECT_EQ(request.message, kMavlinkCommandLong);
    EXPECT_EQ(request.payload[28] | request.payload[29] << 8, 511);
    EXPECT_EQ(request.payload[30], 7);
    EXPECT_EQ(request.payload[31], 1);
    EXPECT_EQ(float_at(4), float_at(0) == 2.0F ? 1e6F : 1e5F);
    messages.push_back(float_at(0));
  }
  EXPECT_EQ(messages, (std::vector<float>{24, 33, 30, 36, 2}));
}

TEST(MavlinkRequests, ComeBackAsTheyWereSent) {
  const MavlinkRequest request = OutputFunctionRequests(7, 1).back();
  for (const std::uint8_t version : {std::uint8_t{1}, std::uint8_t{2}}) {
    const auto bytes =
        SerializeMavlinkFrame({version, 254, 191, request.message, request.payload, 9});
    const MavlinkParse parse = ParseMavlinkFrame(bytes);
    ASSERT_EQ(parse.outcome, MavlinkParse::Outcome::kFrame);
    EXPECT_EQ(parse.checksum, MavlinkParse::Checksum::kRight);
    EXPECT_EQ(parse.frame.version, version);
    EXPECT_EQ(parse.frame.system, 254);
    EXPECT_EQ(parse.frame.component, 191);
    EXPECT_EQ(parse.frame.sequence, 9);
    const std::string name(parse.frame.payload.begin() + 4, parse.frame.payload.end());
    EXPECT_EQ(name, "SERVO16_FUNCTION");
  }
}

TEST(MavlinkSequenceGaps, CountWhatIsMissing) {
  MavlinkSequenceGaps gaps;
  EXPECT_EQ(gaps.Take(250, 0.0), 0u);
  EXPECT_EQ(gaps.Take(251, 0.1), 0u);
  EXPECT_EQ(gaps.Take(2, 0.2), 6u);  // 252 to 255, 0 and 1
  EXPECT_EQ(gaps.Take(2, 0.3), 0u);  // twice
  EXPECT_EQ(gaps.Take(1, 0.4), 0u);  // late
  EXPECT_EQ(gaps.Take(3, 0.5), 0u);
}

TEST(MavlinkSequenceGaps, BeginAnewAfterASilence) {
  MavlinkSequenceGaps gaps;
  gaps.Take(10, 0.0);
  EXPECT_EQ(gaps.Take(0, 2.5), 0u);
  EXPECT_EQ(gaps.Take(3, 2.6), 2u);
}

}  // namespace
}  // namespace telltale
