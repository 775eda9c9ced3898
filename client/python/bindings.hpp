#pragma once

#include <pybind11/pybind11.h>

namespace telltale::python {

/// Each gives the module what its file is about. Types come before the functions that take them.
void AddErrors(pybind11::module_& module);
void AddVehicle(pybind11::module_& module);
void AddRecording(pybind11::module_& module);
void AddFinding(pybind11::module_& module);
void AddModel(pybind11::module_& module);
void AddCheck(pybind11::module_& module);
void AddIdentify(pybind11::module_& module);
void AddValidate(pybind11::module_& module);
void AddDiagnose(pybind11::module_& module);
void AddSimulate(pybind11::module_& module);
void AddGain(pybind11::module_& module);
void AddCompare(pybind11::module_& module);
void AddExport(pybind11::module_& module);

}  // namespace telltale::python
