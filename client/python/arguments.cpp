#include "telltale/client/python/arguments.hpp"

#include <cerrno>

#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/files.hpp"

namespace telltale::python {

namespace py = pybind11;

void RequireThere(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored)) return;
  errno = ENOENT;
  PyErr_SetFromErrnoWithFilename(PyExc_OSError, path.c_str());
  throw py::error_already_set();
}

std::optional<Vehicle> VehicleOf(const std::optional<VehicleOrFile>& stated) {
  if (!stated) return std::nullopt;
  if (const auto* vehicle = std::get_if<Vehicle>(&*stated)) return *vehicle;
  const auto& file = std::get<std::filesystem::path>(*stated);
  RequireThere(file);
  return LoadVehicle(file);
}

std::vector<double> ColumnOf(const char* name, const Numbers& numbers,
                             std::optional<std::size_t> length) {
  const std::string array(name);
  if (numbers.ndim() != 1) {
    throw UsageError(array + ": give an array of one dimension, not of " +
                     std::to_string(numbers.ndim()));
  }
  const auto size = static_cast<std::size_t>(numbers.size());
  if (length && size != *length) {
    throw UsageError(array + ": " + std::to_string(size) + " values, but " +
                     std::to_string(*length) + " times");
  }
  return {numbers.data(), numbers.data() + size};
}

Progress Interruptible(const py::object& callback) {
  return [&callback](std::string_view stage, double fraction) {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!callback.is_none()) callback(py::str(stage.data(), stage.size()), fraction);
  };
}

py::object FromJson(const std::string& text) {
  return py::module_::import("json").attr("loads")(text);
}

}  // namespace telltale::python
