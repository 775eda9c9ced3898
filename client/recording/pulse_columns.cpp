#include "telltale/client/recording/pulse_columns.hpp"

#include <bit>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

/// NaN, which stands for no output, is the same as itself.
bool AreSame(float a_us, float b_us) {
  return std::bit_cast<std::uint32_t>(a_us) == std::bit_cast<std::uint32_t>(b_us);
}

}  // namespace

void PulseColumns::Add(double time_s, std::span<const float> pulse_us) {
  if (!HasPlaceFor(time_s)) return;
  std::size_t added = sizeof(double);
  if (columns_.empty()) {
    for (const float first_us : pulse_us) columns_.push_back({first_us, {}});
  }
  Require(pulse_us.size() == columns_.size(), "as many outputs as the time before");
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    Column& column = columns_[i];
    if (column.pulse_us.empty()) {
      if (AreSame(pulse_us[i], column.first_us)) continue;
      column.pulse_us.assign(times_s_.size(), column.first_us);
      added += times_s_.size() * sizeof(float);
    }
    AddRow(column.pulse_us, pulse_us[i]);
    added += sizeof(float);
  }
  AddRow(times_s_, time_s);
  Added(added);
}

std::size_t PulseColumns::Bytes() const {
  std::size_t bytes = times_s_.size() * sizeof(double);
  for (const Column& column : columns_) bytes += column.pulse_us.size() * sizeof(float);
  return bytes;
}

void PulseColumns::KeepOnly(const std::vector<bool>& is_kept) {
  KeepRows(times_s_, is_kept);
  for (Column& column : columns_) {
    if (column.pulse_us.empty()) continue;
    KeepRows(column.pulse_us, is_kept);
  }
}

std::vector<ThrusterSample> PulseColumns::Of(int port, int starboard) const {
  std::vector<ThrusterSample> commands;
  if (times_s_.empty()) return commands;
  const Column& of_port = columns_.at(static_cast<std::size_t>(port - 1));
  const Column& of_starboard = columns_.at(static_cast<std::size_t>(starboard - 1));
  commands.reserve(times_s_.size());
  for (std::size_t i = 0; i < times_s_.size(); ++i) {
    commands.push_back({times_s_[i], of_port.At(i), of_starboard.At(i)});
  }
  return commands;
}

}  // namespace telltale
