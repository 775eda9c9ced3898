#include "telltale/core/vessel/vehicle.hpp"

#include "telltale/client/python/arguments.hpp"
#include "telltale/client/python/bindings.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/files.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale::python {
namespace {

namespace py = pybind11;

/// What a vehicle file could state. Throws: FileError naming the field, its value and its range.
Vehicle Stated(const std::string& vehicle_id, const PwmChannel& port, const PwmChannel& starboard,
               double propeller_separation_m, std::pair<double, double> gnss_antenna_m,
               std::optional<double> mass_kg) {
  Vehicle vehicle;
  vehicle.vehicle_id = vehicle_id;
  vehicle.port = port;
  vehicle.starboard = starboard;
  vehicle.propeller_separation_m = propeller_separation_m;
  vehicle.gnss_antenna = {gnss_antenna_m.first, gnss_antenna_m.second};
  vehicle.mass_kg = mass_kg;
  return OrThrow(ParseVehicle(PrintVehicle(vehicle), "vehicle"));
}

}  // namespace

void AddVehicle(py::module_& module) {
  py::class_<PwmChannel>(module, "PwmChannel",
                         "The pulse widths of one thruster, microseconds. A reversed channel has "
                         "full_forward_us below neutral_us.")
      .def(py::init([](double neutral_us, double full_forward_us, double full_reverse_us) {
             return PwmChannel{neutral_us, full_forward_us, full_reverse_us};
           }),
           py::arg("neutral_us") = 1500.0, py::arg("full_forward_us") = 1900.0,
           py::arg("full_reverse_us") = 1100.0)
      .def_readonly("neutral_us", &PwmChannel::neutral_us, "Stands still.")
      .def_readonly("full_forward_us", &PwmChannel::full_forward_us, "Full command ahead.")
      .def_readonly("full_reverse_us", &PwmChannel::full_reverse_us, "Full command astern.");

  py::class_<Vehicle>(module, "Vehicle",
                      "One boat as its operator states it. Raises InputError naming the field that "
                      "is out of its range.")
      .def(py::init(&Stated), py::arg("vehicle_id"), py::kw_only(), py::arg("port") = PwmChannel{},
           py::arg("starboard") = PwmChannel{}, py::arg("propeller_separation_m") = 0.0,
           py::arg("gnss_antenna_m") = std::pair(0.0, 0.0), py::arg("mass_kg") = py::none())
      .def_readonly("vehicle_id", &Vehicle::vehicle_id, "Names the boat.")
      .def_readonly("port", &Vehicle::port, "The thruster to the left.")
      .def_readonly("starboard", &Vehicle::starboard, "The thruster to the right.")
      .def_readonly("propeller_separation_m", &Vehicle::propeller_separation_m,
                    "Distance between the propellers.")
      .def_property_readonly(
          "gnss_antenna_m",
          [](const Vehicle& vehicle) {
            return std::pair(vehicle.gnss_antenna.forward_m, vehicle.gnss_antenna.starboard_m);
          },
          "Where the antenna is, forward and to starboard of the body origin.")
      .def_readonly("mass_kg", &Vehicle::mass_kg, "None where it is not stated.")
      .def("__str__", &PrintVehicle, "The text of a vehicle file.");

  module.def(
      "load_vehicle",
      [](const std::filesystem::path& path) {
        RequireThere(path);
        return LoadVehicle(path);
      },
      py::arg("path"),
      "Reads a vehicle file. Raises InputError naming line, field, value and range.");
}

}  // namespace telltale::python
