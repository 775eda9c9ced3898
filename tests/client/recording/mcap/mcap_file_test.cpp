#include "telltale/client/recording/mcap/mcap_file.hpp"

#include <cstdint>
#include <fstream>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/compression.hpp"
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

std::uint32_t Crc32(const Bytes& bytes) {  // bit by bit, of the polynomial of IEEE 802.3
  std::uint32_t sum = 0xFFFFFFFF;
  for (const char byte : bytes) {
    sum ^= static_cast<std::uint8_t>(byte);
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1) != 0 ? 0xEDB88320 : 0);
  }
  return ~sum;
}

Bytes ChunkWithChecksum(const Bytes& records, std::uint32_t checksum,
                        const std::string& compression, const Bytes& compressed) {
  Bytes chunk = Chunk(records, compression, compressed);
  chunk.replace(9 + 3 * 8, 4, LittleEndian(checksum));
  return chunk;
}

/// Where the messages of a channel begin in a chunk.
Bytes MessageIndex(std::uint16_t channel, const std::vector<std::uint64_t>& offsets) {
  Bytes entries;
  for (const std::uint64_t offset : offsets)
    entries += LittleEndian<std::uint64_t>(0) + LittleEndian(offset);
  return Record(7, LittleEndian(channel) + WithLength(entries));
}

/// What follows the data of a file with so many channels; `data` is all before it.
Bytes Ending(const Bytes& data, const Bytes& definitions, std::uint32_t channels) {
  const Bytes end_of_data = Record(15, LittleEndian<std::uint32_t>(0));
  const Bytes statistics =
      Record(11, LittleEndian<std::uint64_t>(0) + LittleEndian<std::uint16_t>(1) +
                     LittleEndian(channels) + Bytes(30, '\0'));
  const auto start = static_cast<std::uint64_t>(data.size() + end_of_data.size());
  const Bytes footer = Record(
      2, LittleEndian(start) + LittleEndian<std::uint64_t>(0) + LittleEndian<std::uint32_t>(0));
  return end_of_data + definitions + statistics + footer + kMagic;
}

class McapTest : public testing::Test {
 protected:
  Result<McapDamage> Read(const Bytes& bytes) {
    const auto file = folder_.Path() / "recording.mcap";
    std::ofstream(file, std::ios::binary) << bytes;
    const auto open = [&](const McapChannel& channel) -> MessageTaker {
      if (channel.topic == unwanted_) return nullptr;
      return [this, topic = std::string(channel.topic), schema = std::string(channel.schema)](
                 std::int64_t time_ns, std::span<const std::uint8_t> message) {
        topics_.push_back(topic);
        schemas_.push_back(schema);
        times_ns_.push_back(time_ns);
        data_.emplace_back(message.begin(), message.end());
      };
    };
    return ForEachMcapMessage(file, {open, nullptr});
  }

