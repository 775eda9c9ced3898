#include <string>

#include "telltale/client/python/bindings.hpp"
#include "telltale/core/base/version.hpp"

// The package telltale/__init__.py presents what is bound here.
PYBIND11_MODULE(_telltale, module) {
  module.doc() = "The compiled part of the package telltale.";
  module.attr("__version__") = std::string(telltale::Version());
  telltale::python::AddErrors(module);
  telltale::python::AddVehicle(module);
  telltale::python::AddRecording(module);
  telltale::python::AddFinding(module);
  telltale::python::AddModel(module);
  telltale::python::AddCheck(module);
  telltale::python::AddValidate(module);
  telltale::python::AddIdentify(module);
  telltale::python::AddDiagnose(module);
  telltale::python::AddSimulate(module);
  telltale::python::AddGain(module);
  telltale::python::AddCompare(module);
  telltale::python::AddExport(module);
}
