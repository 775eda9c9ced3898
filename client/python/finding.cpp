#include "telltale/core/base/result.hpp"

#include "telltale/client/python/bindings.hpp"

namespace telltale::python {

namespace py = pybind11;

void AddFinding(py::module_& module) {
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
}

}  // namespace telltale::python
