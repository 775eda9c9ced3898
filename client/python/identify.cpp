#include "telltale/client/workbench/identify_recorded.hpp"

#include <pybind11/stl.h>

#include "telltale/client/python/bindings.hpp"
#include "telltale/client/python/model.hpp"
#include "telltale/client/python/recording.hpp"
#include "telltale/client/workbench/errors.hpp"

namespace telltale::python {
namespace {

namespace py = pybind11;

/// "identify", or the limits themselves.
using DeadZoneArgument = std::variant<std::pair<double, double>, std::string>;

void ChooseDeadZone(const DeadZoneArgument& argument, IdentifyChoices& choices) {
  if (const auto* limits = std::get_if<std::pair<double, double>>(&argument)) {
    choices.dead_zone = {limits->first, limits->second};
    return;
  }
  RequireOneOf({"identify"}, "--dead-zone", std::get<std::string>(argument));
  choices.identify_dead_zone = true;
}

ScoredIdentification Identified(
    const OneOrMore& recordings, const std::optional<VehicleOrFile>& vehicle,
    const std::optional<std::string>& structure, const std::optional<std::string>& parameterization,
    const std::optional<DeadZoneArgument>& dead_zone, const std::optional<std::string>& estimator,
    const std::optional<std::string>& preset, std::optional<double> sampling_period,
    std::optional<std::size_t> replicates, std::optional<std::uint32_t> bootstrap,
    const std::optional<std::string>& bootstrap_kind, const std::optional<std::string>& interval,
    const std::optional<std::string>& recording_bias, std::uint32_t check_coverage,
    std::optional<double> level, std::uint64_t seed, std::optional<std::size_t> threads,
    bool include_rr, bool skip_input_check, const py::object& progress) {
  IdentifyChoices choices;
  choices.structure = structure;
  choices.parameterization = parameterization;
  if (dead_zone) ChooseDeadZone(*dead_zone, choices);
  choices.estimator = estimator;
  choices.preset = preset;
  choices.sampling_period_s = sampling_period;
  choices.parametric_replicates = replicates;
  choices.bootstrap_replicates = bootstrap;
  choices.bootstrap_kind = bootstrap_kind;
  choices.interval = interval;
  choices.recording_bias = recording_bias;
  choices.coverage_check_replicates = check_coverage;
  choices.interval_level = level;
  choices.seed = seed;
  choices.threads = threads;
  choices.include_rr = include_rr;

  const Recordings logs = ListOf(recordings);
  const InputFaults faults = skip_input_check ? InputFaults::kIgnored : InputFaults::kSought;
  const RecordedVehicle recorded = Joined(logs, vehicle, faults);
  const Progress interruptible = Interruptible(progress);
  const py::gil_scoped_release unlocked;
  ScoredModel scored = IdentifyRecorded(recorded, choices, interruptible);
  ScoredIdentification identified{std::move(scored.model)};
  if (scored.score) identified.held_out = std::move(scored.score->metrics);
  return identified;
}

}  // namespace

void AddIdentify(py::module_& module) {
  module.def(
      "identify", &Identified, py::arg("recordings"), py::arg("vehicle") = py::none(),
      py::arg("structure") = py::none(), py::kw_only(), py::arg("parameterization") = py::none(),
      py::arg("dead_zone") = py::none(), py::arg("estimator") = py::none(),
      py::arg("preset") = py::none(), py::arg("sampling_period") = py::none(),
      py::arg("replicates") = py::none(), py::arg("bootstrap") = py::none(),
      py::arg("bootstrap_kind") = py::none(), py::arg("interval") = py::none(),
      py::arg("recording_bias") = py::none(), py::arg("check_coverage") = 0,
      py::arg("level") = py::none(), py::arg("seed") = 1, py::arg("threads") = py::none(),
      py::arg("include_rr") = false, py::arg("skip_input_check") = false,
      py::arg("progress") = py::none(),
      "Identifies a boat's model, with bounds.\n\n"
      "It gives the same numbers as the command telltale identify, whose options are called alike "
      "and explained in its --help.\n\n"
      "Args:\n"
      "    recordings: a Recording, or several of one boat.\n"
      "    vehicle: a Vehicle or the path of a vehicle file, in place of the recordings' own.\n"
      "    structure: 'fossen' (default), 'static' (with options that only it has), 'dynamic', or\n"
      "        'auto' for what predicts better.\n"
      "    parameterization: of the propellers, 'propeller' or 'paper'.\n"
      "    dead_zone: two limits in shares of full command, or 'identify'.\n"
      "    estimator: 'auto', 'weak-iv', 'output-error' or 'one-step'.\n"
      "    preset: of the data preparation, 'robust' or 'paper'.\n"
      "    sampling_period: of the model, seconds, [0.02, 2]; by default the median GNSS period.\n"
      "    replicates: parametric bootstrap replicates of weak-iv, [8, 1000] or 0.\n"
      "    bootstrap, bootstrap_kind, interval: of one-step.\n"
      "    recording_bias: 'shared', 'per-recording' or 'per-recording-ned'.\n"
      "    check_coverage: synthetic datasets on which the bounds are checked, [10, 1000] or 0.\n"
      "    level: of the bounds, [0.5, 0.999], by default 0.95.\n"
      "    seed: of everything random; the same seed gives the same bits.\n"
      "    threads: [1, 256], by default all of the machine; never changes the result.\n"
      "    include_rr: also fit rows in which both propellers turn in reverse.\n"
      "    skip_input_check: identify although the input shows a fault; check() says which.\n"
      "    progress: called with the stage and the share done, from any thread.\n\n"
      "Raises InputError for arguments out of their range, DataCannotTell with what to record "
      "where "
      "the recordings do not determine a model. Ctrl-C ends it.");
}

}  // namespace telltale::python
