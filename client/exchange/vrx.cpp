#include "telltale/client/exchange/vrx.hpp"

#include <array>
#include <cmath>
#include <string_view>

#include "telltale/client/exchange/sdf_text.hpp"
#include "telltale/client/exchange/vrx_physical.hpp"
#include "telltale/core/base/contract.hpp"
#include "telltale/core/identification/input_gain.hpp"

namespace telltale {
namespace {

constexpr PropellerCommand kPortFullForward{1.0, 0.0};
constexpr PropellerCommand kPortFullReverse{-1.0, 0.0};

const Coefficient& Find(const Identification& identification, Equation equation,
                        std::string_view regressor) {
  for (const Coefficient& c : identification.coefficients) {
    if (c.equation == equation && c.regressor == regressor) return c;
  }
  throw ContractViolation("Find: requires an equation with all its regressors");
}

struct Inertia {
  double mass_kg = 0.0;
  double yaw_kg_m2 = 0.0;

  double Of(Equation equation) const { return equation == Equation::kYaw ? yaw_kg_m2 : mass_kg; }
};

Result<Inertia> ReferenceInertia(const Identification& identification, const Vehicle& vehicle) {
  for (const Equation equation : kEquations) {
    if (identification.Has(equation)) continue;
    return Refuse("vrx", "the model has no " + std::string(Name(equation)) + " equation",
                  "identify from data that excite it; its refusal says how");
  }
  const InputGain gain = SteadyInputGain(identification, kPortFullForward);
  const double surge = gain.gain[0];
  const double yaw = gain.gain[2];
  if (!(surge > 0.0 && yaw > 0.0 && gain.StandardErrors().allFinite())) {
    return Refuse(
        "vrx",
        "the thrust of one propeller is not known in surge and in yaw, which gives the yaw "
        "inertia",
        "record turns with one propeller faster than the other, both forward and opposed");
  }
  return Inertia{*vehicle.mass_kg,
                 *vehicle.mass_kg * vehicle.propeller_separation_m / 2.0 * surge / yaw};
}

struct Drag {
  const char* element;
  Equation equation;
  const char* regressor;
};

constexpr std::array kDrags = {
    Drag{"xU", Equation::kSurge, "u"}, Drag{"xUU", Equation::kSurge, "u|u|"},
    Drag{"yV", Equation::kSway, "v"},  Drag{"yVV", Equation::kSway, "v|v|"},
    Drag{"nR", Equation::kYaw, "r"},   Drag{"nRR", Equation::kYaw, "r|r|"},
};

std::string ElementOf(const Drag& drag, const Identification& identification,
                      const Inertia& inertia) {
  const Coefficient& c = Find(identification, drag.equation, drag.regressor);
  const double scale = inertia.Of(drag.equation);
  const double value = -scale * c.estimate;
  const auto line = [&](double number, const std::string& why) {
    return Element(drag.element, number, why);
  };
  if (c.status == CoefficientStatus::kNotExcited) return line(0.0, "not excited by the data");
  if (value < 0.0) {
    return line(0.0, "the estimate, " + Text(value) + " ± " + Text(scale * c.standard_error) +
                         ", has the sign of a push; left out");
  }
  return line(value, "± " + Text(scale * c.standard_error));
}

bool IsCarried(const Coefficient& coefficient) {
  for (const Drag& drag : kDrags) {
    if (coefficient.equation == drag.equation && coefficient.regressor == drag.regressor) {
      return true;
    }
  }
  return false;
}

/// The body terms that a diagonal drag has no place for, in units of the reference inertia.
std::string LeftOut(const Identification& identification, const Inertia& inertia) {
  std::string text;
  for (const Equation equation : kEquations) {
    for (const Regressor& regressor : Regressors(equation, identification.parameterization)) {
      if (regressor.is_propeller) continue;
      const Coefficient& c = Find(identification, equation, regressor.name);
      if (IsCarried(c)) continue;
      text.append(text.empty() ? "" : ", ").append(Name(equation)).append(" ");
      text.append(c.regressor).append(" ").append(Text(inertia.Of(equation) * c.estimate));
    }
  }
  return text;
}

std::string Thrust(const Identification& identification, const Inertia& inertia) {
  const auto newtons = [&](const PropellerCommand& command) {
    return Text(inertia.mass_kg * SteadyInputGain(identification, command).gain[0]);
  };
  std::string text = Comment(
      "Thrust of one propeller at full forward command: " + newtons(kPortFullForward) + " N.");
  if (identification.parameterization == Parameterization::kPropeller) {
    const InputGain reverse = SteadyInputGain(identification, kPortFullReverse);
    text += Comment(std::isfinite(reverse.covariance(0, 0))
                        ? "At full reverse command: " + newtons(kPortFullReverse) + " N."
                        : "At full reverse command: not excited by the data.");
  }
  if (identification.thruster_time_constant) {
    text += Comment("Thrust follows the command with a first-order lag of " +
                    Text(identification.thruster_time_constant->estimate) + " s.");
  }
  if (identification.dead_zone != DeadZone{}) {
    text += Comment("No thrust between " + Text(identification.dead_zone.reverse) + " and " +
                    Text(identification.dead_zone.forward) + " of full command.");
  }
  return text;
}

}  // namespace

Result<std::string> PrintVrx(const Identification& identification, const Vehicle& vehicle) {
  if (!vehicle.mass_kg) {
    return Refuse(
        "vrx", "the vehicle file states no mass_kg, and drag in newtons needs an inertia",
        "measure the mass of the boat as it was recorded and add mass_kg to the vehicle file");
  }
  if (identification.physical) {
    return PrintPhysicalVrx(identification.vehicle_id, *identification.physical, *vehicle.mass_kg);
  }
  const auto inertia = ReferenceInertia(identification, vehicle);
  if (!inertia) return tl::unexpected(inertia.error());
  std::string text = "<?xml version=\"1.0\"?>\n";
  text += Comment("Hydrodynamics of " + identification.vehicle_id +
                  " for VRX, identified by Telltale.");
  text += Comment(
      "ASSUMED: m11 = m22 = mass_kg = " + Text(inertia->mass_kg) +
      " kg from the vehicle file, added mass in it or not; W23 = 0. Telemetry cannot tell any "
      "of these.");
  text += Comment("Give the link <mass>" + Text(inertia->mass_kg) + "</mass> and <izz>" +
                  Text(inertia->yaw_kg_m2) +
                  "</izz>: the yaw inertia that the propeller separation of " +
                  Text(vehicle.propeller_separation_m) + " m and that mass imply.");
  text += Comment(
      "Every force here scales with mass_kg, motion does not. Drag is positive against motion.");
  text += Comment(
      "Identified with h = " + Text(identification.sampling_period_s) +
      " s; a simulator with finer steps differs by about h / 2 times the boat's fastest rate.");
  text += Comment("No place here (N and N m per unit of the regressor, y to starboard): " +
                  LeftOut(identification, *inertia) +
                  ". Heave, roll and pitch drag are not identified; set them yourself.");
  text += Thrust(identification, *inertia);
  text +=
      "<plugin filename=\"libSimpleHydrodynamics.so\" name=\"vrx::SimpleHydrodynamics\">\n"
      "  <link_name>base_link</link_name>\n"
      "  <xDotU>0</xDotU>\n"
      "  <yDotV>0</yDotV>\n"
      "  <nDotR>0</nDotR>\n";
  for (const Drag& drag : kDrags) text += ElementOf(drag, identification, *inertia);
  return text + "</plugin>\n";
}

}  // namespace telltale
