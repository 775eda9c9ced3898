#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace telltale {

/// What the samples of a recording may take while it is read. Vectors that grow and the steps that
/// follow take up to as much again.
inline constexpr std::size_t kReadingBytes = 64'000'000;

/// Of a recording that is longer the end counts, as long as this.
inline constexpr double kLongestRecordingS = 86400.0;

class SampleRows;

/// The memory that the sources of a recording share while it is read. All samples stay until they
/// take more than `most_bytes`; then, no further than makes a quarter of it free:
///
/// 1. Samples older than the newest of their source by more than kLongestRecordingS go.
/// 2. Of each source one sample stays in each period of a rate, the first: at 100, 50, 25, 10 Hz.
/// 3. The older half of each source goes.
///
/// Samples are never changed. Later ones are thinned to the same rate. Newest is the median of the
/// last few, so that one wrong time moves nothing.
class SampleMemory {
 public:
  explicit SampleMemory(std::size_t most_bytes = kReadingBytes) : most_bytes_(most_bytes) {}

  /// "thinned by whole samples to 50 Hz ..." for people; empty where all samples stay.
  std::string Summary() const;

 private:
  friend SampleRows;

  void Share(SampleRows& rows) { sources_.push_back(&rows); }
  void Add(std::size_t bytes) {
    held_bytes_ += bytes;
    if (held_bytes_ > most_bytes_) MakeRoom();
  }
  void MakeRoom();
  void CountHeld();
  bool HasRoom();
  void LetGoOfOld();
  void ThinTo(double rate_hz);
  void LetGoOfOlderHalf();

  std::size_t most_bytes_;
  std::size_t held_bytes_ = 0;
  std::vector<SampleRows*> sources_;
  double rate_hz_ = 0.0;  ///< of which each period has one sample; 0: all stay
  std::uint64_t old_ = 0;
  std::uint64_t of_older_halves_ = 0;
};

/// The samples of one source, in the order in which they come, a row each.
class SampleRows {
 public:
  /// Assumes: the memory and the rows stay where they are until the last sample is added.
  explicit SampleRows(SampleMemory& memory) : memory_(&memory) { memory.Share(*this); }
  SampleRows(const SampleRows&) = delete;
  SampleRows& operator=(const SampleRows&) = delete;
  virtual ~SampleRows() = default;

 protected:
  /// Whether a sample of this time is to be added behind the last; always where it is no number.
  bool HasPlaceFor(double time_s) {
    if (memory_->rate_hz_ == 0.0) return true;
    return IsInNextPeriod(time_s);
  }

  /// Told after a row has been added.
  void Added(std::size_t bytes) { memory_->Add(bytes); }

 private:
  friend SampleMemory;
  using IsKept = std::vector<bool>;  ///< by row

  virtual std::size_t Rows() const = 0;
  virtual std::size_t Bytes() const = 0;
  virtual double TimeOf(std::size_t row) const = 0;
  virtual void KeepOnly(const IsKept& is_kept) = 0;

  bool IsInNextPeriod(double time_s) const;
  double NewestTime() const;
  /// Keeps the rows of which `stays` is true. Returns how many go.
  template <class Stays>
  std::size_t KeepWhere(Stays stays);

  SampleMemory* memory_;
};

/// Adds a value to a column. It grows by four: what has not been written to takes no memory, and
/// fewer copies are made.
template <class Value>
void AddRow(std::vector<Value>& column, const Value& value) {
  constexpr std::size_t kFirst = 64;
  if (column.size() == column.capacity()) column.reserve(std::max(kFirst, 4 * column.size()));
  column.push_back(value);
}

/// Leaves of a column what is kept, in no more memory than that takes.
template <class Value>
void KeepRows(std::vector<Value>& column, const std::vector<bool>& is_kept) {
  std::size_t kept = 0;
  for (std::size_t row = 0; row < column.size(); ++row) {
    if (is_kept[row]) column[kept++] = column[row];
  }
  column.resize(kept);
  column.shrink_to_fit();
}

/// Samples of one type.
template <class Sample>
class SampleSeries : public SampleRows {
 public:
  using SampleRows::SampleRows;

  void Add(const Sample& sample) {
    if (!HasPlaceFor(sample.time_s)) return;
    AddRow(samples_, sample);
    Added(sizeof(Sample));
  }

  const std::vector<Sample>& Samples() const { return samples_; }
  std::vector<Sample> Release() && { return std::move(samples_); }

  /// Frees what they take.
  void Clear() {
    if (!samples_.empty()) std::vector<Sample>().swap(samples_);
  }

 private:
  std::size_t Rows() const override { return samples_.size(); }
  std::size_t Bytes() const override { return samples_.size() * sizeof(Sample); }
  double TimeOf(std::size_t row) const override { return samples_[row].time_s; }
  void KeepOnly(const std::vector<bool>& is_kept) override { KeepRows(samples_, is_kept); }

  std::vector<Sample> samples_;
};

}  // namespace telltale
