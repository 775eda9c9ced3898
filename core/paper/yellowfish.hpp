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

/// The twin: the paper's table read as a continuous boat whose propellers are consistent in all
/// four regions (parameterization kPropeller). The table leaves open what a propeller gives in
/// reverse in surge and which of two meanings mean*diff has; docs/concepts/model.md says how the
/// twin fills that in.
VesselModel YellowfishTwin();

/// The twin with thrusters that lag: alpha of the first-order model from the surge column of the
/// paper's dynamic table, the one equation pair with a single root in (0, 1); the boat is the
/// static table's. The dynamic table itself, read as a recursion, diverges within seconds
/// (docs/concepts/model.md).
VesselModel YellowfishLaggingTwin();

/// Geometry and channels of the paper's boat.
Vehicle YellowfishVehicle();

}  // namespace telltale
