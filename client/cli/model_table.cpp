#include "telltale/client/cli/model_table.hpp"

#include <cctype>
#include <cmath>

#include "telltale/client/cli/exit_codes.hpp"
#include "telltale/client/cli/identifiability_table.hpp"
#include "telltale/client/cli/table.hpp"

namespace telltale {
namespace {

// "ONE_STEP" -> "one step"
std::string InWords(std::string_view name) {
  std::string words;
  for (const char c : name) {
    words += c == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return words;
}

std::string Percent(double level) {
  return Plain(100.0 * level) + " %";
}

std::string BoundsTitle(const Identification& identification) {
  if (identification.coefficients.empty()) return "bounds";
  return Percent(identification.coefficients.front().interval.level) + " bounds";
}

std::string BoundsText(const Interval& interval, double scale) {
  return '[' + Significant(scale * interval.lower) + ", " + Significant(scale * interval.upper) +
         ']';
}

std::string Heading(Equation equation) {
  switch (equation) {
    case Equation::kSurge: return "SURGE  du/dt";
    case Equation::kSway: return "SWAY   dv/dt";
    case Equation::kYaw: return "YAW    dr/dt";
    case Equation::kUnknown: break;
  }
  return "";
}

std::string Title(const Identification& model) {
  return model.vehicle_id + ": " + InWords(Name(model.structure)) + ", " +
         InWords(Name(model.parameterization)) + " parameterization, " +
         InWords(Name(model.estimator)) + ", h = " + Plain(model.sampling_period_s) + " s\n";
}

/// Rows of all equations there are, grouped; `cells` makes a row of a coefficient.
template <class Cells>
std::string Grouped(const Identification& model, std::vector<Column> columns, Cells cells) {
  Table table(std::move(columns));
  for (const Equation equation : kEquations) {
    bool headed = false;
    for (const Coefficient& coefficient : model.coefficients) {
      if (coefficient.equation != equation) continue;
      if (!headed) table.AddHeading(Heading(equation));
      headed = true;
      table.AddRow(cells(coefficient));
    }
  }
  return table.Render();
}

std::string Coefficients(const Identification& model) {
  std::vector<Column> columns = {{"regressor", Align::kLeft},
                                 {"symbol", Align::kLeft},
                                 {"estimate", Align::kRight},
                                 {"std. error", Align::kRight},
                                 {BoundsTitle(model), Align::kRight},
                                 {"unit", Align::kLeft},
                                 {"status", Align::kLeft}};
  constexpr int kAfterBounds = 5;
  const bool simulation = !model.simulation.empty();
  if (simulation) columns.insert(columns.begin() + kAfterBounds, {"sailed with", Align::kRight});
  return Grouped(model, std::move(columns), [&](const Coefficient& c) {
    std::vector<std::string> cells = {c.regressor,
                                      c.symbol,
                                      Significant(c.estimate),
                                      Significant(c.standard_error, 3),
                                      BoundsText(c.interval, 1.0),
                                      c.unit,
                                      InWords(Name(c.status))};
    if (simulation) {
      const auto place = static_cast<std::size_t>(&c - model.coefficients.data());
      cells.insert(cells.begin() + kAfterBounds, Significant(model.SimulationParameter(place)));
    }
    return cells;
  });
}

std::string TimeConstant(const Identification& model) {
  if (!model.thruster_time_constant) return "";
  const Coefficient& c = *model.thruster_time_constant;
  return "thruster time constant " + Significant(c.estimate) + " s, std. error " +
         Significant(c.standard_error, 3) + ", " + Percent(c.interval.level) + " bounds " +
         BoundsText(c.interval, 1.0) + '\n';
}

std::string DeadZoneText(const DeadZone& limits) {
  if (limits == DeadZone{}) return "";
  return "dead zone: no thrust from " + Significant(limits.reverse) + " to " +
         Significant(limits.forward) + " of full command\n";
}

/// alpha = exp(-h / tau), a rising function of tau, so the bounds carry over.
std::string Alpha(const Identification& model) {
  if (!model.thruster_time_constant) return "";
  const Coefficient& tau = *model.thruster_time_constant;
  const auto alpha = [h = model.sampling_period_s](double time_constant_s) {
    return time_constant_s > 0.0 ? std::exp(-h / time_constant_s) : 0.0;
  };
  return "alpha = exp(-h / tau) = " + Significant(alpha(tau.estimate)) + ", " +
         Percent(tau.interval.level) + " bounds [" + Significant(alpha(tau.interval.lower)) + ", " +
         Significant(alpha(tau.interval.upper)) + "]; beta = 1 - alpha\n";
}

std::string RecordingBiasText(const Identification& model) {
  if (model.recording_bias.empty()) return "";
  Table table({{"steady in recording"},
               {"equation"},
               {"regressor"},
               {"estimate", Align::kRight},
               {"std. error", Align::kRight},
               {BoundsTitle(model), Align::kRight},
               {"unit"}});
  for (std::size_t i = 0; i < model.recording_bias.size(); ++i) {
    const RecordingBias& recording_bias = model.recording_bias[i];
    table.AddHeading(std::to_string(i + 1) + ", " + Fixed(recording_bias.start_s, 1) + " s to " +
                     Fixed(recording_bias.end_s, 1) + " s");
    for (const Coefficient& c : recording_bias.coefficients) {
      table.AddRow({"", std::string(Name(c.equation)), c.regressor, Significant(c.estimate),
                    Significant(c.standard_error, 3), BoundsText(c.interval, 1.0), c.unit});
    }
  }
  return '\n' + table.Render() +
         "Above, the coefficients of the regressor 1 are means over the recordings.\n";
}

/// A part of its own, if there is anything in it.
std::string AsParagraph(const std::string& text) {
  return text.empty() ? "" : '\n' + text;
}

std::string Refusals(const Identification& model) {
  if (model.refusals.empty()) return "";
  std::string text = "\nRefused or to be read with care\n";
  for (const Refusal& refusal : model.refusals) text += Explained(refusal);
  return text;
}

std::string WindowText(const WindowSummary& window) {
  return Wrapped("Window: " + Fixed(window.start_s, 1) + " s to " + Fixed(window.end_s, 1) +
                 " s, " + Counted(window.samples, "row", "rows") + " in " +
                 Counted(window.segments, "segment", "segments") + ", " +
                 Counted(window.slices, "slice", "slices") + "; set aside " +
                 RejectedText(window.rejected) + ".");
}

std::string ChoiceText(const Provenance& provenance) {
  if (provenance.estimator_choice.empty()) return "";
  return Wrapped("Estimator chosen: " + provenance.estimator_choice + ".");
}

std::string GnssDriftText(const std::optional<Disturbance>& disturbance) {
  if (!disturbance || disturbance->gnss_drift_m == 0.0) return "";
  return Wrapped("Fixes wander off by " + Fixed(100.0 * disturbance->gnss_drift_m, 1) +
                 " cm within a second, as the residuals show; the bounds allow for it.");
}

std::string BoundsBasis(const Provenance& provenance) {
  std::string text = "Bounds rest on: " + provenance.bounds_basis;
  if (provenance.bootstrap_replicates > 0) {
    text += "; " + std::to_string(provenance.bootstrap_replicates) + " replicates, " +
            std::to_string(provenance.bootstrap_failures) + " of them unsolved, seed " +
            std::to_string(provenance.seed);
  }
  return Wrapped(text + ".");
}

std::string ChangeText(const Identification& model) {
  if (!model.provenance.change) return "";
  return '\n' + Wrapped("The model " + InWords(*model.provenance.change));
}

}  // namespace

std::string RejectedText(const RejectCounts& rejected) {
  std::string text;
  for (const Channel channel : kChannels) {
    for (const RejectReason reason : kRejectReasons) {
      const auto count = rejected.Of(channel, reason);
      if (count == 0) continue;
      text.append(text.empty() ? "" : ", ").append(Name(channel)).append(" ");
      text.append(std::to_string(count)).append(" ").append(Name(reason));
    }
  }
  return text.empty() ? "nothing" : text;
}

std::string ModelTable(const Identification& identification) {
  return Title(identification) + Coefficients(identification) + TimeConstant(identification) +
         DeadZoneText(identification.dead_zone) + RecordingBiasText(identification) +
         Refusals(identification) + ChangeText(identification) +
         AsParagraph(IdentifiabilityTable(identification)) +
         AsParagraph(CoverageTable(identification)) + '\n' + WindowText(identification.window) +
         GnssDriftText(identification.disturbance) + ChoiceText(identification.provenance) +
         BoundsBasis(identification.provenance);
}

std::string DiscreteTable(const Identification& identification) {
  const double h = identification.sampling_period_s;
  return "Coefficients times h = " + Plain(h) + " s\n" +
         Grouped(identification,
                 {{"regressor", Align::kLeft},
                  {"symbol", Align::kLeft},
                  {"estimate h", Align::kRight},
                  {"std. error h", Align::kRight},
                  {BoundsTitle(identification), Align::kRight}},
                 [h](const Coefficient& c) -> std::vector<std::string> {
                   return {c.regressor, c.symbol, Significant(h * c.estimate),
                           Significant(h * c.standard_error, 3), BoundsText(c.interval, h)};
                 }) +
         Alpha(identification);
}

}  // namespace telltale
