#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "telltale/core/identification/progress.hpp"
#include "telltale/core/vessel/propellers.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale::python {

/// An array of numbers as a caller gives it: anything that NumPy turns into one.
using Numbers = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// A vehicle, or the file of one.
using VehicleOrFile = std::variant<Vehicle, std::filesystem::path>;

/// Throws: FileNotFoundError, where nothing is there.
void RequireThere(const std::filesystem::path& path);

/// Throws: as RequireThere and LoadVehicle.
std::optional<Vehicle> VehicleOf(const std::optional<VehicleOrFile>& stated);

/// The numbers of an array of one dimension. Throws: UsageError naming the array, where it has
/// more, or where it has another length than `length`.
std::vector<double> ColumnOf(const char* name, const Numbers& numbers,
                             std::optional<std::size_t> length = std::nullopt);

/// Commands in shares of full command, a row each, port first. Throws: UsageError, where there are
/// other than two columns, or other than `rows` rows, or one is outside [-1, 1].
std::vector<PropellerCommand> CommandRowsOf(const Numbers& commands,
                                            std::optional<std::size_t> rows = std::nullopt);

/// Those of many elements as an array of two columns, port first; `field` makes one of an element.
template <class Elements, class Field>
pybind11::array_t<double> CommandArrayOf(const Elements& elements, Field field) {
  pybind11::array_t<double> commands(
      {static_cast<pybind11::ssize_t>(elements.size()), pybind11::ssize_t{2}});
  double* next = commands.mutable_data();
  for (const auto& element : elements) {
    const PropellerCommand& command = std::invoke(field, element);
    *next++ = command.port;
    *next++ = command.starboard;
  }
  return commands;
}

/// Throws: UsageError naming `argument`, where so many draws cannot be asked for.
void RequireDraws(const char* argument, std::size_t count);

/// Tells `callback`, if it is not None, and ends the computation where a signal such as Ctrl-C has
/// come, or the callback raises. For computations without the interpreter lock.
/// Requires: `callback` outlives the result.
Progress Interruptible(const pybind11::object& callback);

/// A NumPy array of one field of each element, or of what `field` makes of it.
template <class Elements, class Field>
pybind11::array_t<double> ArrayOf(const Elements& elements, Field field) {
  pybind11::array_t<double> array(static_cast<pybind11::ssize_t>(elements.size()));
  double* next = array.mutable_data();
  for (const auto& element : elements) *next++ = std::invoke(field, element);
  return array;
}

/// What `json.loads` makes of a text.
pybind11::object FromJson(const std::string& text);

}  // namespace telltale::python
