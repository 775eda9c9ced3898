#include "telltale/client/exchange/mss.hpp"

#include <array>
#include <map>
#include <string_view>

#include "telltale/core/vessel/fossen_matrices.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/proto/exchange.pb.h"

namespace telltale {
namespace {

using Meanings = std::map<std::string_view, std::string_view>;

// From M nu_dot + C(nu) nu + D(nu) nu = tau with M symmetric, m23 = m x_g - Y_rdot, and Fossen's C.
const Meanings kSurgeMeanings = {
    {"u|u|", "W11 X_|u|u"},
    {"vr", "W11 (m - Y_vdot)"},
    {"rr", "W11 (m x_g - Y_rdot)"},
    {"u", "W11 X_u"},
    {"1", "W11 X_0, a constant force"},
    {"f:d^2", "W11 a_f"},
    {"f:d", "W11 b_f"},
    {"r:d^2", "W11 a_r"},
    {"r:d", "W11 b_r"},
    {"mean^2+diff^2/4", "2 W11 a_f"},
    {"mean", "2 W11 b_f"},
};
const Meanings kSwayMeanings = {
    {"v|v|", "W22 Y_|v|v + W23 N_|v|v"},
    {"v|r|", "W22 Y_|r|v + W23 N_|r|v"},
    {"r|v|", "W22 Y_|v|r + W23 N_|v|r"},
    {"r|r|", "W22 Y_|r|r + W23 N_|r|r"},
    {"uv", "W23 (Y_vdot - X_udot)"},
    {"ur", "-W22 (m - X_udot) - W23 (m x_g - Y_rdot)"},
    {"v", "W22 Y_v + W23 N_v"},
    {"r", "W22 Y_r + W23 N_r"},
    {"1", "W22 Y_0 + W23 N_0, a constant force and moment"},
    {"f:d^2", "W23 (d/2) a_f"},
    {"f:d", "W23 (d/2) b_f"},
    {"r:d^2", "W23 (d/2) a_r"},
    {"r:d", "W23 (d/2) b_r"},
    {"mean^2+diff^2/4", "W23 (d/2) (a_port - a_starboard), by region"},
    {"mean*diff", "W23 (d/2) (a_port + a_starboard), by region"},
    {"mean", "W23 (d/2) (b_port - b_starboard), by region"},
    {"diff/2", "W23 (d/2) (b_port + b_starboard), by region"},
};
const Meanings kYawMeanings = {
    {"v|v|", "W32 Y_|v|v + W33 N_|v|v"},
    {"v|r|", "W32 Y_|r|v + W33 N_|r|v"},
    {"r|v|", "W32 Y_|v|r + W33 N_|v|r"},
    {"r|r|", "W32 Y_|r|r + W33 N_|r|r"},
    {"uv", "W33 (Y_vdot - X_udot)"},
    {"ur", "-W32 (m - X_udot) - W33 (m x_g - Y_rdot)"},
    {"v", "W32 Y_v + W33 N_v"},
    {"r", "W32 Y_r + W33 N_r"},
    {"1", "W32 Y_0 + W33 N_0, a constant force and moment"},
    {"f:d^2", "W33 (d/2) a_f"},
    {"f:d", "W33 (d/2) b_f"},
    {"r:d^2", "W33 (d/2) a_r"},
    {"r:d", "W33 (d/2) b_r"},
    {"mean^2+diff^2/4", "W33 (d/2) (a_port - a_starboard), by region"},
    {"mean*diff", "W33 (d/2) (a_port + a_starboard), by region"},
    {"mean", "W33 (d/2) (b_port - b_starboard), by region"},
    {"diff/2", "W33 (d/2) (b_port + b_starboard), by region"},
};

std::string_view MeaningOf(const Coefficient& coefficient) {
  const std::array kMeanings = {&kSurgeMeanings, &kSwayMeanings, &kYawMeanings};
  return kMeanings[IndexOf(coefficient.equation)]->at(coefficient.regressor);
}

struct UnidentifiableTerm {
  const char* parameter;
  const char* reason;
};

constexpr std::array kUnidentifiableTerms = {
    UnidentifiableTerm{"m, X_udot",
                       "surge sees m11 = m - X_udot alone, and only as a common divisor of forces"},
    UnidentifiableTerm{"Y_vdot, Y_rdot", "they come in products with W alone"},
    UnidentifiableTerm{"I_z, N_rdot",
                       "yaw sees I_z - N_rdot alone, and only as a divisor of moments"},
    UnidentifiableTerm{"x_g", "it comes with Y_rdot alone, in m x_g - Y_rdot, and divided by m11"},
    UnidentifiableTerm{"a_f, b_f, a_r, b_r", "thrust in newtons is known only times W"},
    UnidentifiableTerm{"X_u, X_|u|u, Y_v, N_r and all other damping",
                       "known only times W; in sway and yaw only sums of two such products"},
    UnidentifiableTerm{"wind, current, trim", "all are within the constant term"},
};

// The mass matrix of the physical form is known over m11, and so is all that it divides.
constexpr std::array kUnidentifiableOfPhysicalForm = {
    UnidentifiableTerm{"m, X_udot",
                       "surge sees m11 = m - X_udot alone, and only as a common divisor of forces"},
    UnidentifiableTerm{"thrust and drag in newtons", "known only over m11"},
};

void Write(const Coefficient& coefficient, proto::NormalisedCoefficient& message) {
  message.set_equation(static_cast<proto::Equation>(coefficient.equation));
  message.set_regressor(coefficient.regressor);
  message.set_symbol(coefficient.symbol);
  message.set_meaning(std::string(MeaningOf(coefficient)));
  message.set_estimate(coefficient.estimate);
  message.set_standard_error(coefficient.standard_error);
  message.set_unit(coefficient.unit);
  message.set_status(static_cast<proto::CoefficientStatus>(coefficient.status));
}

void Append(const Eigen::Matrix3d& matrix, google::protobuf::RepeatedField<double>& rows) {
  for (const auto row : matrix.rowwise()) rows.Add(row.begin(), row.end());
}

proto::PhysicalForm PhysicalFormOf(const FossenVector& parameters) {
  using enum FossenParameter;
  const FossenMatrices matrices = MatricesOf(parameters);
  proto::PhysicalForm form;
  Append(matrices.mass, *form.mutable_mass());
  Append(matrices.linear_damping, *form.mutable_linear_damping());
  Append(matrices.lift_damping, *form.mutable_lift_damping());
  Append(matrices.quadratic_damping, *form.mutable_quadratic_damping());
  Append(matrices.cross_flow_damping, *form.mutable_cross_flow_damping());
  for (const FossenParameter at : {kForwardLinear, kForwardQuadratic}) {
    form.add_forward_thrust(parameters[At(at)]);
  }
  for (const FossenParameter at : {kReverseLinear, kReverseQuadratic}) {
    form.add_reverse_thrust(parameters[At(at)]);
  }
  form.set_reverse_loss_s_m(parameters[At(kReverseLoss)]);
  form.set_thrust_imbalance(parameters[At(kImbalance)]);
  return form;
}

template <class Terms>
void AddUnidentifiable(const Terms& terms, proto::MssModel& message) {
  for (const UnidentifiableTerm& unidentifiable : terms) {
    proto::NotIdentifiable& entry = *message.add_not_identifiable();
    entry.set_parameter(unidentifiable.parameter);
    entry.set_reason(unidentifiable.reason);
  }
}

void AddNotes(const Identification& identification, const Vehicle& vehicle,
              proto::MssModel& message) {
  message.add_notes(
      "M = I in these units: where a simulator computes nu_dot = Minv (tau + damping - C nu), use "
      "the "
      "sum of coefficient times regressor in place of the right-hand side.");
  message.add_notes(
      "The frame is Fossen's: x forward, y to starboard, r clockwise seen from above. d is "
      "propellerSeparationM; commands are shares of full command, after the dead zone.");
  if (identification.physical) {
    message.add_notes(
        "physical is the same boat as M nu_dot + C(nu) nu + D(nu) nu = tau over m11 = m - X_udot: "
        "with M and D times m11, forces are newtons. C follows from M. In reverse a propeller "
        "keeps 1 / (1 + (reverseLossSM u)^8) of its thrust while u > 0. The port propeller gives "
        "1 - thrustImbalance of forwardThrust and reverseThrust, that to starboard "
        "1 + thrustImbalance.");
  } else {
    message.add_notes(
        "Identifiable beyond the coefficients are ratios alone, W33 d / (2 W11) for one, from the "
        "f: coefficients of yaw and surge.");
  }
  if (vehicle.mass_kg) {
    message.add_notes(
        "massKg is stated, not identified. m11 = m - X_udot exceeds it, so massKg times a surge "
        "coefficient is a lower bound of the force, and nothing closer is justified.");
  }
  if (identification.estimator == Estimator::kOneStep) {
    message.add_notes(
        "One-step least squares fits nu(k+1) = nu(k) + h nu_dot(k) with h = samplingPeriodS. Step "
        "with "
        "that h to get the model that was fitted; a finer step differs by about h / 2 times the "
        "fastest rate of the boat.");
  }
}

}  // namespace

std::string PrintMss(const Identification& identification, const Vehicle& vehicle) {
  const proto::Model model = ToProto(identification);
  proto::MssModel message;
  message.set_vehicle_id(identification.vehicle_id);
  message.set_equations(
      "nu_dot_j = sum over the coefficients of equation j of estimate times regressor; nu = [u v "
      "r]; "
      "W = M^-1 with W12 = W13 = 0");
  message.set_structure(model.structure());
  message.set_parameterization(model.parameterization());
  message.set_sampling_period_s(identification.sampling_period_s);
  for (const Coefficient& coefficient : identification.coefficients) {
    Write(coefficient, *message.add_coefficients());
  }
  *message.mutable_dead_zone() = model.dead_zone();
  if (model.has_thruster_time_constant_s()) {
    *message.mutable_thruster_time_constant_s() = model.thruster_time_constant_s();
  }
  message.set_propeller_separation_m(vehicle.propeller_separation_m);
  if (vehicle.mass_kg) message.set_mass_kg(*vehicle.mass_kg);
  if (identification.physical) {
    *message.mutable_physical() = PhysicalFormOf(identification.physical->Estimates());
    AddUnidentifiable(kUnidentifiableOfPhysicalForm, message);
  } else {
    AddUnidentifiable(kUnidentifiableTerms, message);
  }
  AddNotes(identification, vehicle, message);
  return PrintJsonMessage(message);
}

}  // namespace telltale
