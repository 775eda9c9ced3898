#include "telltale/client/cli/model_notes.hpp"

#include "telltale/client/cli/coefficient_text.hpp"
#include "telltale/client/cli/table.hpp"

namespace telltale {
namespace {

std::string WindowText(const WindowSummary& window) {
  return Wrapped("Window: " + Fixed(window.start_s, 1) + " s to " + Fixed(window.end_s, 1) +
                 " s, " + Counted(window.samples, "row", "rows") + " in " +
                 Counted(window.segments, "segment", "segments") + ", " +
                 Counted(window.slices, "slice", "slices") + "; " + RejectedText(window.rejected) +
                 " rejected.");
}

std::string GnssDriftText(const std::optional<Disturbance>& disturbance) {
  if (!disturbance || disturbance->gnss_drift_m == 0.0) return "";
  return Wrapped("GNSS drift: the residuals show that fixes drift by " +
                 Fixed(100.0 * disturbance->gnss_drift_m, 1) +
                 " cm within a second; the bounds allow for it.");
}

std::string ChoiceText(const char* of, const std::string& choice) {
  return choice.empty() ? "" : Wrapped(std::string(of) + " chosen: " + choice + '.');
}

std::string MethodText(const Identification& identification) {
  const Provenance& provenance = identification.provenance;
  return ChoiceText("Structure", provenance.structure_choice) +
         Wrapped("Parameterization: " + InWords(Name(identification.parameterization)) + '.') +
         ChoiceText("Estimator", provenance.estimator_choice);
}

std::string BoundsBasisText(const Provenance& provenance) {
  std::string text = "Bounds rest on: " + provenance.bounds_basis;
  if (provenance.bootstrap_replicates > 0) {
    text += "; " + std::to_string(provenance.bootstrap_replicates) + " replicates, " +
            std::to_string(provenance.bootstrap_failures) + " of them unsolved, seed " +
            std::to_string(provenance.seed);
  }
  return Wrapped(text + ".");
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
  return text.empty() ? "0 samples" : text;
}

std::string RecordingBiasTable(const Identification& model) {
  if (model.recording_bias.empty()) return "";
  Table table({{"equation"},
               {"regressor"},
               {"estimate", Align::kRight},
               {"std. error", Align::kRight},
               {BoundsTitle(model), Align::kRight},
               {"unit"}});
  for (std::size_t i = 0; i < model.recording_bias.size(); ++i) {
    const RecordingBias& bias = model.recording_bias[i];
    table.AddHeading("bias of recording " + std::to_string(i + 1) + ", " + Fixed(bias.start_s, 1) +
                     " s to " + Fixed(bias.end_s, 1) + " s");
    for (const Coefficient& c : bias.coefficients) {
      table.AddRow({std::string(Name(c.equation)), c.regressor, Significant(c.estimate),
                    Significant(c.standard_error, 3), BoundsText(c.interval), c.unit});
    }
  }
  return table.Render() +
         Wrapped(
             "In the other tables the coefficients of the regressor 1 are means over the "
             "recordings.");
}

std::string ModelNotes(const Identification& identification) {
  return WindowText(identification.window) + GnssDriftText(identification.disturbance) +
         MethodText(identification) + BoundsBasisText(identification.provenance);
}

}  // namespace telltale
