#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "telltale/client/recording/sample_memory.hpp"
#include "telltale/core/data/samples.hpp"

namespace telltale {

/// The pulse widths of all outputs of an autopilot over time. Which of them drive the thrusters is
/// often known only once a recording has ended, so all are kept, in little memory: eight bytes a
/// time, and four for each output that changes.
class PulseColumns : public SampleRows {
 public:
  using SampleRows::SampleRows;

  /// Requires: as many outputs as the time before.
  void Add(double time_s, std::span<const float> pulse_us);

  const std::vector<double>& TimesS() const { return times_s_; }

  /// The commands of two outputs, counted from 1. Requires: outputs that have been added.
  std::vector<ThrusterSample> Of(int port, int starboard) const;

 private:
  struct Column {
    float first_us = 0.0F;
    std::vector<float> pulse_us;  ///< empty: always first_us

    float At(std::size_t i) const { return pulse_us.empty() ? first_us : pulse_us[i]; }
  };

  std::size_t Rows() const override { return times_s_.size(); }
  std::size_t Bytes() const override;
  double TimeOf(std::size_t row) const override { return times_s_[row]; }
  void KeepOnly(const std::vector<bool>& is_kept) override;

  std::vector<double> times_s_;
  std::vector<Column> columns_;
};

}  // namespace telltale
