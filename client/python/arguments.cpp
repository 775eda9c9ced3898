#include "telltale/client/python/arguments.hpp"

#include <cerrno>
#include <cmath>

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

std::vector<PropellerCommand> CommandRowsOf(const Numbers& commands,
                                            std::optional<std::size_t> rows) {
  const bool is_table = commands.ndim() == 2 && commands.shape(1) == 2;
  if (!is_table || (rows && static_cast<std::size_t>(commands.shape(0)) != *rows)) {
    throw UsageError("commands: give an array of " +
                     (rows ? std::to_string(*rows) + " rows, one for each time, and " : "") +
                     "two columns, port and starboard");
  }
  const auto is_share = [](double command) { return std::abs(command) <= 1.0; };
  const auto cells = commands.unchecked<2>();
  std::vector<PropellerCommand> read;
  for (py::ssize_t row = 0; row < cells.shape(0); ++row) {
    const PropellerCommand command{cells(row, 0), cells(row, 1)};
    if (!is_share(command.port) || !is_share(command.starboard)) {
      throw UsageError("commands: those of row " + std::to_string(row) +
                       " are not both in [-1, 1], shares of full command");
    }
    read.push_back(command);
  }
  return read;
}

void RequireDraws(const char* argument, std::size_t count) {
  constexpr std::size_t kMost = 100'000;
  if (count >= 1 && count <= kMost) return;
  throw UsageError(std::string(argument) + ": " + std::to_string(count) + " is outside [1, " +
                   std::to_string(kMost) + ']');
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
