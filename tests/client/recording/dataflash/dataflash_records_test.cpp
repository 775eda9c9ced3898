#include "telltale/client/recording/dataflash/dataflash_records.hpp"
#include "telltale/client/recording/block_reader.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/dataflash_writer.hpp"

namespace telltale {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Keeps a copy of every record.
class CollectingConsumer : public DataFlashConsumer {
 public:
  void Define(const DataFlashFormat& format) override { definitions.push_back(format); }
  void Take(const DataFlashFormat& format, DataFlashBytes record) override {
    records.emplace_back(format, Bytes(record.begin(), record.end()));
  }
  double Number(std::size_t index, const char* label) const {
    const auto& [format, bytes] = records.at(index);
    return DataFlashNumber(bytes, *format.Find(label));
  }
  std::string Text(std::size_t index, const char* label) const {
    const auto& [format, bytes] = records.at(index);
    return std::string(DataFlashText(bytes, *format.Find(label)));
  }

  std::vector<DataFlashFormat> definitions;
  std::vector<std::pair<DataFlashFormat, Bytes>> records;
};

struct Outcome {
  CollectingConsumer log;
  DataFlashDamage damage;
  std::map<std::string, std::uint64_t> records;
};

Outcome Frame(const Bytes& bytes) {
  Outcome outcome;
  DataFlashFraming framing(outcome.log);
  EXPECT_EQ(framing.Consume(bytes, true), bytes.size());
  outcome.damage = framing.Damage();
  outcome.records = framing.RecordsByName();
  return outcome;
}

DataFlashWriter Counter() {  // a message of one byte: records of four bytes
  DataFlashWriter writer;
  return writer.Fmt(10, 4, "CNT", "B", "N");
}

// IEEE 754-2008 binary16, worked by hand: (-1)^s 2^(e-15) (1 + f/1024), subnormals 2^-14 f/1024.
TEST(HalfToDouble, MatchesTheStandardsValues) {
  const std::vector<std::pair<std::uint16_t, double>> truths = {
      {0x0000, 0.0},
      {0x0001, 5.9604644775390625e-08},  // 2^-24, the least subnormal
      {0x03FF, 6.0975551605224609e-05},  // 2^-14 * 1023/1024, the greatest subnormal
      {0x0400, 6.103515625e-05},         // 2^-14, the least normal
      {0x3555, 0.333251953125},
      {0x3BFF, 0.99951171875},
      {0x3C00, 1.0},
      {0x3C01, 1.0009765625},
      {0x4248, 3.140625},
      {0xC000, -2.0},
      {0x7BFF, 65504.0},
      {0xFBFF, -65504.0},
      {0x7C00, std::numeric_limits<double>::infinity()},
      {0xFC00, -std::numeric_limits<double>::infinity()}};
  for (const auto& [bits, value] : truths) EXPECT_EQ(HalfToDouble(bits), value) << bits;
  EXPECT_TRUE(std::signbit(HalfToDouble(0x8000)));
  EXPECT_TRUE(std::isnan(HalfToDouble(0x7E00)));
  EXPECT_TRUE(std::isnan(HalfToDouble(0xFC01)));
}

TEST(DataFlashNumber, ReadsEveryNumericFormatWithItsScale) {
  DataFlashWriter writer;
  writer.Fmt(1, 62, "NUM", "bBhHiIfdcCeELMqQ", "b,B,h,H,i,I,f,d,c,C,e,E,L,M,q,Q");
  writer.Fmt(2, 5, "HALF", "g", "g");
  writer.Header(1).I8(-128).U8(255).I16(-32768).U16(65535).I32(-2147483648).U32(4294967295);
  writer.F32(-0.15625f).F64(0.1).I16(-4500).U16(35999).I32(-123456).U32(4000000001);
  writer.I32(-353547178).U8(15).I64(-9007199254740992).U64(9007199254740992);
  writer.Header(2).U16(0x4248);
  const Outcome outcome = Frame(writer.Bytes());
  ASSERT_EQ(outcome.log.records.size(), 4u);
  const auto value = [&](const char* label) { return outcome.log.Number(2, label); };
  EXPECT_EQ(value("b"), -128);
  EXPECT_EQ(value("B"), 255);
  EXPECT_EQ(value("h"), -32768);
  EXPECT_EQ(value("H"), 65535);
  EXPECT_EQ(value("i"), -2147483648.0);
  EXPECT_EQ(value("I"), 4294967295.0);
  EXPECT_EQ(value("f"), -0.15625);
  EXPECT_EQ(value("d"), 0.1);
  EXPECT_EQ(value("c"), -45.0);
  EXPECT_EQ(value("C"), 359.99);
  EXPECT_EQ(value("e"), -1234.56);
  EXPECT_EQ(value("E"), 40000000.01);
  EXPECT_EQ(value("L"), -35.3547178);
  EXPECT_EQ(value("M"), 15);
  EXPECT_EQ(value("q"), -9007199254740992.0);
  EXPECT_EQ(value("Q"), 9007199254740992.0);
  EXPECT_EQ(outcome.log.Number(3, "g"), 3.140625);
}

TEST(DataFlashText, ReadsTextUpToItsNulAndNothingElse) {
  DataFlashWriter writer;
  writer.Fmt(1, 152, "TXT", "nNZaB", "n,N,Z,a,B");
  writer.Header(1)
      .Text("abcd", 4)
      .Text("SERVO1_FUNCTION", 16)
      .Text("hello", 64)
      .Text("xyz", 64)
      .U8(65);
  const Outcome outcome = Frame(writer.Bytes());
  ASSERT_EQ(outcome.log.records.size(), 2u);
  EXPECT_EQ(outcome.log.Text(1, "n"), "abcd");  // full width, no NUL
  EXPECT_EQ(outcome.log.Text(1, "N"), "SERVO1_FUNCTION");
  EXPECT_EQ(outcome.log.Text(1, "Z"), "hello");
  EXPECT_EQ(outcome.log.Text(1, "a"), "");
  EXPECT_EQ(outcome.log.Text(1, "B"), "");
  EXPECT_TRUE(std::isnan(outcome.log.Number(1, "Z")));
  EXPECT_TRUE(std::isnan(outcome.log.Number(1, "a")));
}

TEST(DataFlashFraming, ASoundLogHasNoDamage) {
  const Outcome outcome = Frame(Rover4Writer().WholeLog(50).Bytes());
  EXPECT_EQ(outcome.damage, DataFlashDamage{});
  const std::map<std::string, std::uint64_t> expected = {{"FMT", 9},   {"UNIT", 1},  {"MULT", 1},
                                                         {"FMTU", 1},  {"PARM", 10}, {"GPS", 50},
                                                         {"ATT", 100}, {"RCOU", 100}};
  EXPECT_EQ(outcome.records, expected);
}

TEST(DataFlashFraming, ARecordThatLostBytesIsCorruptAndTheNextIsFound) {
  DataFlashWriter writer = Counter();
  writer.Header(10).U8(1).Header(10).Header(10).U8(3);  // the second lost its only field
  const Outcome outcome = Frame(writer.Bytes());
  ASSERT_EQ(outcome.records.at("CNT"), 2u);
  EXPECT_EQ(outcome.log.Number(1, "N"), 1);
  EXPECT_EQ(outcome.log.Number(2, "N"), 3);
  EXPECT_EQ(outcome.damage.corrupt_records, 1u);
  EXPECT_EQ(outcome.damage.skipped_bytes, 3u);
}

TEST(DataFlashFraming, StrayBytesCostTheRecordBeforeThemBecauseNothingConfirmsIt) {
  DataFlashWriter writer = Counter();
  writer.Header(10).U8(1).Header(10).U8(2).U8(0).U8(0xA3).U8(7).Header(10).U8(3);
  const Outcome outcome = Frame(writer.Bytes());
  ASSERT_EQ(outcome.records.at("CNT"), 2u);
  EXPECT_EQ(outcome.log.Number(2, "N"), 3);
  EXPECT_EQ(outcome.damage.corrupt_records, 1u);
  EXPECT_EQ(outcome.damage.skipped_bytes, 7u);
}

TEST(DataFlashFraming, LeadingJunkIsSkipped) {
  DataFlashWriter writer;
  writer.U8(1).U8(2).U8(3).Fmt(10, 4, "CNT", "B", "N").Header(10).U8(9);
  const Outcome outcome = Frame(writer.Bytes());
  EXPECT_EQ(outcome.records.at("CNT"), 1u);
  EXPECT_EQ(outcome.damage.corrupt_records, 1u);
  EXPECT_EQ(outcome.damage.skipped_bytes, 3u);
}

TEST(DataFlashFraming, AHeaderInsideAPayloadIsNotMistakenForARecord) {
  DataFlashWriter writer;
  writer.Fmt(11, 11, "LONG", "Q", "V");
  writer.Header(11).U8(0xA3).U8(0x95).U8(11).U8(0).U8(0xA3).U8(0x95).U8(128).U8(0);
  writer.Header(11).U64(5);
  const Outcome outcome = Frame(writer.Bytes());
  EXPECT_EQ(outcome.records.at("LONG"), 2u);
  EXPECT_EQ(outcome.damage, DataFlashDamage{});
}

TEST(DataFlashFraming, RecordsOfAnUndefinedTypeAreCountedOneByOne) {
  DataFlashWriter writer = Counter();
  writer.Header(10).U8(1).Header(99).U64(1).Header(99).U64(2).Header(10).U8(2);
  const Outcome outcome = Frame(writer.Bytes());
  EXPECT_EQ(outcome.records.at("CNT"), 2u);
  EXPECT_EQ(outcome.damage.undefined_records, 2u);
  EXPECT_EQ(outcome.damage.corrupt_records, 0u);
  EXPECT_EQ(outcome.damage.skipped_bytes, 22u);
}

TEST(DataFlashFraming, ACutRecordAtTheEndIsTruncatedNotCorrupt) {
  DataFlashWriter writer;
  writer.Fmt(11, 11, "LONG", "Q", "V").Header(11).U64(1);
  const std::size_t whole = writer.size();
  writer.Header(11).U64(2);
  for (std::size_t cut = whole + 1; cut < writer.size(); ++cut) {
    Bytes bytes = writer.Bytes();
    bytes.resize(cut);
    const Outcome outcome = Frame(bytes);
    EXPECT_EQ(outcome.records.at("LONG"), 1u);
    EXPECT_EQ(outcome.damage.truncated_bytes, cut - whole);
    EXPECT_EQ(outcome.damage.skipped_bytes, cut - whole);
    EXPECT_EQ(outcome.damage.corrupt_records, 0u);
  }
}

TEST(DataFlashFraming, AbsurdDefinitionsAreRefused) {
  const struct {
    const char* what;
    int length;
    const char* name;
    const char* format;
    const char* columns;
  } cases[] = {{"zero length", 0, "BAD", "B", "N"},
               {"shorter than a header", 2, "BAD", "", ""},
               {"length and format disagree", 255, "BAD", "B", "N"},
               {"unknown format character", 4, "BAD", "y", "N"},
               {"fewer labels than characters", 5, "BAD", "BB", "N"},
               {"more labels than characters", 4, "BAD", "B", "N,M"},
               {"no name", 4, "", "B", "N"},
               {"name of control characters", 4, "\x01\x02", "B", "N"}};
  for (const auto& bad : cases) {
    DataFlashWriter writer = Counter();
    writer.Fmt(20, bad.length, bad.name, bad.format, bad.columns).Header(10).U8(1);
    const Outcome outcome = Frame(writer.Bytes());
    EXPECT_EQ(outcome.damage.malformed_definitions, 1u) << bad.what;
    EXPECT_EQ(outcome.records.at("CNT"), 1u) << bad.what;
    EXPECT_EQ(outcome.damage.skipped_bytes, 0u) << bad.what;
  }
}

TEST(DataFlashFraming, ATypeThatCannotBeReadIsStillPassedOverByItsLength) {
  DataFlashWriter writer = Counter();
  writer.Fmt(20, 7, "NEW", "y", "Later").Header(20).U32(0).Header(10).U8(1);
  const Outcome outcome = Frame(writer.Bytes());
  EXPECT_EQ(outcome.records.at("type 20"), 1u);
  EXPECT_EQ(outcome.records.at("CNT"), 1u);
  EXPECT_EQ(outcome.damage.skipped_bytes, 0u);
  EXPECT_EQ(outcome.damage.corrupt_records, 0u);
}

TEST(DataFlashFraming, FmtItselfCannotBeRedefined) {
  DataFlashWriter writer;
  writer.Fmt(128, 4, "FMT", "B", "N").Fmt(10, 4, "CNT", "B", "N").Header(10).U8(1);
  const Outcome outcome = Frame(writer.Bytes());
  EXPECT_EQ(outcome.damage.malformed_definitions, 1u);
  EXPECT_EQ(outcome.records.at("CNT"), 1u);
}

TEST(DataFlashFraming, RepeatedDefinitionsAreNoRedefinition) {
  DataFlashWriter writer = Counter();
  writer.Header(10).U8(1).Raw(Counter().Bytes()).Header(10).U8(2);
  const Outcome outcome = Frame(writer.Bytes());
  EXPECT_EQ(outcome.damage, DataFlashDamage{});
  EXPECT_EQ(outcome.records.at("CNT"), 2u);
}

TEST(DataFlashFraming, ARedefinitionRulesTheRecordsAfterIt) {
  DataFlashWriter writer = Counter();
  writer.Header(10).U8(1).Fmt(10, 5, "WIDE", "H", "N").Header(10).U16(500);
  const Outcome outcome = Frame(writer.Bytes());
  EXPECT_EQ(outcome.damage.redefinitions, 1u);
  EXPECT_EQ(outcome.records.at("CNT"), 1u);
  EXPECT_EQ(outcome.records.at("WIDE"), 1u);
  EXPECT_EQ(outcome.log.Number(3, "N"), 500);
}

TEST(DataFlashFraming, HowALogIsCutIntoBlocksDoesNotMatter) {
  Bytes bytes = Rover4Writer().WholeLog(20).Bytes();
  bytes[1500] ^= 0x40;
  bytes.erase(bytes.begin() + 2000, bytes.begin() + 2007);
  bytes.resize(bytes.size() - 5);
  const Outcome whole = Frame(bytes);
  for (const std::size_t block : {1u, 7u, 258u, 1000u}) {
    CollectingConsumer log;
    DataFlashFraming framing(log);
    const std::size_t done = TakeInBlocks(bytes, block, [&](DataFlashBytes part, bool at_end) {
      return framing.Consume(part, at_end);
    });
    EXPECT_EQ(done, bytes.size());
    EXPECT_EQ(framing.Damage(), whole.damage) << "blocks of " << block;
    EXPECT_EQ(log.records, whole.log.records) << "blocks of " << block;
  }
}

}  // namespace
}  // namespace telltale
