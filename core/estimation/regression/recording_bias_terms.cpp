#include "telltale/core/estimation/regression/recording_bias_terms.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace telltale {
namespace {

// The least variance of cos psi and sin psi in any direction: that of a course that oscillates by
// 25 degrees to either side.
constexpr double kLeastVariance = 0.01;

}  // namespace

std::string_view Name(RecordingBiasModel recording_bias) {
  switch (recording_bias) {
    case RecordingBiasModel::kShared: return "SHARED";
    case RecordingBiasModel::kPerRecording: return "PER_RECORDING";
    case RecordingBiasModel::kPerRecordingNorthEast: return "PER_RECORDING_NORTH_EAST";
    case RecordingBiasModel::kUnknown: break;
  }
  return "UNKNOWN";
}

std::size_t RecordingBiasTerms::PerRecording() const {
  switch (recording_bias) {
    case RecordingBiasModel::kPerRecording: return 1;
    case RecordingBiasModel::kPerRecordingNorthEast: return 3;
    case RecordingBiasModel::kShared:
    case RecordingBiasModel::kUnknown: break;
  }
  return 0;
}

void RecordingBiasTerms::Fill(std::size_t recording, double psi_rad, std::span<double> row) const {
  std::fill(row.begin(), row.end(), 0.0);
  const std::size_t terms = PerRecording();
  if (terms == 0) return;
  const auto own = row.subspan(recording * terms, terms);
  own[0] = 1.0;
  if (terms == 1) return;
  own[1] = std::cos(psi_rad);
  own[2] = std::sin(psi_rad);
}

std::string_view RecordingBiasTermName(std::size_t term) {
  constexpr std::array<std::string_view, 3> kNames = {"1", "cos(psi)", "sin(psi)"};
  Require(term < kNames.size(), "a steady term");
  return kNames[term];
}

std::vector<bool> HeadingVaries(const PreparedDataset& dataset) {
  std::vector<bool> varies;
  for (std::size_t recording = 0; recording < dataset.Recordings(); ++recording) {
    double n = 0.0;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
    for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
      if (dataset.RecordingOf(s) != recording) continue;
      for (std::size_t k = dataset.segments[s].begin; k < dataset.segments[s].end; ++k) {
        const double psi = dataset.rows[k].eta.psi_rad;
        const Eigen::Vector2d heading(std::cos(psi), std::sin(psi));
        n += 1.0;
        sum += heading;
        squares += heading * heading.transpose();
      }
    }
    const Eigen::MatrixXd covariance = squares / n - sum / n * (sum / n).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
    varies.push_back(solver.eigenvalues()[0] > kLeastVariance);
  }
  return varies;
}

}  // namespace telltale
