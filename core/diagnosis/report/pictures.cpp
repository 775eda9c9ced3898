#include "telltale/core/diagnosis/report/pictures.hpp"

#include <algorithm>
#include <cmath>

namespace telltale {
namespace {

/// Mean heading and speed, measured track and region of a window.
void FillMotion(const PreparedDataset& recording, const FreeRuns::Circumstances& window,
                WindowPicture& picture) {
  const auto instants = static_cast<double>(window.rows + 1);
  for (std::size_t k = 0; k <= window.rows; ++k) {
    const PreparedRow& row = recording.rows[window.first_row + k];
    picture.measured.emplace_back(row.eta.x_m, row.eta.y_m);
    picture.psi_rad += row.eta.psi_rad / instants;
    picture.speed_m_s += std::hypot(row.nu.u, row.nu.v) / instants;
  }
  picture.region = recording.rows[window.first_row + window.rows / 2].region;
}

}  // namespace

std::vector<WindowPicture> PicturesOf(const PreparedDataset& recording, const HorizonErrors& main,
                                      const AugmentedModel& boat, const Conclusion& conclusion) {
  const FreeRuns& runs = main.runs;
  const Eigen::VectorXd before = main.SquaredGapsOf(kAllChannels);
  Eigen::VectorXd after = before;
  Eigen::MatrixXd errors_after = main.errors;
  AugmentedModel with = boat;
  if (conclusion.is_likely) {
    after = CrossValidatedSquaredGaps(conclusion.cross_validated, runs, main.floor, kAllChannels);
    errors_after = conclusion.cross_validated.errors;
    with = boat.With(conclusion.folds.front().effects);
  }
  const auto tracks_before = runs.Tracks(boat);
  const auto tracks_after = runs.Tracks(with);
  std::vector<WindowPicture> pictures;
  for (std::size_t w = 0; w < runs.Windows(); ++w) {
    const auto i = static_cast<Eigen::Index>(w);
    WindowPicture& picture = pictures.emplace_back();
    picture.time_s = runs.Of(w).time_s;
    picture.before = std::sqrt(before[i]);
    picture.after = std::sqrt(std::max(after[i], 0.0));
    picture.error_before = main.errors.col(i).tail<3>();
    picture.error_after = errors_after.col(i).tail<3>();
    picture.predicted_before = tracks_before[w];
    picture.predicted_after = tracks_after[w];
    FillMotion(recording, runs.Of(w), picture);
  }
  return pictures;
}

}  // namespace telltale
