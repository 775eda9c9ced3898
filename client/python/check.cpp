#include "telltale/client/workbench/check_json.hpp"
#include "telltale/client/workbench/check_log.hpp"

#include "telltale/client/python/bindings.hpp"
#include "telltale/client/python/recording.hpp"
#include "telltale/client/report/number_text.hpp"

namespace telltale::python {
namespace {

namespace py = pybind11;

CheckedLog Checked(const StatedLog& recording, const std::optional<VehicleOrFile>& vehicle,
                   const py::object& progress) {
  std::optional<Vehicle> stated = VehicleOf(vehicle);
  if (!stated) stated = recording.stated;
  const Progress interruptible = Interruptible(progress);
  const py::gil_scoped_release unlocked;
  const RecordedLog& log = recording.log;
  const auto& description = log.loaded.description;
  return CheckLog(log.path, {recording.recorded, log.loaded.malformed, description, {}},
                  stated ? *stated : DescribedOrUsualVehicle(description), interruptible);
}

std::vector<Refusal> FindingsOf(const CheckedLog& checked) {
  std::vector<Refusal> findings = checked.check.faults;
  if (findings.empty() && checked.unusable) findings.push_back(*checked.unusable);
  return findings;
}

std::optional<ChannelDelays> DelaysOf(const CheckedLog& checked) {
  return OptionalOf(checked.delays);
}

std::optional<Refusal> WhyDelaysAreUnknown(const CheckedLog& checked) {
  return checked.delays ? std::nullopt : std::optional(checked.delays.error());
}

std::string CheckText(const CheckedLog& checked) {
  return PrintCheckJson({checked});
}

py::object CheckDict(const CheckedLog& checked) {
  return FromJson(CheckText(checked))["logs"][py::int_(0)];
}

void AddDelays(py::module_& module) {
  py::class_<ChannelDelays>(module, "Delays",
                            "How the stamps of commands and fixes stand to the clock of the "
                            "headings, seconds. A delay whose status is 'PRIOR' is unknown: its "
                            "bounds are what is expected of any boat.")
      .def_readonly("commands", &ChannelDelays::commands, "How long after their stamps they act.")
      .def_readonly("fixes", &ChannelDelays::fixes,
                    "How long before their stamps the boat was there.")
      .def_readonly("start_s", &ChannelDelays::start_s, "Of the part that shows them.")
      .def_readonly("end_s", &ChannelDelays::end_s, "Of the part that shows them.")
      .def_readonly("warning", &ChannelDelays::warning,
                    "Why the bounds may not hold, a Finding, or None.")
      .def("__repr__", [](const ChannelDelays& delays) {
        return "<telltale.Delays: commands " + Fixed(delays.commands.estimate, 3) + " s, fixes " +
               Fixed(delays.fixes.estimate, 3) + " s>";
      });
}

void AddCheckResult(py::module_& module) {
  py::class_<CheckedLog>(module, "Check", "What a recording shows before a model is made of it.")
      .def_property_readonly("findings", &FindingsOf,
                             "Suspected faults, the most certain first; where there is none, but "
                             "nothing can be identified from the recording, the reason for that.")
      .def_property_readonly("delays", &DelaysOf,
                             "The Delays between the channels; None where they are unknown.")
      .def_property_readonly("delays_unknown", &WhyDelaysAreUnknown,
                             "Why the delays are unknown, a Finding; None where they are known.")
      .def("to_json", &CheckText, "The text of a check.json, as telltale check --out writes it.")
      .def("to_dict", &CheckDict,
           "All that check.json holds of the recording: also rates and gaps of its channels.")
      .def("__repr__", [](const CheckedLog& checked) {
        return "<telltale.Check of " + NameOf(checked.path) + ": " +
               Counted(FindingsOf(checked).size(), "finding", "findings") + '>';
      });
}

}  // namespace

void AddCheck(py::module_& module) {
  AddDelays(module);
  AddCheckResult(module);
  module.def(
      "check", &Checked, py::arg("recording"), py::arg("vehicle") = py::none(), py::kw_only(),
      py::arg("progress") = py::none(),
      "Seeks faults of input, such as swapped thrusters, headings in another sense or units, and\n"
      "estimates the delays between the channels with their bounds.\n\n"
      "Args:\n"
      "    recording: a Recording.\n"
      "    vehicle: a Vehicle or the path of a vehicle file, in place of the recording's own.\n"
      "        Without any, 1100, 1500 and 1900 us are taken for full reverse, neutral and full\n"
      "        forward, and delays are unknown.\n"
      "    progress: called with the stage and the share done, from any thread.\n\n"
      "Returns a Check. Delays are those of the model that identify(structure='fossen') makes, of\n"
      "the ten minutes in which the commands change the most.\n\n"
      "Raises InputError where the vehicle file is not as it should be. Ctrl-C ends it.");
}

}  // namespace telltale::python
