#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/weak_form/weak_form.hpp"
#include "telltale/core/vessel/body_dynamics.hpp"
#include "telltale/core/vessel/disturbance.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// The windows of one equation as a model predicts them. Shapes: windows x columns sought.
struct PredictedSupports {
  Eigen::MatrixXd Z;  ///< int phi_k Phi(nu, T) dt
  Eigen::MatrixXd
      filtering_loss;  ///< int phi_k (F Phi(nu) - Phi(F nu)) dt: products of filtered velocities
                       ///< are not filtered products. Zero where Phi is linear in nu
};

/// Velocities that a model predicts from the commands, docs/concepts/model.md (31): they share the
/// commands with the boat and no noise with its sensors. Started anew from measured ones every ten
/// seconds, a while before the windows they serve, so that neither the noise of the start nor an
/// error of the model goes far.
class Instruments {
 public:
  /// Keeps references to both.
  Instruments(const PreparedDataset& dataset, const WeakProblem& problem);

  /// The windows of each equation with columns sought, their thrust as it is given. A velocity
  /// whose equation has none stays as measured.
  std::array<PredictedSupports, 3> Predict(
      const VesselModel& model, const std::vector<ConstantDisturbance>& disturbance_terms,
      const std::array<std::vector<std::size_t>, 3>& columns, const FilteredThrust& thrust) const;

 private:
  struct Instant {
    Nu nu;
    double psi_rad = 0.0;
  };
  struct Part;
  class Bodies;

  std::vector<Part> Parts() const;
  void Simulate(const BodyDynamics& dynamics, const ConstantDisturbance& disturbance_terms,
                const std::array<bool, 3>& simulated, const FilteredThrust& thrust,
                const Part& part, std::vector<Instant>& predicted) const;
  void ProjectPart(std::size_t equation, const FilteredThrust& thrust,
                   const std::vector<Instant>& predicted, const Part& part, const Bodies& bodies,
                   PredictedSupports& supports) const;

  const PreparedDataset& dataset_;
  const WeakProblem& problem_;
  Nu fastest_;
  std::size_t restart_rows_ = 1;
  std::size_t lead_in_rows_ = 1;
  Eigen::VectorXd kernel_;        ///< F on intervals
  Eigen::VectorXd smoothed_phi_;  ///< phi through F
};

}  // namespace telltale
