#include "telltale/core/paper/yellowfish.hpp"

#include <cmath>

namespace telltale {

const PaperStaticTable kYellowfishStaticTable = {
    .surge = {-0.0616, 0.0272, -0.0098, 0.0072, -0.0001, -0.0145, 0.1403},
    .sway = {-0.0214, -0.0714, -0.0334, -0.0123, -0.0400, 0.0329, 0.0407, 0.0334, -0.0018, 0.0092,
             -0.0381, -0.0032, -0.0505},
    .yaw = {0.0424, -0.1168, 0.0369, -0.0077, -0.0310, -0.0931, 0.0882, -0.1505, 0.0055, -0.0872,
            -0.0743, 0.0814, 0.3206},
};

namespace {

// One propeller's thrust curve as it enters an equation: a delta^2 + b delta, forward and reverse.
struct ThrustCurve {
  double a_f = 0.0;
  double b_f = 0.0;
  double a_r = 0.0;
  double b_r = 0.0;
};

template <std::size_t N>
Eigen::VectorXd PerSecond(const std::array<double, N>& discrete) {
  return Eigen::Map<const Eigen::VectorXd>(discrete.data(), N) / kYellowfishSamplingPeriodS;
}

Eigen::VectorXd Join(const Eigen::VectorXd& body, const ThrustCurve& thrust) {
  Eigen::VectorXd theta(body.size() + 4);
  theta << body, thrust.a_f, thrust.b_f, thrust.a_r, thrust.b_r;
  return theta;
}

// The table's last four numbers in the FR meaning: a_f - a_r, a_f + a_r, b_f - b_r, b_f + b_r.
ThrustCurve TurningThrust(const Eigen::VectorXd& table) {
  const Eigen::Vector4d x = table.tail<4>();
  return {(x[1] + x[0]) / 2, (x[3] + x[2]) / 2, (x[1] - x[0]) / 2, (x[3] - x[2]) / 2};
}

// The table gives surge thrust forward only: 2 a_f and 2 b_f. Reverse is the forward curve mirrored
// and weakened, T(-delta) = -ratio T(delta).
ThrustCurve SurgeThrust(const Eigen::VectorXd& table, double reverse_ratio) {
  const double a_f = table[5] / 2;
  const double b_f = table[6] / 2;
  return {a_f, b_f, -reverse_ratio * a_f, reverse_ratio * b_f};
}

VesselModel StaticModel(Parameterization parameterization, Discretisation discretisation) {
  VesselModel model;
  model.structure = Structure::kStaticQuadratic;
  model.parameterization = parameterization;
  model.discretisation = discretisation;
  model.sampling_period_s = kYellowfishSamplingPeriodS;
  return model;
}

}  // namespace

std::array<Eigen::VectorXd, 3> YellowfishDynamicTable() {
  std::array<Eigen::VectorXd, 3> table = {Eigen::VectorXd(11), Eigen::VectorXd(21),
                                          Eigen::VectorXd(21)};
  table[0] << 0.8062, 0.0893, -0.1095, -0.0341, -0.7725, -0.1395, 0.1622, 0.0301, 0.0016, -0.0106,
      0.0611;
  table[1] << 0.6904, -0.0091, 0.0237, -0.0261, -0.0005, 0.4328, 0.3075, -0.6978, -0.1285, -0.0085,
      -0.0494, 0.0081, 0.0004, -0.4353, -0.3078, 0.1478, -0.0007, -0.007, -0.007, 0.0101, -0.0214;
  table[2] << 0.9886, 0.0577, 0.1845, -0.0190, -0.0054, 0.0667, -0.0020, -0.2723, -1.0430, -0.1305,
      -0.2120, -0.0059, 0.0577, -0.1116, 0.0358, 0.3419, -0.0013, -0.0422, -0.0385, 0.0394, 0.0168;
  return table;
}

VesselModel YellowfishPaperModel() {
  VesselModel model = StaticModel(Parameterization::kPaper, Discretisation::kForwardEuler);
  model.theta = {PerSecond(kYellowfishStaticTable.surge), PerSecond(kYellowfishStaticTable.sway),
                 PerSecond(kYellowfishStaticTable.yaw)};
  return model;
}

VesselModel YellowfishTwin() {
  const Eigen::VectorXd surge = PerSecond(kYellowfishStaticTable.surge);
  const Eigen::VectorXd sway = PerSecond(kYellowfishStaticTable.sway);
  const Eigen::VectorXd yaw = PerSecond(kYellowfishStaticTable.yaw);
  const ThrustCurve yaw_thrust = TurningThrust(yaw);
  const double reverse_ratio = yaw_thrust.b_r / yaw_thrust.b_f;

  VesselModel model = StaticModel(Parameterization::kPropeller, Discretisation::kContinuous);
  model.theta = {Join(surge.head<5>(), SurgeThrust(surge, reverse_ratio)),
                 Join(sway.head<9>(), TurningThrust(sway)), Join(yaw.head<9>(), yaw_thrust)};
  return model;
}

VesselModel YellowfishLaggingTwin() {
  // alpha^2 - (1 + X1) alpha - X5 = 0, its root below one.
  const Eigen::VectorXd surge = YellowfishDynamicTable()[0];
  const double half = (1.0 + surge[0]) / 2;
  const double alpha = half - std::sqrt(half * half + surge[4]);
  VesselModel model = YellowfishTwin();
  model.structure = Structure::kFirstOrderDynamic;
  model.thruster_time_constant_s = -kYellowfishSamplingPeriodS / std::log(alpha);
  return model;
}

Vehicle YellowfishVehicle() {
  Vehicle vehicle;
  vehicle.vehicle_id = "yellowfish";
  vehicle.propeller_separation_m = 0.7;
  vehicle.port = {1500.0, 1900.0, 1100.0};
  vehicle.starboard = {1500.0, 1900.0, 1100.0};
  vehicle.gnss_antenna = {-0.3, 0.0};
  return vehicle;
}

}  // namespace telltale
