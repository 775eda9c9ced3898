#include "telltale/client/recording/sample_memory.hpp"

#include <malloc.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "telltale/core/base/format_number.hpp"
#include "telltale/core/base/median.hpp"

namespace telltale {
namespace {

constexpr std::array kRatesHz = {100.0, 50.0, 25.0, 10.0};
constexpr std::size_t kNewest = 9;  // of which up to four may have a wrong time

/// The period of a time; NaN of what is no number, which is like no other.
double PeriodOf(double time_s, double rate_hz) {
  return std::isfinite(time_s) ? std::floor(time_s * rate_hz) : NAN;
}

}  // namespace

// ---- one source ---------------------------------------------------------------------------------

bool SampleRows::IsInNextPeriod(double time_s) const {
  const std::size_t rows = Rows();
  if (rows == 0) return true;
  const double rate_hz = memory_->rate_hz_;
  return PeriodOf(time_s, rate_hz) != PeriodOf(TimeOf(rows - 1), rate_hz);
}

double SampleRows::NewestTime() const {
  std::vector<double> newest_s;
  const std::size_t rows = Rows();
  for (std::size_t row = rows - std::min(rows, kNewest); row < rows; ++row) {
    if (std::isfinite(TimeOf(row))) newest_s.push_back(TimeOf(row));
  }
  return newest_s.empty() ? NAN : Median(std::move(newest_s));
}

template <class Stays>
std::size_t SampleRows::KeepWhere(Stays stays) {
  const std::size_t rows = Rows();
  IsKept is_kept(rows);
  for (std::size_t row = 0; row < rows; ++row) is_kept[row] = stays(row);
  KeepOnly(is_kept);
  return rows - Rows();
}

// ---- the memory they share ----------------------------------------------------------------------

std::string SampleMemory::Summary() const {
  std::string text;
  if (old_ > 0) {
    text = std::to_string(old_) + " samples more than a day older than the newest left out";
  }
  if (rate_hz_ == 0.0) return text;
  if (!text.empty()) text += "; ";
  const std::string most = FormatSignificant(static_cast<double>(most_bytes_) * 1e-6, 2) + " MB";
  text += "thinned by whole samples to " + FormatNumber(rate_hz_, 0) +
          " Hz, since all would take more than " + most;
  if (of_older_halves_ > 0) {
    text += "; the oldest " + std::to_string(of_older_halves_) +
            " left out, since they would take more than that even so";
  }
  return text;
}

void SampleMemory::CountHeld() {
  held_bytes_ = 0;
  for (const SampleRows* rows : sources_) held_bytes_ += rows->Bytes();
}

bool SampleMemory::HasRoom() {
  CountHeld();
  return held_bytes_ <= most_bytes_ - most_bytes_ / 4;
}

void SampleMemory::MakeRoom() {
  // What sources gave back may be room enough.
  if (HasRoom()) return;
  LetGoOfOld();
  for (const double rate_hz : kRatesHz) {
    if (HasRoom()) break;
    if (rate_hz_ == 0.0 || rate_hz < rate_hz_) ThinTo(rate_hz);
  }
  if (!HasRoom()) LetGoOfOlderHalf();
  CountHeld();
  malloc_trim(0);  // else the process keeps what they leave behind
}

void SampleMemory::LetGoOfOld() {
  for (SampleRows* rows : sources_) {
    const double oldest_s = rows->NewestTime() - kLongestRecordingS;
    old_ += rows->KeepWhere([&](std::size_t row) { return !(rows->TimeOf(row) < oldest_s); });
  }
}

void SampleMemory::ThinTo(double rate_hz) {
  rate_hz_ = rate_hz;
  for (SampleRows* rows : sources_) {
    double period = NAN;
    rows->KeepWhere([&](std::size_t row) {
      const double before = period;
      period = PeriodOf(rows->TimeOf(row), rate_hz);
      return period != before;
    });
  }
}

void SampleMemory::LetGoOfOlderHalf() {
  for (SampleRows* rows : sources_) {
    const std::size_t half = rows->Rows() / 2;
    of_older_halves_ += rows->KeepWhere([&](std::size_t row) { return row >= half; });
  }
}

}  // namespace telltale
