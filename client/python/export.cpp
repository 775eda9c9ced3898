#include "telltale/client/workbench/export_model.hpp"

#include "telltale/client/python/arguments.hpp"
#include "telltale/client/python/bindings.hpp"
#include "telltale/client/python/model.hpp"
#include "telltale/client/python/recording.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/names.hpp"

namespace telltale::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

constexpr double kLongestHorizonS = 600.0;

void RequireFitting(const ExportChoices& choices, bool has_recording) {
  RequireOneOf({"mss", "vrx", "csv", "mcap"}, "--format", choices.format);
  if (choices.IsOverARecording() != has_recording) {
    throw UsageError(
        std::string("recording: ") + choices.format +
        (has_recording ? " takes the model alone" : " shows the model over a recording: give one"));
  }
  if (choices.IsOverARecording() && choices.draws) {
    throw UsageError("--draws goes with the formats mss and vrx");
  }
  if (choices.draws) RequireDraws("--draws", *choices.draws);
  if (!(choices.horizon_s >= 0.0 && choices.horizon_s <= kLongestHorizonS)) {
    throw UsageError("--horizon: " + std::to_string(choices.horizon_s) + " is outside [0, 600]");
  }
}

/// Notes become warnings of Python, once the interpreter's lock is held again.
void Warn(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) {
    if (PyErr_WarnEx(PyExc_UserWarning, note.c_str(), 1) != 0) throw py::error_already_set();
  }
}

std::vector<fs::path> Exported(const ScoredIdentification& model, const fs::path& out,
                               const std::string& format,
                               const std::optional<VehicleOrFile>& vehicle,
                               const std::shared_ptr<StatedLog>& recording, double horizon,
                               std::optional<std::size_t> draws, std::uint64_t seed,
                               const py::object& progress) {
  const ExportChoices choices{format, horizon, draws, seed, out};
  RequireFitting(choices, recording != nullptr);
  std::vector<std::string> notes;
  const NoteSink note = [&](const std::string& text) { notes.push_back(text); };
  std::vector<fs::path> files;
  if (recording) {
    const RecordedVehicle recorded = Joined({recording}, vehicle, InputFaults::kIgnored);
    const Progress interruptible = Interruptible(progress);
    const py::gil_scoped_release unlocked;
    files = ExportSeries(model.model, recorded.recording, recorded.vehicle, choices, interruptible,
                         note);
  } else {
    const auto boat = VehicleOf(vehicle);
    if (!boat) throw UsageError("vehicle: " + format + " needs one");
    const py::gil_scoped_release unlocked;
    files = ExportModel(model.model, *boat, choices, note);
  }
  Warn(notes);
  return files;
}

}  // namespace

void AddExport(py::module_& module) {
  module.def(
      "export", &Exported, py::arg("model"), py::arg("out"), py::arg("format"),
      py::arg("vehicle") = py::none(), py::arg("recording") = py::none(), py::kw_only(),
      py::arg("horizon") = ExportChoices{}.horizon_s, py::arg("draws") = py::none(),
      py::arg("seed") = ExportChoices{}.seed, py::arg("progress") = py::none(),
      "Writes a model for other simulators or viewers, and returns the paths of the files. What a "
      "reader has to know comes as a warning.\n\n"
      "Args:\n"
      "    model: a Model.\n"
      "    out: a file, or a folder for files of usual names; with csv and draws a folder.\n"
      "    format: 'mss' for Fossen's MSS and Python Vehicle Simulator, 'vrx' for Gazebo; 'csv'\n"
      "        and 'mcap', for Foxglove and PlotJuggler, show the model over a recording.\n"
      "    vehicle: a Vehicle or the path of a vehicle file; csv and mcap can do with the\n"
      "        recording's own.\n"
      "    recording: of csv and mcap, a Recording.\n"
      "    horizon: of csv and mcap, length of the free runs, seconds, up to 600.\n"
      "    draws: of mss and vrx, also so many joint draws of the coefficients, [1, 100000].\n"
      "    seed: of the draws; the same seed gives the same bits.\n"
      "    progress: called with the stage and the share done.\n\n"
      "Raises InputError, DataCannotTell, OSError where a file cannot be written.");
}

}  // namespace telltale::python
