#include "telltale/core/estimation/weak_form/weak_fit.hpp"

#include <algorithm>

#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {

Block WeakFit::BlockOf(std::size_t equation) const {
  Block block{time_constant_s ? 1 : 0, equations[equation]->theta.size()};
  for (std::size_t j = 0; j < equation; ++j) {
    if (equations[j]) block.begin += equations[j]->theta.size();
  }
  return block;
}

std::vector<Block> WeakFit::Blocks() const {
  std::vector<Block> blocks;
  if (time_constant_s) blocks.push_back({0, 1});
  for (std::size_t j = 0; j < equations.size(); ++j) {
    if (equations[j]) blocks.push_back(BlockOf(j));
  }
  return blocks;
}

Eigen::VectorXd WeakFit::Regularised() const {
  Eigen::VectorXd stacked = theta;
  for (std::size_t j = 0; j < equations.size(); ++j) {
    if (!equations[j]) continue;
    const auto [begin, size] = BlockOf(j);
    stacked.segment(begin, size) = equations[j]->regularised;
  }
  return stacked;
}

VesselModel ModelOf(const WeakFit& fit, const Eigen::VectorXd& theta, double sampling_period_s) {
  VesselModel model = VesselModel::OfZeros(
      fit.time_constant_s ? Structure::kFirstOrderDynamic : Structure::kStaticQuadratic,
      fit.problem.parameterization, Discretisation::kContinuous, sampling_period_s);
  model.dead_zone = fit.problem.dead_zone;
  Eigen::Index next = 0;
  if (fit.time_constant_s) {
    model.thruster_time_constant_s = std::max(theta[next++], kShortestTimeConstantS);
  }
  for (const Equation equation : kEquations) {
    const std::size_t j = IndexOf(equation);
    if (!fit.equations[j]) continue;
    for (const std::size_t column : fit.equations[j]->columns) {
      const auto place = static_cast<Eigen::Index>(column);
      if (place < model.theta[j].size()) model.theta[j][place] = theta[next];
      ++next;
    }
  }
  return model;
}

bool LagIsAtLowerBound(const WeakFit& fit) {
  return fit.time_constant_s && *fit.time_constant_s < 1.5 * kShortestTimeConstantS;
}

}  // namespace telltale
