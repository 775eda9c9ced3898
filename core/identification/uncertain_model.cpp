#include "telltale/core/identification/uncertain_model.hpp"

#include <array>
#include <cmath>

#include "telltale/core/base/linear_algebra/covariance.hpp"

namespace telltale {
namespace {

bool IsUncertain(double variance) {
  return std::isfinite(variance) && variance > 0.0;
}

void FreePhysicalParameters(const PhysicalModel& physical, UncertainModel& uncertain) {
  uncertain.physical = {physical.Estimates(), physical.propeller_separation_m, RangeOf(physical)};
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < At(FossenParameter::kImbalance); ++i) {
    if (!IsUncertain(physical.covariance(i, i))) continue;
    uncertain.free.push_back({Equation::kUnknown, i});
    kept.push_back(i);
  }
  uncertain.covariance = physical.covariance(kept, kept);
}

void FreeCoefficients(const Identification& identification, UncertainModel& uncertain) {
  std::vector<Eigen::Index> kept;
  std::array<Eigen::Index, 3> column{};
  for (std::size_t i = 0; i < identification.coefficients.size(); ++i) {
    const Coefficient& coefficient = identification.coefficients[i];
    const Eigen::Index own = column[IndexOf(coefficient.equation)]++;
    const auto place = static_cast<Eigen::Index>(i);
    if (!IsUncertain(identification.covariance(place, place))) continue;
    uncertain.free.push_back({coefficient.equation, own});
    kept.push_back(place);
  }
  uncertain.covariance = identification.covariance(kept, kept);
}

}  // namespace

Eigen::MatrixXd UncertainModel::Correlation() const {
  return Scaled(covariance, StandardErrors().cwiseInverse());
}

FossenVector UncertainModel::ChangedParameters(const Eigen::VectorXd& by) const {
  FossenVector parameters = physical->parameters;
  for (std::size_t i = 0; i < free.size(); ++i) {
    parameters[free[i].column] += by[static_cast<Eigen::Index>(i)];
  }
  return physical->range.Within(parameters);
}

VesselModel UncertainModel::Changed(const Eigen::VectorXd& by) const {
  VesselModel changed = model;
  if (physical) {
    const VesselModel boat = VesselModelOf(ChangedParameters(by), physical->propeller_separation_m);
    changed.theta = boat.theta;
    changed.reverse_loss = boat.reverse_loss;
    return changed;
  }
  for (std::size_t i = 0; i < free.size(); ++i) {
    changed.theta[IndexOf(free[i].equation)][free[i].column] += by[static_cast<Eigen::Index>(i)];
  }
  return changed;
}

std::string UncertainModel::NameOf(std::size_t free_parameter) const {
  const auto& [equation, column] = free[free_parameter];
  const auto place = static_cast<std::size_t>(column);
  if (physical) return std::string(FossenParameterNames()[place].symbol);
  return std::string(Name(equation)) + ' ' +
         std::string(Regressors(equation, model.parameterization)[place].name);
}

Result<UncertainModel> UncertainModelOf(const Identification& identification) {
  auto model = ModelOf(identification);
  if (!model) return tl::unexpected<Refusal>(model.error());
  UncertainModel uncertain;
  uncertain.model = *std::move(model);
  if (identification.physical) {
    FreePhysicalParameters(*identification.physical, uncertain);
  } else {
    FreeCoefficients(identification, uncertain);
  }
  return uncertain;
}

}  // namespace telltale
