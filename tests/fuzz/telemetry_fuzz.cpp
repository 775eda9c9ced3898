#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>

#include "insist.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/core/data/check/input_check.hpp"

namespace {

using telltale::Insist;
namespace fs = std::filesystem;

constexpr char kBetweenFiles = '\f';  // no number and no name holds one
constexpr std::array kFiles = {"gnss.csv", "heading.csv", "thrusters.csv"};

/// The files that the text holds one after the other; a file that it ends before is missing.
void WriteFiles(std::string_view text, const fs::path& folder) {
  bool is_there = true;
  for (const char* name : kFiles) {
    if (!is_there) {
      fs::remove(folder / name);
      continue;
    }
    const std::size_t end = text.find(kBetweenFiles);
    std::ofstream(folder / name, std::ios::binary | std::ios::trunc) << text.substr(0, end);
    is_there = end != std::string_view::npos;
    if (is_there) text.remove_prefix(end + 1);
  }
}

void InsistOnOrder(const telltale::Recording& recording) {
  const auto is_in_order = [](const auto& samples) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (!std::isfinite(samples[i].time_s)) return false;
      if (i > 0 && !(samples[i - 1].time_s < samples[i].time_s)) return false;
    }
    return true;
  };
  Insist(is_in_order(recording.gnss));
  Insist(is_in_order(recording.heading));
  Insist(is_in_order(recording.thrusters));
}

/// Digits that times beyond some months have no bits for are not written.
void InsistOnReadingBack(const telltale::Recording& recording) {
  static const telltale::TemporaryFolder written;
  telltale::WriteTelemetryLog(written.Path(), recording);
  const auto read = telltale::ReadTelemetryLog(written.Path());
  Insist(read && read->lacks.empty());
  Insist(read->channels.gnss.size() == recording.gnss.size());
  Insist(read->channels.heading.size() == recording.heading.size());
  Insist(read->channels.thrusters.size() == recording.thrusters.size());
  for (std::size_t i = 0; i < recording.gnss.size(); ++i) {
    const auto& was = recording.gnss[i];
    const auto& is = read->channels.gnss[i];
    const double rounding_s = 1e-9 + 1e-15 * std::abs(was.time_s);
    Insist(std::abs(is.time_s - was.time_s) <= rounding_s);
    Insist(std::abs(is.latitude_deg - was.latitude_deg) <= 1e-9);
    Insist(std::abs(is.longitude_deg - was.longitude_deg) <= 1e-9);
  }
}

}  // namespace

/// A folder of any three files gives its channels or says what it lacks; what is admitted of them
/// is in order, and is read back as it is written; the check takes whatever was recorded.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const telltale::TemporaryFolder folder;
  WriteFiles({reinterpret_cast<const char*>(data), size}, folder.Path());
  const std::size_t memory = size % 3 == 0 ? 1024 : telltale::kReadingBytes;
  auto log = telltale::ReadTelemetryLog(folder.Path(), memory);
  Insist(log.has_value());
  for (const telltale::Refusal& lack : log->lacks) Insist(!lack.reason.empty());
  if (!log->lacks.empty()) return 0;

  const telltale::RawChannels& channels = log->channels;
  const auto check = telltale::CheckInput(channels.gnss, channels.heading, channels.thrusters, {});
  for (const telltale::Refusal& fault : check.faults) Insist(!fault.reason.empty());

  const std::size_t taken = channels.Size();  // before they are given away
  const auto admitted = telltale::Admit(std::move(log->channels));
  if (!admitted) {
    Insist(!admitted.error().reason.empty());
    return 0;
  }
  const telltale::Recording& recording = admitted->recording;
  Insist(admitted->evicted <= taken);
  InsistOnOrder(recording);
  InsistOnReadingBack(recording);
  return 0;
}
