#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/weak_form/delay_derivatives.hpp"
#include "telltale/core/estimation/weak_form/filtering_loss.hpp"
#include "telltale/core/estimation/weak_form/projection.hpp"
#include "telltale/core/vessel/body_dynamics.hpp"
#include "telltale/core/vessel/disturbance.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// One equation's supports as a model predicts them. Shapes: supports x columns sought.
struct PredictedSupports {
  Eigen::MatrixXd Z;               ///< int phi_k Phi(nu, T) dt
  Eigen::MatrixXd filtering_loss;  ///< int phi_k (F Phi(nu) - Phi(F nu)) dt, FilteringLoss
  Eigen::MatrixXd by_delay;        ///< supports x kDelays, DelayDerivatives
};

/// Velocities that a model predicts from the commands, docs/concepts/model.md (31). They share the
/// commands with the boat and no noise with its sensors. The simulation restarts from measured
/// velocities every ten seconds, some rows before the supports that it serves, so that neither the
/// noise of the start nor an error of the model accumulates.
class Instruments {
 public:
  /// Keeps references to both.
  Instruments(const PreparedDataset& dataset, const WeakProblem& problem);

  /// The supports of each equation with columns sought, under the given thrust. A velocity whose
  /// equation has no columns sought stays as measured. `disturbances`: by recording.
  std::array<PredictedSupports, 3> Predict(const VesselModel& model,
                                           const std::vector<ConstantDisturbance>& disturbances,
                                           const std::array<std::vector<std::size_t>, 3>& columns,
                                           const FilteredThrust& thrust) const;

 private:
  /// Rows that are simulated from one start, and those of them in which supports are centred.
  struct Part {
    std::size_t recording = 0;
    RowRange rows;
    RowRange centres;
  };

  std::array<PredictedSupports, 3> ZeroSupports(
      const std::array<bool, 3>& simulated, const std::array<std::size_t, 3>& projected_as) const;
  std::vector<Part> Parts() const;
  void Simulate(const BodyDynamics& dynamics, const ConstantDisturbance& disturbance,
                const std::array<bool, 3>& simulated, const FilteredThrust& thrust,
                const Part& part, std::vector<PredictedInstant>& predicted) const;
  RegressorRows PredictedRows(Equation equation, const FilteredThrust& thrust,
                              const std::vector<PredictedInstant>& predicted,
                              const Part& part) const;
  void ProjectPart(std::size_t equation, const FilteredThrust& thrust,
                   const std::vector<PredictedInstant>& predicted, const Part& part,
                   const FilteringLoss& loss, PredictedSupports& supports) const;
  void AddDelayDerivatives(std::size_t equation, const Part& part,
                           const DelayDerivatives& derivatives, Eigen::MatrixXd& by_delay) const;
  template <class Visit>
  void ForEachSupport(std::size_t equation, const Part& part, Visit visit) const;

  const PreparedDataset& dataset_;
  const WeakProblem& problem_;
  Nu fastest_;  ///< of each velocity as measured; limits the simulation
  std::size_t restart_rows_ = 1;
  std::size_t lead_in_rows_ = 1;
  Eigen::VectorXd kernel_;        ///< F on intervals
  Eigen::VectorXd smoothed_phi_;  ///< phi convolved with F
};

}  // namespace telltale
