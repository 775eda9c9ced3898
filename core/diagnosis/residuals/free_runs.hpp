#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/effects/augmented_boat.hpp"
#include "telltale/core/effects/augmented_model.hpp"

namespace telltale {

using DrivesBySegment = std::vector<std::vector<Drive>>;
class DriveCache;

/// The windows in which a velocity of a model passes kFreeRunDivergence, and how far it does.
struct Divergence {
  std::size_t windows = 0;
  double farthest = 0.0;  ///< the largest velocity over its limit; infinite where it is no number

  void Add(const Divergence& other);

  /// In more windows, or much farther: a velocity that is a little large where the other model's is
  /// licenses none without bound.
  bool IsWorseThan(const Divergence& other) const;
};

/// Free runs of models over non-overlapping windows of a recording, and their errors.
///
/// A window is divided into equal bins. In each the mean error (measured less predicted) is taken
/// of the antenna's position, along and across the measured heading, and of the heading. The sensor
/// chain is the model's: latency, lever arm and heading error act on what is predicted.
/// Shapes: errors are 3 bins x windows, by bin along (m), across (m), heading (rad).
/// The state in which a window starts is estimated, by least squares on the window's own errors
/// with the base model's derivatives, so that errors are what no start explains;
/// docs/concepts/diagnosis.md (82), (83).
class FreeRuns {
 public:
  /// Requires: a model with all three equations; horizon_s > 0. The dataset has to live on.
  FreeRuns(const PreparedDataset& dataset, const VesselModel& base, double horizon_s);
  FreeRuns(const PreparedDataset&& dataset, const VesselModel& base, double horizon_s) = delete;
  FreeRuns(FreeRuns&&) noexcept;
  FreeRuns& operator=(FreeRuns&&) noexcept;
  ~FreeRuns();

  std::size_t Windows() const { return windows_.size(); }
  Eigen::Index Rows() const { return 3 * bins_; }
  double HorizonS() const { return horizon_s_; }
  const PreparedDataset& Dataset() const { return *dataset_; }

  /// Errors of a model, the start of each window estimated.
  Eigen::MatrixXd Errors(const AugmentedModel& model) const;

  Divergence DivergenceOf(const AugmentedModel& model) const;

  /// Both, of the same free runs.
  struct Outcome {
    Eigen::MatrixXd errors;
    Divergence divergence;
  };
  Outcome OutcomeOf(const AugmentedModel& model) const;

  /// What a window went through, for maps and pictures.
  struct Circumstances {
    double time_s = 0.0;
    std::size_t first_row = 0;  ///< of the dataset
    std::size_t rows = 0;
  };
  Circumstances Of(std::size_t window) const;

  /// Predicted tracks of the body origin (north, east), one per window, at the window's steps.
  std::vector<std::vector<Eigen::Vector2d>> Tracks(const AugmentedModel& model) const;

 private:
  struct Fix {
    double time_s, north_m, east_m, cos_psi, sin_psi;
    Eigen::Index bin;
  };
  struct MeasuredHeading {
    double time_s, psi_rad;
    Eigen::Index bin;
  };
  struct Window {
    std::size_t segment = 0;
    std::size_t first_row = 0;
    std::vector<Fix> fixes;
    std::vector<MeasuredHeading> headings;
    Eigen::VectorXd per_bin;  ///< how many samples each mean is of
    Eigen::Matrix<double, Eigen::Dynamic, 6> by_start;
    Eigen::Matrix<double, 6, Eigen::Dynamic> start_estimator;  ///< the start that errors ask for
  };
  using Offset = Eigen::Matrix<double, 6, 1>;

  bool Collect(std::size_t segment, std::size_t first_row, Window& window) const;
  template <class Visit>
  void ForEachTrack(const AugmentedModel& model, const Offset& offset, Visit visit) const;
  Eigen::MatrixXd NoErrors() const;
  Eigen::MatrixXd RawErrors(const AugmentedModel& model, const Offset& offset) const;
  void AddRawErrors(const Window& window, const AugmentedBoat& boat, double from_s,
                    const std::vector<Pose>& track, Eigen::Ref<Eigen::VectorXd> error) const;
  void EstimateStarts(Eigen::MatrixXd& errors) const;

  /// The drives of each segment, from its first row on. Boats that are driven alike, as most of
  /// those that are compared are, share them.
  std::shared_ptr<const DrivesBySegment> DrivesOf(const AugmentedBoat& boat) const;

  const PreparedDataset* dataset_;
  double horizon_s_;
  std::size_t rows_;   ///< sampling periods of a window
  std::size_t steps_;  ///< of simulation, in a row's period
  double step_s_;
  Eigen::Index bins_;
  std::vector<Window> windows_;
  std::unique_ptr<DriveCache> drive_cache_;
};

}  // namespace telltale
