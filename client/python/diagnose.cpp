#include "telltale/client/workbench/diagnose_recorded.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include "telltale/client/python/bindings.hpp"
#include "telltale/client/python/model.hpp"
#include "telltale/client/python/recording.hpp"
#include "telltale/client/report/report_page.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/core/base/degrees.hpp"
#include "telltale/idl/codec/json/report.hpp"

namespace telltale::python {
namespace {

namespace py = pybind11;

void RequireEffects(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (const auto fault = EffectFault(name); !fault.empty()) {
      throw UsageError("--without: " + fault);
    }
  }
}

/// A diagnosis that remembers its recordings.
struct SourcedDiagnosis : DiagnosedModel {
  ReportSources sources;
};

std::vector<std::string> NamesOf(const Recordings& recordings) {
  std::vector<std::string> names;
  for (const auto& recording : recordings) names.push_back(NameOf(recording->log.path));
  return names;
}

/// The boat that a recording is said to be of. What a log alone suggests is nobody's choice.
std::string VehicleIdFor(const Recordings& recordings, bool stated, const Vehicle& vehicle,
                         const Identification& model) {
  for (const auto& recording : recordings) stated = stated || recording->stated;
  return stated ? vehicle.vehicle_id : model.vehicle_id;
}

SourcedDiagnosis Diagnosed(const ScoredIdentification& model, const OneOrMore& recordings,
                           const Recordings& references,
                           const std::optional<VehicleOrFile>& vehicle, bool refit,
                           const std::vector<std::string>& without, std::uint64_t seed,
                           std::optional<std::size_t> threads, const py::object& progress) {
  RequireEffects(without);
  RequireEach("references", references);
  const DiagnoseChoices choices{refit, without, seed, threads};
  const Recordings logs = ListOf(recordings);
  const RecordedVehicle recorded = Joined(logs, vehicle, InputFaults::kIgnored);
  std::vector<RecordedLog> nominal;
  for (const auto& reference : references) nominal.push_back(reference->log);
  const auto vehicle_id = VehicleIdFor(logs, vehicle.has_value(), recorded.vehicle, model.model);
  const Progress interruptible = Interruptible(progress);
  ReportSources sources{NamesOf(logs), NamesOf(references), "", std::nullopt};
  const py::gil_scoped_release unlocked;
  return {DiagnoseRecorded(model.model, recorded, std::move(nominal), vehicle_id, choices,
                           interruptible),
          std::move(sources)};
}

std::vector<std::string> EffectsOf(const Cause& cause) {
  std::vector<std::string> names;
  for (const CausalEffect& effect : cause.effects) names.push_back(effect.effect);
  return names;
}

std::vector<std::string> SentencesOf(const Cause& cause) {
  std::vector<std::string> sentences;
  for (const CausalEffect& effect : cause.effects) sentences.push_back(effect.sentence);
  return sentences;
}

std::optional<ScoredIdentification> AugmentedOf(const SourcedDiagnosis& diagnosed) {
  if (!diagnosed.augmented) return std::nullopt;
  return ScoredIdentification{*diagnosed.augmented};
}

std::string CauseText(const Cause& cause) {
  const std::vector<std::string> names = EffectsOf(cause);
  return fmt::format("<telltale.Cause {}: {}>",
                     names.empty() ? "unknown" : fmt::to_string(fmt::join(names, ", ")),
                     cause.probability);
}

std::string DiagnosisText(const SourcedDiagnosis& diagnosed) {
  return fmt::format("<telltale.Diagnosis {}: {}>", Name(diagnosed.diagnosis.verdict),
                     diagnosed.diagnosis.sentence);
}

std::string EstimateText(const ParameterEstimate& estimate) {
  return fmt::format("<telltale.ParameterEstimate {}: {:.4g} +- {:.2g} {}>", estimate.name,
                     estimate.estimate, estimate.standard_error, estimate.unit);
}

std::string DirectionText(const CircularInterval& direction) {
  return fmt::format("<telltale.Direction {:.0f} +- {:.0f} deg{}>",
                     kDegreesPerRadian * direction.centre_rad,
                     kDegreesPerRadian * direction.half_width_rad,
                     direction.or_opposite ? ", or the opposite way" : "");
}

void AddEstimates(py::module_& module) {
  py::class_<ParameterEstimate>(module, "ParameterEstimate", "A parameter of an effect.")
      .def_readonly("name", &ParameterEstimate::name, "As in report.json.")
      .def_readonly("estimate", &ParameterEstimate::estimate, "Its most probable value.")
      .def_readonly("standard_error", &ParameterEstimate::standard_error, "In the same unit.")
      .def_readonly("unit", &ParameterEstimate::unit, "'m/s'; '1' of shares.")
      .def("__repr__", &EstimateText);
  py::class_<CircularInterval>(module, "Direction",
                               "Where weather runs to, with a 95 % interval, clockwise from north.")
      .def_property_readonly(
          "towards_deg",
          [](const CircularInterval& direction) {
            return kDegreesPerRadian * direction.centre_rad;
          },
          "In [0, 360).")
      .def_property_readonly(
          "half_width_deg",
          [](const CircularInterval& direction) {
            return kDegreesPerRadian * direction.half_width_rad;
          },
          "Of the interval; 180 where any direction is possible.")
      .def_readonly("or_opposite", &CircularInterval::or_opposite,
                    "Whether the opposite way is possible too.")
      .def("__repr__", &DirectionText);
}

void AddCausalEffect(py::module_& module) {
  py::class_<CausalEffect>(module, "CausalEffect", "One effect of a cause.")
      .def_readonly("effect", &CausalEffect::effect, "Its name.")
      .def_readonly("sentence", &CausalEffect::sentence, "'port thruster 22 % weaker'.")
      .def_readonly("parameters", &CausalEffect::parameters, "Estimates of its parameters.")
      .def_readonly("size", &CausalEffect::size,
                    "Of weather: the speed of wind or a current, the amplitude of the "
                    "accelerations by waves. None of a fault.")
      .def_readonly("direction", &CausalEffect::towards,
                    "Of weather: where it runs to. None of a fault.")
      .def("__repr__", [](const CausalEffect& part) {
        return fmt::format("<telltale.CausalEffect {}: {}>", part.effect, part.sentence);
      });
}

void AddCause(py::module_& module) {
  py::class_<Cause>(module, "Cause", "Effects that act together, and how probable that is.")
      .def_property_readonly("effects", &EffectsOf, "Names; none for the unknown cause.")
      .def_property_readonly("sentences", &SentencesOf,
                             "'port thruster 22 % weaker', one an effect.")
      .def_readonly("parts", &Cause::effects, "The effects with their sizes.")
      .def_readonly("probability", &Cause::probability, "Among all causes.")
      .def_readonly("indistinguishable", &Cause::indistinguishable,
                    "Effects that explain this recording alike.")
      .def_property_readonly(
          "excess_explained",
          [](const Cause& cause) -> std::optional<double> {
            if (!cause.excess_explained) return std::nullopt;
            return cause.excess_explained->share;
          },
          "The share of the excess error that it explains at five seconds, or None.")
      .def("__repr__", &CauseText);
}

void AddDiagnosis(py::module_& module) {
  py::class_<SourcedDiagnosis>(
      module, "Diagnosis",
      "Where a model and a recording differ, which effect explains it, and "
      "how much of the excess error it explains.")
      .def_property_readonly(
          "verdict",
          [](const SourcedDiagnosis& diagnosed) {
            return std::string(Name(diagnosed.diagnosis.verdict));
          },
          "'NO_MATERIAL_GAP', 'EXPLAINED', 'PARTLY_EXPLAINED', 'UNKNOWN_CAUSE' or "
          "'INSUFFICIENT_DATA'.")
      .def_property_readonly(
          "sentence",
          [](const SourcedDiagnosis& diagnosed) { return diagnosed.diagnosis.sentence; },
          "The answer in one sentence.")
      .def_property_readonly(
          "causes", [](const SourcedDiagnosis& diagnosed) { return diagnosed.diagnosis.causes; },
          "Most probable first.")
      .def_property_readonly(
          "present_weather",
          [](const SourcedDiagnosis& diagnosed) { return diagnosed.diagnosis.present_weather; },
          "The weather that the recording shows, beside which effects would have to show.")
      .def_property_readonly(
          "notes", [](const SourcedDiagnosis& diagnosed) { return diagnosed.diagnosis.notes; },
          "Limitations, as sentences.")
      .def_property_readonly(
          "gap",
          [](const SourcedDiagnosis& diagnosed) { return diagnosed.diagnosis.Main().all.before; },
          "The error at five seconds, times the normal error.")
      .def_property_readonly("model", &AugmentedOf,
                             "The model identified again with the likely effects; None where no "
                             "effect is likely.")
      .def(
          "to_json",
          [](const SourcedDiagnosis& diagnosed) { return PrintReportJson(diagnosed.diagnosis); },
          "The text of a report.json.")
      .def(
          "to_dict",
          [](const SourcedDiagnosis& diagnosed) {
            return FromJson(PrintReportJson(diagnosed.diagnosis));
          },
          "All that report.json holds.")
      .def(
          "to_html",
          [](const SourcedDiagnosis& diagnosed) {
            return ReportPage(diagnosed.diagnosis, diagnosed.sources);
          },
          "A page with pictures, which needs no network.")
      .def("__repr__", &DiagnosisText);
}

}  // namespace