  TemporaryFolder folder_;
  std::string unwanted_;  ///< a topic
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

TEST_F(McapTest, ReadsAFileThatZstdHasCompressed) {
  Bytes file = kMagic + Schema() + Channel();
  const Bytes message(100'000, 'm');  // of which several blocks do not hold a whole number
  for (std::uint64_t i = 0; i < 30; ++i) file += Message(i, message);
  const Bytes compressed = Zstd(file + Record(15, LittleEndian<std::uint32_t>(0)) + kMagic);
  EXPECT_TRUE(HoldsMcap(
      std::span(reinterpret_cast<const std::uint8_t*>(compressed.data()), compressed.size())));
  const auto damage = Read(compressed);
  ASSERT_TRUE(damage) << damage.error().reason;
  EXPECT_EQ(damage->Summary(), "");
  EXPECT_EQ(times_ns_.size(), 30u);
  EXPECT_THAT(data_, testing::Each(message));
}

TEST_F(McapTest, SaysThatACompressedFileIsCutOff) {
  Bytes file = kMagic + Schema() + Channel();
  std::mt19937 random(1);  // what cannot be compressed, so that half of it is half of the messages
  for (std::uint64_t i = 0; i < 30; ++i) {
    Bytes message(100'000, '\0');
    for (char& byte : message) byte = static_cast<char>(random());
    file += Message(i, message);
  }
  const Bytes compressed = Zstd(file);
  const auto damage = Read(compressed.substr(0, compressed.size() / 2));
  ASSERT_TRUE(damage) << damage.error().reason;
  EXPECT_THAT(damage->Summary(), testing::EndsWith("; the compressed file is cut off"));
  EXPECT_GT(times_ns_.size(), 10u);
  EXPECT_LT(times_ns_.size(), 16u);
}

TEST_F(McapTest, RefusesAFileThatOnlyBeginsCompressed) {
  const auto damage = Read(Bytes("\x28\xB5\x2F\xFD") + " and no frame");
  ASSERT_FALSE(damage);
  EXPECT_THAT(damage.error().reason, testing::HasSubstr("cannot be decompressed as zstd"));
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

TEST_F(McapTest, CountsAChunkWithAWrongChecksum) {
  const Bytes records = Message(1, "x");
  const auto damage =
      Read(kMagic + Schema() + Channel() + ChunkWithChecksum(records, Crc32(records), "", records) +
           ChunkWithChecksum(records, Crc32(records), "zstd", Zstd(records)) +
           ChunkWithChecksum(records, 1, "", records) +
           ChunkWithChecksum(records, 1, "lz4", Lz4(records)));
  ASSERT_TRUE(damage);
  EXPECT_THAT(data_, testing::ElementsAre("x", "x"));
  EXPECT_EQ(damage->unreadable_chunks, 2u);
}

// ---- what the index saves -----------------------------------------------------------------------

class McapIndexTest : public McapTest, public testing::WithParamInterface<const char*> {
 protected:
  McapIndexTest() { unwanted_ = "/camera"; }

  static Bytes Camera() {
    return Record(4, LittleEndian<std::uint16_t>(6) + LittleEndian<std::uint16_t>(1) +
                         WithLength("/camera") + WithLength("cdr") +
                         LittleEndian<std::uint32_t>(0));
  }
  static Bytes Definitions() { return Schema() + Channel() + Camera(); }
  static Bytes Picture() { return Message(0, Bytes(300000, 'p'), 6); }

  static Bytes Compressed(const Bytes& records) {
    const std::string compression = GetParam();
    return Chunk(records, compression,
                 compression == "zstd"  ? Zstd(records)
                 : compression == "lz4" ? Lz4(records)
                                        : records);
  }
  /// A chunk that nothing can inflate.
  static Bytes Broken(const Bytes& records) { return Chunk(records, GetParam(), "broken"); }

  static Bytes Whole(const Bytes& data, std::uint32_t channels = 2) {
    const Bytes all = kMagic + Definitions() + data;
    return all + Ending(all, Definitions(), channels);
  }
};

TEST_P(McapIndexTest, DoesNotOpenAChunkOfUnwantedMessages) {
  const auto damage = Read(Whole(Broken(Picture()) + MessageIndex(6, {0}) +
                                 Compressed(Message(1, "x")) + MessageIndex(5, {0})));
  ASSERT_TRUE(damage);
  EXPECT_EQ(damage->Summary(), "");
  EXPECT_THAT(data_, testing::ElementsAre("x"));
}

TEST_P(McapIndexTest, ReadsAChunkUpToItsLastWantedMessage) {
  const Bytes x = Message(1, "x");
  const Bytes y = Message(2, "y");
  const Bytes picture = Picture();
  const Bytes records = x + picture + y + picture;
  const auto damage =
      Read(Whole(Compressed(records) + MessageIndex(5, {0, x.size() + picture.size()}) +
                 MessageIndex(6, {x.size(), x.size() + picture.size() + y.size()})));
  ASSERT_TRUE(damage);
  EXPECT_EQ(damage->Summary(), "");
  EXPECT_THAT(data_, testing::ElementsAre("x", "y"));
}

// What an index does not say, or says wrongly, loses no message.
TEST_P(McapIndexTest, ReadsTheWholeChunkWhereTheIndexDoesNotTell) {
  const Bytes chunk = Compressed(Message(1, "x"));
  const Bytes unknown_channel = MessageIndex(7, {0});
  const Bytes beyond_the_end = MessageIndex(5, {1000000}) + MessageIndex(6, {0});
  const auto damage = Read(Whole(chunk + unknown_channel + chunk + beyond_the_end + chunk));
  ASSERT_TRUE(damage);
  EXPECT_THAT(data_, testing::ElementsAre("x", "x", "x"));
}

TEST_P(McapIndexTest, ReadsEveryChunkOfAFileWhoseSummaryDefinesTooFewChannels) {
  const Bytes late =
      Record(4, LittleEndian<std::uint16_t>(9) + LittleEndian<std::uint16_t>(1) +
                    WithLength("/late") + WithLength("cdr") + LittleEndian<std::uint32_t>(0));
  // The channel is defined in a chunk of unwanted messages.
  const Bytes data = Compressed(Picture() + late) + MessageIndex(6, {0}) +
                     Compressed(Message(1, "x", 9)) + MessageIndex(9, {0});
  for (const Bytes& file : {Whole(data, 3), kMagic + Definitions() + data}) {
    data_.clear();
    ASSERT_TRUE(Read(file));
    EXPECT_THAT(data_, testing::ElementsAre("x"));
  }
}

INSTANTIATE_TEST_SUITE_P(Compressions, McapIndexTest, testing::Values("", "zstd", "lz4"),
                         [](const auto& compression) {
                           return *compression.param == '\0' ? "none"
                                                             : std::string(compression.param);
                         });

TEST_F(McapTest, RefusesWhatIsNoMcapFile) {
  const auto damage = Read("no such thing");
  ASSERT_FALSE(damage);
  EXPECT_THAT(damage.error().reason, testing::HasSubstr("is not an MCAP file"));
  EXPECT_FALSE(Read(""));
}

}  // namespace
}  // namespace telltale
