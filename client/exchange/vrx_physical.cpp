#include "telltale/client/exchange/vrx_physical.hpp"

#include <array>

#include "telltale/client/exchange/sdf_text.hpp"

namespace telltale {
namespace {

using enum FossenParameter;

struct PhysicalDrag {
  const char* element;
  FossenParameter parameter;
};

constexpr std::array kPhysicalDrags = {
    PhysicalDrag{"xU", kXu},   PhysicalDrag{"xUU", kXuu}, PhysicalDrag{"yV", kYv},
    PhysicalDrag{"yVV", kYvv}, PhysicalDrag{"nR", kNr},   PhysicalDrag{"nRR", kNrr},
};

constexpr std::array kWithoutPlace = {kM23, kYr, kNv, kYrv, kNvv, kNvr, kYuv, kYur, kNuv, kNur};

class PhysicalSdf {
 public:
  PhysicalSdf(const PhysicalModel& model, double mass_kg) : model_(model), mass_kg_(mass_kg) {}

  std::string Assumptions() const {
    const std::string mass = Text(mass_kg_);
    return Comment("ASSUMED: m11 = mass_kg = " + mass +
                   " kg from the vehicle file, the added mass in surge in it or not: telemetry "
                   "cannot tell. Every force here scales with it, motion does not.") +
           Comment("Give the link <mass>" + mass + "</mass> and <izz>" + Text(Scaled(kM33)) +
                   "</izz>: m33, the added inertia in it. Drag is positive against motion.") +
           Comment("No place here, in newtons and metres over the regressor: " + WithoutPlace() +
                   ". Heave, roll and pitch drag are not identified; set them yourself.");
  }

  std::string Thrust() const {
    return Comment("Thrust of one propeller at full forward command: " +
                   Text(mass_kg_ * ForwardThrust(model_.Estimates(), 1.0)) + " N.") +
           Comment("At full reverse command: " +
                   Text(-mass_kg_ * ReverseThrust(model_.Estimates(), 1.0)) + " N.") +
           Comment("Thrust follows the command with a first-order lag of " +
                   Text(Of(kTimeConstant).estimate) + " s.") +
           Comment("No thrust between " + Text(-Of(kReverseDeadBand).estimate) + " and " +
                   Text(Of(kForwardDeadBand).estimate) + " of full command.") +
           Comment("No place here: in reverse a propeller keeps 1 / (1 + (" +
                   Text(Of(kReverseLoss).estimate) + " u)^8) of its thrust at speed u ahead.") +
           Comment("No place here: the port propeller gives " +
                   Text(1.0 - Of(kImbalance).estimate) + " of that thrust, that to starboard " +
                   Text(1.0 + Of(kImbalance).estimate) + " of it.");
  }

  std::string Plugin() const {
    std::string text =
        "<plugin filename=\"libSimpleHydrodynamics.so\" name=\"vrx::SimpleHydrodynamics\">\n"
        "  <link_name>base_link</link_name>\n"
        "  <xDotU>0</xDotU>\n" +
        AddedMassInSway() + "  <nDotR>0</nDotR>\n";
    for (const PhysicalDrag& drag : kPhysicalDrags) {
      const Coefficient& parameter = Of(drag.parameter);
      text += Element(drag.element, Scaled(drag.parameter),
                      "± " + Text(mass_kg_ * parameter.standard_error));
    }
    return text + "</plugin>\n";
  }

 private:
  const Coefficient& Of(FossenParameter parameter) const {
    return model_.parameters[static_cast<std::size_t>(parameter)];
  }

  double Scaled(FossenParameter parameter) const { return mass_kg_ * Of(parameter).estimate; }

  std::string AddedMassInSway() const {
    const double beyond_surge = Scaled(kM22) - mass_kg_;
    if (beyond_surge >= 0.0) {
      return Element("yDotV", beyond_surge, "± " + Text(mass_kg_ * Of(kM22).standard_error));
    }
    return Element("yDotV", 0.0,
                   "the estimate, " + Text(beyond_surge) + ", is less than none; left out");
  }

  std::string WithoutPlace() const {
    std::string text;
    for (const FossenParameter parameter : kWithoutPlace) {
      text.append(text.empty() ? "" : ", ").append(Of(parameter).symbol).append(" ");
      text.append(Text(Scaled(parameter)));
    }
    return text;
  }

  const PhysicalModel& model_;
  double mass_kg_;
};

}  // namespace

std::string PrintPhysicalVrx(const std::string& vehicle_id, const PhysicalModel& model,
                             double mass_kg) {
  const PhysicalSdf sdf(model, mass_kg);
  return "<?xml version=\"1.0\"?>\n" +
         Comment("Hydrodynamics of " + vehicle_id + " for VRX, identified by Telltale.") +
         sdf.Assumptions() + sdf.Thrust() + sdf.Plugin();
}

}  // namespace telltale
