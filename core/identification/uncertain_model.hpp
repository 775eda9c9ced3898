#pragma once

#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/model_structure.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// A model whose coefficients may err, as its covariance says.
struct UncertainModel {
  /// A coefficient that is not exactly known.
  struct Free {
    Equation equation = Equation::kUnknown;
    Eigen::Index column = 0;
  };

  VesselModel model;
  std::vector<Free> free;
  Eigen::MatrixXd covariance;  ///< of the free ones, positive on its diagonal

  Eigen::VectorXd StandardErrors() const { return covariance.diagonal().cwiseSqrt(); }
  Eigen::MatrixXd Correlation() const;

  /// `about`, which has the same coefficients, with the free ones changed by so much.
  VesselModel Changed(const VesselModel& about, const Eigen::VectorXd& by) const;
};

/// Coefficients without a finite standard error, which the data never moved, stay as they are.
/// Refuses when: the model lacks an equation.
Result<UncertainModel> UncertainModelOf(const Identification& identification);

}  // namespace telltale
