#include "telltale/core/estimation/output_error/shared_unknowns.hpp"

#include <algorithm>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/format_number.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {

Eigen::Index SharedUnknowns::Size() const {
  return First(Equation::kYaw) + static_cast<Eigen::Index>(columns[2].size());
}

Eigen::Index SharedUnknowns::First(Equation equation) const {
  std::size_t first = lagging ? 1 : 0;
  for (std::size_t j = 0; j < IndexOf(equation); ++j) first += columns[j].size();
  return static_cast<Eigen::Index>(first);
}

VesselModel SharedUnknowns::ModelWith(const Eigen::VectorXd& theta,
                                      double sampling_period_s) const {
  Require(theta.size() == Size(), "as many values as unknowns");
  VesselModel model =
      VesselModel::OfZeros(lagging ? Structure::kFirstOrderDynamic : Structure::kStaticQuadratic,
                           parameterization, Discretisation::kContinuous, sampling_period_s);
  model.dead_zone = dead_zone;
  if (lagging) model.thruster_time_constant_s = std::max(theta[0], kShortestSimulatedTimeConstantS);
  for (const Equation equation : kEquations) {
    const std::size_t j = IndexOf(equation);
    Eigen::Index next = First(equation);
    for (const std::size_t column : columns[j]) {
      model.theta[j][static_cast<Eigen::Index>(column)] = theta[next++];
    }
  }
  return model;
}

Eigen::VectorXd SharedUnknowns::In(const VesselModel& model) const {
  Require(model.parameterization == parameterization, "a model of the same parameterization");
  Eigen::VectorXd theta(Size());
  if (lagging) theta[0] = model.thruster_time_constant_s.value_or(kShortestSimulatedTimeConstantS);
  for (const Equation equation : kEquations) {
    const std::size_t j = IndexOf(equation);
    Eigen::Index next = First(equation);
    for (const std::size_t column : columns[j]) {
      theta[next++] = model.theta[j][static_cast<Eigen::Index>(column)];
    }
  }
  return theta;
}

std::string NameOf(const SharedUnknowns& unknowns, std::size_t unknown) {
  Require(unknown < static_cast<std::size_t>(unknowns.Size()), "one of the unknowns");
  if (unknowns.lagging && unknown == 0) return "thruster time constant";
  for (const Equation equation : {Equation::kYaw, Equation::kSway, Equation::kSurge}) {
    const auto first = static_cast<std::size_t>(unknowns.First(equation));
    if (unknown < first) continue;
    const std::size_t column = unknowns.columns[IndexOf(equation)][unknown - first];
    return std::string(Name(equation)) + " " +
           std::string(Regressors(equation, unknowns.parameterization)[column].name);
  }
  return {};
}

Refusal Explain(const InseparableDirection& direction, const SharedUnknowns& unknowns) {
  constexpr std::size_t kNamed = 6;
  std::string names;
  std::string change;
  for (std::size_t i = 0; i < std::min(kNamed, direction.unknowns.size()); ++i) {
    const std::size_t unknown = direction.unknowns[i];
    const std::string name = NameOf(unknowns, unknown);
    const double by = direction.change[static_cast<Eigen::Index>(unknown)];
    names += (names.empty() ? "" : ", ") + name;
    change += (change.empty() ? "" : ", ") + FormatSignificant(by, 3) + " to " + name;
  }
  if (direction.unknowns.size() > kNamed) {
    const auto rest = static_cast<double>(direction.unknowns.size() - kNamed);
    change += " and something to " + FormatSignificant(rest, 3) + " others";
  }
  if (direction.unknowns.size() == 1) {
    return {names, "not identifiable: no measurement changes with this coefficient alone",
            "record manoeuvres in which this term is at work"};
  }
  return {names,
          "these are collinear: adding " + change +
              " leaves every measurement as it is (condition index " +
              FormatSignificant(direction.condition_index, 3) + ")",
          "add steps of the command between small and full, zigzags and circles at two or more "
          "speeds"};
}

}  // namespace telltale
