#include <cmath>

#include "telltale/client/python/arguments.hpp"
#include "telltale/client/python/bindings.hpp"
#include "telltale/client/python/model.hpp"
#include "telltale/client/workbench/model_gains.hpp"

namespace telltale::python {
namespace {

namespace py = pybind11;

ModelGains Gained(const ScoredIdentification& model, const std::optional<Numbers>& commands) {
  return GainsOf(model.model,
                 commands ? CommandRowsOf(*commands) : std::vector<PropellerCommand>());
}

py::array_t<double> CommandsOf(const ModelGains& of) {
  return CommandArrayOf(of.gains, &CommandGain::delta);
}

py::array_t<double> AccelerationsOf(const ModelGains& of) {
  py::array_t<double> values({static_cast<py::ssize_t>(of.gains.size()), py::ssize_t{3}});
  auto cells = values.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < cells.shape(0); ++i) {
    for (const Equation equation : kEquations) {
      const auto axis = static_cast<py::ssize_t>(IndexOf(equation));
      const Eigen::Vector3d& gain = of.gains[static_cast<std::size_t>(i)].gain.gain;
      cells(i, axis) = of.model.Has(equation) ? gain[axis] : NAN;
    }
  }
  return values;
}

py::array_t<double> GainBoundsOf(const ModelGains& of) {
  py::array_t<double> bounds(
      {static_cast<py::ssize_t>(of.gains.size()), py::ssize_t{3}, py::ssize_t{2}});
  auto cells = bounds.mutable_unchecked<3>();
  for (py::ssize_t i = 0; i < cells.shape(0); ++i) {
    for (const Equation equation : kEquations) {
      const auto axis = static_cast<py::ssize_t>(IndexOf(equation));
      const InputGain& gain = of.gains[static_cast<std::size_t>(i)].gain;
      const bool is_there = of.model.Has(equation);
      const Interval interval = is_there ? BoundsOf(of.model, gain, equation) : Interval{};
      cells(i, axis, 0) = is_there ? interval.lower : NAN;
      cells(i, axis, 1) = is_there ? interval.upper : NAN;
    }
  }
  return bounds;
}

std::string GainsText(const ModelGains& of) {
  return PrintGainsJson(of.model, of.gains);
}

}  // namespace

void AddGain(py::module_& module) {
  py::class_<ModelGains>(module, "Gains",
                         "What commands do to the velocities once thrust has settled, an element a "
                         "command. Every array is a copy.")
      .def_property_readonly("commands", &CommandsOf,
                             "Shares of full command, a row each, port first.")
      .def_property_readonly("accelerations", &AccelerationsOf,
                             "Of surge and sway, m/s^2, and yaw, rad/s^2, a row a command; NaN of "
                             "an equation that was refused.")
      .def_property_readonly("bounds", &GainBoundsOf,
                             "Lower and upper bound of each acceleration: by command, axis, bound.")
      .def_property_readonly(
          "notes", [](const ModelGains& of) { return NotesOn(of.model, of.gains); },
          "What a reader has to know of them.")
      .def("to_json", &GainsText, "The text of a gain.json.")
      .def(
          "to_dict", [](const ModelGains& of) { return FromJson(GainsText(of)); },
          "All that gain.json holds: also the gains over one sampling period.")
      .def("__len__", [](const ModelGains& of) { return of.gains.size(); });

  module.def("gain", &Gained, py::arg("model"), py::arg("commands") = py::none(),
             "What commands do, by the values that simulations use.\n\n"
             "Args:\n"
             "    model: a Model.\n"
             "    commands: shares of full command, [-1, 1], a row each, port first; by default a\n"
             "        short catalogue.\n\n"
             "Raises InputError.");
}

}  // namespace telltale::python
