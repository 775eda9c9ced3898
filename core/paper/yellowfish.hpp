#pragma once

#include <array>
#include <vector>

#include "telltale/core/simulation/simulator.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// The paper's table of the static second-order model, as printed: discrete-time, coefficient times
/// h = 0.2 s. Seven numbers for surge, thirteen each for sway and yaw, in the paper's order.
struct PaperStaticTable {
  std::array<double, 7> surge;
  std::array<double, 13> sway;
  std::array<double, 13> yaw;
};
extern const PaperStaticTable kYellowfishStaticTable;
inline constexpr double kYellowfishSamplingPeriodS = 0.2;

/// The paper's table of the first-order dynamic model, as printed: the redundant coefficients of
/// surge (11), sway and yaw (21 each) in the appendix's order. The table's third column is headed
/// X_v,dyn a second time; it is yaw's.
std::array<Eigen::VectorXd, 3> YellowfishDynamicTable();

/// The paper's own discrete model, in the paper's parameterization.
VesselModel YellowfishPaperModel();

/// The simulated boat: the paper's table as a continuous model whose propellers are consistent in
/// all four regions (parameterization kPropeller). Assumes: reverse surge thrust and the meaning of
/// mean*diff, which the table leaves open, as docs/concepts/model.md states them.
VesselModel YellowfishTwin();

/// The simulated boat with lagging thrusters: the static table's boat, with alpha of the
/// first-order model from the surge column of the dynamic table. Surge is the one equation pair
/// with a single root in (0, 1). The dynamic table itself diverges within seconds as a recursion
/// (docs/concepts/model.md).
VesselModel YellowfishLaggingTwin();

/// Geometry and channels of the paper's boat.
Vehicle YellowfishVehicle();

}  // namespace telltale
