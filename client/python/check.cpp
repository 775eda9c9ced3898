#include "telltale/client/workbench/check_log.hpp"

#include "telltale/client/python/bindings.hpp"
#include "telltale/client/python/recording.hpp"

namespace telltale::python {
namespace {

namespace py = pybind11;

std::vector<Refusal> Check(const StatedLog& recording,
                           const std::optional<VehicleOrFile>& vehicle) {
  std::optional<Vehicle> stated = VehicleOf(vehicle);
  if (!stated) stated = recording.stated;
  const py::gil_scoped_release unlocked;
  const RecordedLog& log = recording.log;
  const auto& description = log.loaded.description;
  const CheckedLog checked =
      CheckLog(log.path, {recording.recorded, log.loaded.malformed, description, {}},
               stated ? *stated : DescribedOrUsualVehicle(description));
  std::vector<Refusal> findings = checked.check.faults;
  if (findings.empty() && checked.unusable) findings.push_back(*checked.unusable);
  return findings;
}

}  // namespace

void AddCheck(py::module_& module) {
  py::class_<Refusal>(module, "Finding",
                      "What data do not answer or a recording shows, and what to do.")
      .def_readonly("subject", &Refusal::subject, "What it is about.")
      .def_readonly("reason", &Refusal::reason, "What the data show.")
      .def_readonly("advice", &Refusal::advice, "What to do.")
      .def("__str__",
           [](const Refusal& finding) {
             return finding.subject + ": " + finding.reason + "\n-> " + finding.advice;
           })
      .def("__repr__", [](const Refusal& finding) {
        return "<telltale.Finding " + finding.subject + ": " + finding.reason + '>';
      });

  module.def(
      "check", &Check, py::arg("recording"), py::arg("vehicle") = py::none(),
      "Seeks faults of input, such as swapped thrusters, headings in another sense or units.\n\n"
      "Returns the suspected faults, the most certain first; where there is none, but nothing\n"
      "can be identified from the recording, the reason for that. Without a vehicle, 1100,\n"
      "1500 and 1900 us are taken for full reverse, neutral and full forward.");
}

}  // namespace telltale::python
