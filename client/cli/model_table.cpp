#include "telltale/client/cli/model_table.hpp"

#include "telltale/client/cli/coefficient_text.hpp"
#include "telltale/client/cli/coverage_check_table.hpp"
#include "telltale/client/cli/exit_codes.hpp"
#include "telltale/client/cli/identifiability_table.hpp"
#include "telltale/client/cli/model_notes.hpp"
#include "telltale/client/cli/model_verdict.hpp"
#include "telltale/client/cli/regressor_words.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/core/identification/drag_and_thrust.hpp"

namespace telltale {
namespace {

std::string FormText(Structure structure) {
  return structure == Structure::kFossen ? "physical model in Fossen's form"
                                         : InWords(Name(structure)) + " model";
}

std::string EstimatorText(Estimator estimator) {
  switch (estimator) {
    case Estimator::kOneStep: return "one-step least squares";
    case Estimator::kWeakIv: return "the weak form with instruments";
    case Estimator::kPredictionError: return "the prediction-error method";
    case Estimator::kOutputError:
    case Estimator::kUnknown: break;
  }
  return InWords(Name(estimator));
}

std::string Title(const Identification& model) {
  return Wrapped(model.vehicle_id + ": " + FormText(model.structure) + ", estimated by " +
                 EstimatorText(model.estimator) + ", h = " + Plain(model.sampling_period_s) + " s");
}

/// A paragraph of its own, where there is any text.
std::string AsParagraph(const std::string& text) {
  return text.empty() ? "" : '\n' + text;
}

// ---- what a simulation uses ---------------------------------------------------------------------

std::string TimeConstantText(const Identification& model) {
  if (!model.thruster_time_constant) return "";
  const Coefficient& c = *model.thruster_time_constant;
  return Wrapped("thruster time constant " + Significant(c.estimate) + " s, " + BoundsTitle(model) +
                 ' ' + BoundsText(c.interval));
}

std::string DeadZoneText(const DeadZone& limits) {
  if (limits == DeadZone{}) return "";
  return Wrapped("dead zone: no thrust from " + Significant(limits.reverse) + " to " +
                 Significant(limits.forward) + " of full command");
}

std::string SimulationTable(const Identification& model) {
  const std::string title =
      model.simulation.empty()
          ? "Values for simulation: the estimates with their bounds."
          : "Values for simulation: regularised; the bounds are those of the estimates.";
  return title + '\n' +
         CoefficientRows(model,
                         {{"coefficient", Align::kLeft},
                          {"value", Align::kRight},
                          {BoundsTitle(model), Align::kRight},
                          {"unit", Align::kLeft}},
                         [&model](const Coefficient& c, std::size_t i) -> std::vector<std::string> {
                           return {RegressorCell(c.equation, c.regressor),
                                   Significant(model.SimulationParameter(i)),
                                   BoundsText(c.interval), c.unit};
                         }) +
         TimeConstantText(model) + DeadZoneText(model.dead_zone);
}

/// The parameters of the physical form, which its simulations use.
std::string ParameterTable(const PhysicalModel& physical, const std::string& bounds_title) {
  Table table({{"parameter", Align::kLeft},
               {"value", Align::kRight},
               {bounds_title, Align::kRight},
               {"unit", Align::kLeft},
               {"", Align::kLeft}});
  for (const Coefficient& parameter : physical.parameters) {
    table.AddRow({ParameterCell(parameter.symbol), Significant(parameter.estimate),
                  BoundsText(parameter.interval), parameter.unit,
                  parameter.status == CoefficientStatus::kPrior ? "prior" : ""});
  }
  return Wrapped(
             "Parameters of the physical form; simulations use these values. "
             "Masses, drag and thrust are over the mass with added mass in surge.") +
         table.Render();
}

std::string PointText(const ForceAtPoint& force) {
  if (force.at_unit == "1") return Plain(100.0 * force.at) + " % command";
  return Significant(force.at) + ' ' + force.at_unit;
}

/// What the parameters add up to, which a short recording tells better than each of them.
std::string DragAndThrustTable(const PhysicalModel& physical, const std::string& bounds_title) {
  Table table({{"drag and thrust", Align::kLeft},
               {"at", Align::kLeft},
               {"value", Align::kRight},
               {bounds_title, Align::kRight},
               {"unit", Align::kLeft}});
  for (const ForceAtPoint& force : DragAndThrustOf(physical)) {
    table.AddRow({force.name, PointText(force), Significant(force.estimate),
                  BoundsText(force.interval), force.unit});
  }
  return table.Render();
}

// ---- the rest -----------------------------------------------------------------------------------

std::string RefusalsText(const Identification& model) {
  if (model.refusals.empty()) return "";
  std::string text = "Refused, or to be used with care\n";
  for (const Refusal& refusal : model.refusals) text += Explained(refusal);
  return text;
}

std::string ChangeText(const Identification& model) {
  if (!model.provenance.change) return "";
  return Wrapped("The model " + InWords(*model.provenance.change));
}

std::string StatusText(const Identification& model, const Coefficient& c) {
  const bool absent = model.physical && c.estimate == 0.0 && c.standard_error == 0.0;
  return absent ? "not in this form" : InWords(Name(c.status));
}

std::string EstimatesTable(const Identification& model) {
  const std::string title = model.physical ? "Coefficients that the parameters imply.\n" : "";
  return title +
         CoefficientRows(model,
                         {{"regressor", Align::kLeft},
                          {"symbol", Align::kLeft},
                          {"estimate", Align::kRight},
                          {"std. error", Align::kRight},
                          {"status", Align::kLeft}},
                         [&model](const Coefficient& c, std::size_t) -> std::vector<std::string> {
                           return {c.regressor, c.symbol, Significant(c.estimate),
                                   Significant(c.standard_error, 3), StatusText(model, c)};
                         });
}

}  // namespace

std::string ModelTable(const Identification& identification,
                       const std::optional<HeldOutScore>& score) {
  const std::string bounds_title = BoundsTitle(identification);
  const std::string values = identification.physical
                                 ? ParameterTable(*identification.physical, bounds_title) + '\n' +
                                       DragAndThrustTable(*identification.physical, bounds_title)
                                 : SimulationTable(identification);
  return Title(identification) + '\n' + ModelVerdict(identification, score) + '\n' + values +
         AsParagraph(RefusalsText(identification)) + AsParagraph(ChangeText(identification)) +
         '\n' + EstimatesTable(identification) + AsParagraph(RecordingBiasTable(identification)) +
         AsParagraph(IdentifiabilityTable(identification)) +
         AsParagraph(CoverageTable(identification)) + '\n' + ModelNotes(identification);
}

}  // namespace telltale
