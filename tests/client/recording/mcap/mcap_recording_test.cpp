#include "telltale/client/recording/mcap/mcap_recording.hpp"

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lz4frame.h>
#include <zstd.h>

#include "support/little_endian.hpp"
#include "support/temporary_folder.hpp"

namespace telltale {
namespace {

using Bytes = std::string;

Bytes Record(std::uint8_t opcode, const Bytes& content) {
  return Bytes(1, static_cast<char>(opcode)) +
         LittleEndian(static_cast<std::uint64_t>(content.size())) + content;
}

const Bytes kMagic("\x89MCAP0\r\n", 8);

Bytes Schema() {
  return Record(3, LittleEndian<std::uint16_t>(1) + WithLength("std_msgs/msg/Float64") +
                       WithLength("ros2msg") + WithLength("float64 data"));
}
Bytes Channel() {
  return Record(4, LittleEndian<std::uint16_t>(5) + LittleEndian<std::uint16_t>(1) +
                       WithLength("/compass_hdg") + WithLength("cdr") +
                       LittleEndian<std::uint32_t>(0));
}
Bytes Message(std::uint64_t time_ns, const Bytes& data, std::uint16_t channel = 5) {
  return Record(5, LittleEndian(channel) + LittleEndian<std::uint32_t>(0) + LittleEndian(time_ns) +
                       LittleEndian(time_ns) + data);
}
Bytes Chunk(const Bytes& records, const std::string& compression, const Bytes& compressed) {
  return Record(6, LittleEndian<std::uint64_t>(0) + LittleEndian<std::uint64_t>(0) +
                       LittleEndian(static_cast<std::uint64_t>(records.size())) +
                       LittleEndian<std::uint32_t>(0) + WithLength(compression) +
                       LittleEndian(static_cast<std::uint64_t>(compressed.size())) + compressed);
}

Bytes Zstd(const Bytes& records) {
  Bytes out(ZSTD_compressBound(records.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), records.data(), records.size(), 3));
  return out;
}

Bytes Lz4(const Bytes& records) {
  Bytes out(LZ4F_compressFrameBound(records.size(), nullptr), '\0');
  out.resize(LZ4F_compressFrame(out.data(), out.size(), records.data(), records.size(), nullptr));
  return out;
}

class McapTest : public testing::Test {
 protected:
  Result<McapDamage> Read(const Bytes& bytes) {
    const auto file = folder_.Path() / "recording.mcap";
    std::ofstream(file, std::ios::binary) << bytes;
    return ForEachMcapMessage(file, [&](const McapMessage& message) {
      topics_.emplace_back(message.topic);
      schemas_.emplace_back(message.schema);
      times_ns_.push_back(message.log_time_ns);
      data_.emplace_back(message.data.begin(), message.data.end());
    });
  }

  TemporaryFolder folder_;
  std::vector<std::string> topics_;
  std::vector<std::string> schemas_;
  std::vector<std::int64_t> times_ns_;
  std::vector<std::string> data_;
};

TEST_F(McapTest, ReadsMessagesWithoutChunks) {
  const auto damage = Read(kMagic + Schema() + Channel() + Message(7, "abc") + Message(9, "de") +
                           Record(15, LittleEndian<std::uint32_t>(0)) + kMagic);
  ASSERT_TRUE(damage);
  EXPECT_EQ(damage->messages, 2u);
  EXPECT_EQ(damage->Summary(), "");
  EXPECT_THAT(topics_, testing::Each("/compass_hdg"));
  EXPECT_THAT(schemas_, testing::Each("std_msgs/msg/Float64"));
  EXPECT_THAT(times_ns_, testing::ElementsAre(7, 9));
  EXPECT_THAT(data_, testing::ElementsAre("abc", "de"));
}

TEST_F(McapTest, ReadsChunksOfEachCompression) {
  const Bytes records = Schema() + Channel() + Message(1, "x");
  const auto damage = Read(kMagic + Chunk(records, "", records) +
                           Chunk(Message(2, "y"), "zstd", Zstd(Message(2, "y"))) +
                           Chunk(Message(3, "z"), "lz4", Lz4(Message(3, "z"))));
  ASSERT_TRUE(damage);
  EXPECT_THAT(data_, testing::ElementsAre("x", "y", "z"));
  EXPECT_EQ(damage->Summary(), "");
}

TEST_F(McapTest, CountsAChunkThatCannotBeReadAndGoesOn) {
  Bytes broken = Zstd(Message(2, "y"));
  broken[broken.size() / 2] = static_cast<char>(~broken[broken.size() / 2]);
  broken.resize(broken.size() - 2);
  const auto damage = Read(kMagic + Schema() + Channel() + Chunk(Message(2, "y"), "zstd", broken) +
                           Chunk(Message(2, "y"), "brotli", "?") + Message(3, "z"));
  ASSERT_TRUE(damage);
  EXPECT_THAT(data_, testing::ElementsAre("z"));
  EXPECT_EQ(damage->unreadable_chunks, 2u);
}

TEST_F(McapTest, GivesTheWholeMessagesOfAFileThatIsCutOff) {
  const Bytes whole = kMagic + Schema() + Channel() + Message(1, "abc") + Message(2, "def");
  const auto damage = Read(whole.substr(0, whole.size() - 2));
  ASSERT_TRUE(damage);
  EXPECT_THAT(data_, testing::ElementsAre("abc"));
  EXPECT_GT(damage->truncated_bytes, 0u);
}

TEST_F(McapTest, CountsMessagesOfAChannelThatIsNotDefined) {
  const auto damage = Read(kMagic + Schema() + Channel() + Message(1, "abc", 6));
  ASSERT_TRUE(damage);
  EXPECT_EQ(damage->unknown_channels, 1u);
  EXPECT_EQ(damage->messages, 0u);
}

TEST_F(McapTest, RefusesWhatIsNoMcapFile) {
  const auto damage = Read("no such thing");
  ASSERT_FALSE(damage);
  EXPECT_THAT(damage.error().reason, testing::HasSubstr("is not an MCAP file"));
  EXPECT_FALSE(Read(""));
}

}  // namespace
}  // namespace telltale
