#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/physical_range.hpp"
#include "telltale/core/vessel/fossen_model.hpp"
#include "telltale/core/vessel/model_structure.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// A model whose free parameters may err, as their covariance says: the coefficients of the free
/// forms, the physical parameters of Fossen's form. The latter stay in their physical range.
struct UncertainModel {
  /// A coefficient that is not exactly known, or the physical parameter in this place.
  struct Free {
    Equation equation = Equation::kUnknown;
    Eigen::Index column = 0;
  };

  /// Of Fossen's form.
  struct Physical {
    FossenVector parameters;
    double propeller_separation_m = 0.0;
    PhysicalRange range;
  };

  VesselModel model;
  std::vector<Free> free;
  Eigen::MatrixXd covariance;  ///< of the free ones, positive on its diagonal
  std::optional<Physical> physical;

  Eigen::VectorXd StandardErrors() const { return covariance.diagonal().cwiseSqrt(); }
  Eigen::MatrixXd Correlation() const;

  /// The physical parameters, of which the free ones are changed by so much. Requires: `physical`.
  FossenVector ChangedParameters(const Eigen::VectorXd& by) const;

  /// The model with the free parameters changed by so much.
  VesselModel Changed(const Eigen::VectorXd& by) const;

  /// Of a free parameter, for people.
  std::string NameOf(std::size_t free_parameter) const;
};

/// Coefficients without a finite standard error, which the data never moved, stay as they are. So
/// do the physical parameters that are effects of the library as well: lag, dead bands, delays and
/// the excess of one thruster.
/// Refuses when: the model lacks an equation.
Result<UncertainModel> UncertainModelOf(const Identification& identification);

}  // namespace telltale
