#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/recording_bias_terms.hpp"
#include "telltale/core/vessel/regressors.hpp"

namespace telltale {

/// The regression of one equation: y = Phi theta + noise.
/// Shapes: phi n x p, y n, nu n (the equation's velocity at instant k). clusters[s] is the range of
/// rows of phi that slice s of the dataset gave, possibly empty: the same index means the same
/// slice in all three equations. Units: y in m/s^2 or rad/s^2, so theta is continuous-time SI.
struct EquationProblem {
  Equation equation = Equation::kUnknown;
  std::span<const Regressor> regressors;
  Eigen::MatrixXd phi;
  Eigen::VectorXd y;
  Eigen::VectorXd nu;
  std::vector<std::size_t> instants;  ///< the dataset's row of each row
  std::vector<RowRange> clusters;
};

/// The three regressions of the static structure, surge, sway, yaw.
struct RegressionProblem {
  Structure structure = Structure::kUnknown;
  Parameterization parameterization = Parameterization::kUnknown;
  double sampling_period_s = 0.0;
  std::array<EquationProblem, 3> equations;
};

/// Which model is fitted to which rows.
/// Paper parameterization: surge on FF alone (always), sway and yaw on FF, FR and RF, as in the
/// paper.
/// Propeller parameterization: every equation on FF, FR and RF, which it describes consistently.
struct RegressionOptions {
  Structure structure = Structure::kStaticQuadratic;
  Parameterization parameterization = Parameterization::kPropeller;
  bool include_reverse = false;  ///< take RR rows too
  DeadZone dead_zone;            ///< applied to every command before its regressors are formed
  RecordingBiasModel recording_bias =
      RecordingBiasModel::kShared;  ///< steady disturbances; heeded by the weak form alone
};

/// Whether rows under a command of this region enter this equation.
bool Enters(PropellerRegion region, Equation equation, const RegressionOptions& options);

/// Instants k of a regression that uses the previous command: the command at k-1 lies in `slice`,
/// and k-1, k and k+1 in its segment.
RowRange InstantsAfter(const RowRange& slice, const std::vector<RowRange>& segments);

/// PreparedDataset -> RegressionProblem: y(k) = (nu(k+1) - nu(k)) / h on Phi(nu(k), delta(k)),
/// pairs never straddling a gap. docs/concepts/model.md (13).
/// Source: the paper, Propositions 1 and 2.
RegressionProblem BuildRegression(const PreparedDataset& dataset, const RegressionOptions& options);

}  // namespace telltale
