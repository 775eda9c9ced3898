#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "insist.hpp"
#include "telltale/client/recording/block_reader.hpp"
#include "telltale/client/recording/dataflash/dataflash_log.hpp"

namespace {

using telltale::DataFlashBytes;
using telltale::DataFlashColumn;
using telltale::DataFlashConsumer;
using telltale::DataFlashDamage;
using telltale::DataFlashFormat;
using telltale::DataFlashFraming;
using telltale::Insist;

/// Reads every column of every record, as no log of use would make the reader do.
class ReadingAll : public DataFlashConsumer {
 public:
  void Define(const DataFlashFormat&) override {}
  void Take(const DataFlashFormat& format, DataFlashBytes record) override {
    Insist(record.size() == format.length);
    record_bytes += record.size();
    for (const DataFlashColumn& column : format.columns) {
      const double number = telltale::DataFlashNumber(record, column);
      readable += number == number;
      readable += telltale::DataFlashText(record, column).size();
    }
  }
  std::uint64_t record_bytes = 0;
  std::uint64_t readable = 0;
};

struct Outcome {
  std::uint64_t record_bytes;
  std::uint64_t readable;
  DataFlashDamage damage;
  std::map<std::string, std::uint64_t> records;
  bool operator==(const Outcome&) const = default;
};

Outcome Frame(DataFlashBytes bytes, std::size_t block) {
  ReadingAll log;
  DataFlashFraming framing(log);
  const std::size_t done = telltale::TakeInBlocks(
      bytes, block,
      [&](DataFlashBytes part, bool at_end) { return framing.Consume(part, at_end); });
  Insist(done == bytes.size());
  return {log.record_bytes, log.readable, framing.Damage(), framing.RecordsByName()};
}

}  // namespace

/// Every byte is in a record or counted as skipped, whatever the blocks; nothing of a log is more
/// than its records; and every outcome can be put into words.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const DataFlashBytes bytes(data, size);
  const Outcome whole = Frame(bytes, std::max<std::size_t>(size, 1));
  Insist(whole.record_bytes + whole.damage.skipped_bytes == size);
  Insist(Frame(bytes, 1 + size % 300) == whole);

  telltale::DataFlashOptions options;
  if (size % 3 == 0) options.gps_instance = 1;
  if (size % 2 == 0) options.port_channel = 14;
  if (size % 5 == 0) options.starboard_channel = 1;
  const telltale::DataFlashLog log = telltale::ParseDataFlash(bytes, options);
  std::uint64_t records = 0;
  for (const auto& [name, count] : log.report.records) records += count;
  Insist(log.gnss.size() + log.heading.size() + log.thrusters.size() <= records);
  Insist(log.report.damage == whole.damage);
  Insist(!log.report.Summary().empty());
  for (const telltale::Refusal& lack : log.Lacks()) Insist(!lack.reason.empty());
  return 0;
}
