#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"

namespace telltale {

/// The constant disturbances that the recordings of a dataset may have. kShared: one constant for
/// all, the regressor "1". kPerRecording: a constant of its own for each, in the boat's frame.
/// kPerRecordingNorthEast: on top a part that stands in the north-east-down frame.
enum class RecordingBiasModel { kUnknown, kShared, kPerRecording, kPerRecordingNorthEast };

std::string_view Name(RecordingBiasModel recording_bias);

/// One more column for each bias term of each recording, after those of Regressors():
/// docs/concepts/model.md (70). Columns are by recording, and within each 1, cos psi, sin psi or 1
/// alone. None for kShared.
struct RecordingBiasTerms {
  RecordingBiasModel recording_bias = RecordingBiasModel::kShared;
  std::size_t recordings = 1;

  std::size_t PerRecording() const;
  std::size_t Count() const { return recordings * PerRecording(); }

  /// Writes the terms of an instant, one value for each column.
  void Fill(std::size_t recording, double psi_rad, std::span<double> row) const;
};

/// Name of a term, by its place in a recording: "1", "cos(psi)", "sin(psi)".
std::string_view RecordingBiasTermName(std::size_t term);

/// Recordings whose heading hardly varies, by index: there a force fixed in the north-east-down
/// frame is indistinguishable from one in the body frame. Assumes: rows of one recording in one
/// run of segments.
std::vector<bool> HeadingVaries(const PreparedDataset& dataset);

}  // namespace telltale
