#include "telltale/core/identification/uncertain_model.hpp"

#include <cmath>

#include "telltale/core/base/linear_algebra/covariance.hpp"

namespace telltale {

Eigen::MatrixXd UncertainModel::Correlation() const {
  return Scaled(covariance, StandardErrors().cwiseInverse());
}

VesselModel UncertainModel::Changed(const VesselModel& about, const Eigen::VectorXd& by) const {
  VesselModel changed = about;
  for (std::size_t i = 0; i < free.size(); ++i) {
    changed.theta[IndexOf(free[i].equation)][free[i].column] += by[static_cast<Eigen::Index>(i)];
  }
  return changed;
}

Result<UncertainModel> UncertainModelOf(const Identification& identification) {
  auto model = ModelOf(identification);
  if (!model) return tl::unexpected<Refusal>(model.error());
  UncertainModel uncertain;
  uncertain.model = *std::move(model);
  std::vector<Eigen::Index> kept;
  std::array<Eigen::Index, 3> column{};
  for (std::size_t i = 0; i < identification.coefficients.size(); ++i) {
    const Coefficient& coefficient = identification.coefficients[i];
    const Eigen::Index own = column[IndexOf(coefficient.equation)]++;
    const auto place = static_cast<Eigen::Index>(i);
    const double variance = identification.covariance(place, place);
    if (!std::isfinite(variance) || variance <= 0.0) continue;
    uncertain.free.push_back({coefficient.equation, own});
    kept.push_back(place);
  }
  uncertain.covariance = identification.covariance(kept, kept);
  return uncertain;
}

}  // namespace telltale
