#include "telltale/core/identification/identification.hpp"

#include <algorithm>
#include <cmath>

namespace telltale {

bool Identification::Has(Equation equation) const {
  return std::any_of(coefficients.begin(), coefficients.end(),
                     [&](const Coefficient& c) { return c.equation == equation; });
}

std::size_t Identification::Bounded() const {
  return static_cast<std::size_t>(
      std::count_if(coefficients.begin(), coefficients.end(),
                    [](const Coefficient& c) { return std::isfinite(c.standard_error); }));
}

Eigen::VectorXd Identification::Estimates() const {
  Eigen::VectorXd theta(std::ssize(coefficients));
  std::transform(coefficients.begin(), coefficients.end(), theta.begin(),
                 [](const Coefficient& c) { return c.estimate; });
  return theta;
}

std::optional<double> SquaredRadius(const Identification& identification) {
  const std::size_t bounded = identification.Bounded();
  if (!identification.joint || bounded == 0) return std::nullopt;
  const double level = identification.coefficients.front().interval.level;
  return SquaredRadius(*identification.joint, bounded, level);
}

VesselModel ThrustersOf(const Identification& identification) {
  VesselModel model;
  model.structure = identification.structure == Structure::kFossen ? Structure::kFirstOrderDynamic
                                                                   : identification.structure;
  model.parameterization = identification.parameterization;
  model.sampling_period_s = identification.sampling_period_s;
  model.dead_zone = identification.dead_zone;
  if (identification.thruster_time_constant) {
    model.thruster_time_constant_s = identification.thruster_time_constant->estimate;
  }
  if (identification.physical) {
    const FossenVector parameters = identification.physical->Estimates();
    model.reverse_loss = ReverseLossOf(parameters);
    model.thrust_imbalance = parameters[At(FossenParameter::kImbalance)];
  }
  return model;
}

Result<VesselModel> ModelOf(const Identification& identification) {
  VesselModel model = ThrustersOf(identification);
  // One-step least squares fits the discrete model itself; only that model reproduces its data.
  model.discretisation = identification.estimator == Estimator::kOneStep
                             ? Discretisation::kForwardEuler
                             : Discretisation::kContinuous;
  for (const Equation equation : kEquations) {
    if (!identification.Has(equation)) {
      return Refuse("free run", "the model has no " + std::string(Name(equation)) + " equation",
                    "identify from data that excite it; its refusal says how");
    }
    const auto regressors = Regressors(equation, identification.parameterization);
    Eigen::VectorXd& theta = model.theta[IndexOf(equation)];
    theta.resize(static_cast<Eigen::Index>(regressors.size()));
    Eigen::Index next = 0;
    for (std::size_t i = 0; i < identification.coefficients.size(); ++i) {
      if (identification.coefficients[i].equation != equation) continue;
      theta[next++] = identification.SimulationParameter(i);
    }
  }
  return model;
}

Identification WithSimulationParameters(Identification identification) {
  for (std::size_t i = 0; i < identification.coefficients.size(); ++i) {
    identification.coefficients[i].estimate = identification.SimulationParameter(i);
  }
  identification.simulation.clear();
  return identification;
}

}  // namespace telltale
