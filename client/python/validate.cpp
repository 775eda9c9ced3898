#include "telltale/client/workbench/score_model.hpp"

#include "telltale/client/python/bindings.hpp"
#include "telltale/client/python/model.hpp"
#include "telltale/client/python/recording.hpp"
#include "telltale/core/validation/validation.hpp"
#include "telltale/idl/codec/json/metrics.hpp"

namespace telltale::python {
namespace {

namespace py = pybind11;

constexpr std::array kVelocities = {"surge", "sway", "yaw"};

template <class Score>
std::map<std::string, Score> ByVelocity(const std::array<Score, 3>& scores) {
  std::map<std::string, Score> named;
  for (std::size_t i = 0; i < scores.size(); ++i) named[kVelocities[i]] = scores[i];
  return named;
}

Metrics Scored(const ScoredIdentification& model, const OneOrMore& recordings,
               const std::optional<VehicleOrFile>& vehicle,
               const std::optional<std::vector<double>>& horizons,
               const std::optional<std::string>& preset, const py::object& progress) {
  const RecordedVehicle recorded = Joined(ListOf(recordings), vehicle, InputFaults::kIgnored);
  const Progress interruptible = Interruptible(progress);
  const py::gil_scoped_release unlocked;
  const ValidationOptions options =
      horizons ? ValidationOptions{*horizons} : UsualOptions(model.model.sampling_period_s);
  return ScoreModel(model.model, recorded, preset, options, interruptible).metrics;
}

void AddScores(py::module_& module) {
  py::class_<OneStepScore>(module, "OneStepScore", "One velocity, predicted one sample ahead.")
      .def_readonly("r2", &OneStepScore::r2, "NaN where the velocity never changes.")
      .def_readonly("mae", &OneStepScore::mae, "m/s or rad/s.")
      .def_readonly("constant_velocity_r2", &OneStepScore::constant_velocity_r2,
                    "Of predicting no change.");
  py::class_<FreeRunScore>(module, "FreeRunScore",
                           "One velocity in free runs: errors in m/s or rad/s, infinite where the "
                           "model diverges.")
      .def_readonly("rmse", &FreeRunScore::rmse, "Of all instants after the start of a run.")
      .def_readonly("mae", &FreeRunScore::mae, "Likewise.")
      .def_readonly("r2", &FreeRunScore::r2, "Likewise.")
      .def_readonly("constant_velocity_rmse", &FreeRunScore::constant_velocity_rmse,
                    "Of holding the initial velocity.")
      .def_readonly("noise_floor", &FreeRunScore::noise_floor,
                    "One sigma of the measured velocity, which no error can fall below.");
  py::class_<FreeRunScores>(module, "FreeRunScores", "Free runs of one length.")
      .def_readonly("horizon_s", &FreeRunScores::horizon_s, "The length.")
      .def_property_readonly(
          "velocity", [](const FreeRunScores& scores) { return ByVelocity(scores.velocity); },
          "By 'surge', 'sway' and 'yaw'.")
      .def_readonly("position_rmse_m", &FreeRunScores::position_rmse_m, "At the end of a run.")
      .def_readonly("windows", &FreeRunScores::windows, "How many runs there are.");
  py::class_<Metrics>(module, "Scores", "What a model predicts of a recording.")
      .def_property_readonly(
          "one_step", [](const Metrics& metrics) { return ByVelocity(metrics.one_step); },
          "By 'surge', 'sway' and 'yaw'.")
      .def_readonly("free_run", &Metrics::free_run, "By horizon, in the order asked for.")
      .def("to_json", &PrintMetricsJson, "The text of a metrics.json.")
      .def(
          "to_dict", [](const Metrics& metrics) { return FromJson(PrintMetricsJson(metrics)); },
          "All that metrics.json holds.");
}

}  // namespace

void AddValidate(py::module_& module) {
  AddScores(module);
  module.def(
      "validate", &Scored, py::arg("model"), py::arg("recordings"), py::arg("vehicle") = py::none(),
      py::kw_only(), py::arg("horizons") = py::none(), py::arg("preset") = py::none(),
      py::arg("progress") = py::none(),
      "Scores a model on recordings: one step ahead and in free runs. Score on recordings that did "
      "not make the model.\n\n"
      "Args:\n"
      "    model: a Model.\n"
      "    recordings: a Recording, or several of one boat.\n"
      "    vehicle: a Vehicle or the path of a vehicle file, in place of the recordings' own.\n"
      "    horizons: lengths of free runs, seconds, from two sampling periods to 600; by default "
      "1, 5\n"
      "        and 10, as far as these are in the range.\n"
      "    preset: of the data preparation, 'robust' or 'paper'; by default the model's own.\n"
      "    progress: called with the stage and the share done.\n\n"
      "Raises InputError, DataCannotTell where the model lacks an equation or a horizon is out of "
      "its range.");
}

}  // namespace telltale::python