void AddDiagnose(py::module_& module) {
  AddEstimates(module);
  AddCausalEffect(module);
  AddCause(module);
  AddDiagnosis(module);
  module.def(
      "diagnose", &Diagnosed, py::arg("model"), py::arg("recordings"),
      py::arg("references") = Recordings(), py::arg("vehicle") = py::none(), py::kw_only(),
      py::arg("refit") = false, py::arg("without") = std::vector<std::string>(),
      py::arg("seed") = 1, py::arg("threads") = py::none(), py::arg("progress") = py::none(),
      "Finds where a model and a recording differ, and which effect explains it.\n\n"
      "Args:\n"
      "    model: a Model.\n"
      "    recordings: a Recording of 60 s or more that did not make the model, or several.\n"
      "    references: recordings of the same boat in its nominal state, which say how large the\n"
      "        normal error is; without any it is what sensor noise alone leaves.\n"
      "    vehicle: a Vehicle or the path of a vehicle file, in place of the recordings' own.\n"
      "    refit: let the coefficients follow the recording, within their bounds.\n"
      "    without: names of effects to leave out of those that may be the cause.\n"
      "    seed: of the bootstrap; the same seed gives the same report.\n"
      "    threads: [1, 256], by default all of the machine; never changes the result.\n"
      "    progress: called with the stage and the share done, from any thread.\n\n"
      "Raises InputError for arguments out of their range, DataCannotTell where a reference made "
      "the model or is given twice, or the recording allows no diagnosis. Ctrl-C ends it.");
}

}  // namespace telltale::python
