#include "vessel/vessel_model.hpp"

#include "contract.hpp"

namespace telltale {
namespace {

constexpr std::size_t kLongestRow = 16;

double RowTimesTheta(const VesselModel& model, Equation equation, const Nu& nu,
                     const PropellerCommand& delta) {
  const Eigen::VectorXd& theta = model.theta[IndexOf(equation)];
  std::array<double, kLongestRow> row;
  const auto size = Regressors(equation, model.parameterization).size();
  Require(static_cast<std::size_t>(theta.size()) == size, "theta as long as its regressors");
  FillRow(equation, model.parameterization, nu, delta, std::span(row).first(size));
  return Eigen::Map<const Eigen::VectorXd>(row.data(), theta.size()).dot(theta);
}

}  // namespace

NuDot VesselModel::Acceleration(const Nu& nu, const PropellerCommand& delta) const {
  return {RowTimesTheta(*this, Equation::kSurge, nu, delta),
          RowTimesTheta(*this, Equation::kSway, nu, delta),
          RowTimesTheta(*this, Equation::kYaw, nu, delta)};
}

}  // namespace telltale
