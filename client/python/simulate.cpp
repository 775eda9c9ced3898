#include "telltale/client/workbench/simulate_model.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/client/python/arguments.hpp"
#include "telltale/client/python/bindings.hpp"
#include "telltale/client/python/model.hpp"
#include "telltale/client/report/number_text.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/core/base/format_number.hpp"

namespace telltale::python {
namespace {

namespace py = pybind11;

constexpr double kShortestStepS = 0.001;
constexpr double kLongestStepS = 1.0;
constexpr double kLongestRunS = 86400.0;  // as of a recording

std::vector<TimedCommand> TimedCommandsOf(const Numbers& time_s, const Numbers& commands) {
  const auto times = ColumnOf("time_s", time_s);
  if (times.empty()) throw UsageError("time_s: give one command at least");
  const auto rows = CommandRowsOf(commands, times.size());
  std::vector<TimedCommand> timed;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i]) || (i > 0 && times[i] <= times[i - 1])) {
      throw UsageError("time_s: " + FormatSignificant(times[i], 9) + " of row " +
                       std::to_string(i) + " does not come after the one before");
    }
    timed.push_back({times[i], rows[i]});
  }
  if (const double run_s = times.back() - times.front(); run_s > kLongestRunS) {
    throw UsageError("time_s: the commands last " + FormatSignificant(run_s, 9) +
                     " s, more than the " + FormatSignificant(kLongestRunS, 9) +
                     " s of the longest run");
  }
  return timed;
}

void RequireStep(const std::optional<double>& step_s) {
  if (!step_s || (*step_s >= kShortestStepS && *step_s <= kLongestStepS)) return;
  throw UsageError("--step: " + FormatSignificant(*step_s, 9) + " is outside [0.001, 1]");
}

std::vector<TimedState> Simulated(const ScoredIdentification& model, const Numbers& time_s,
                                  const Numbers& commands,
                                  const std::optional<VehicleOrFile>& vehicle,
                                  std::optional<double> step_s) {
  RequireStep(step_s);
  const auto timed = TimedCommandsOf(time_s, commands);
  const Vehicle boat = VehicleOf(vehicle).value_or(Vehicle{});
  const py::gil_scoped_release unlocked;
  return SimulateModel(model.model, timed, boat, step_s).track;
}

/// A Python type of its own: a vector of states would become a list.
struct Track {
  std::vector<TimedState> states;
};

template <class Field>
auto OfEachState(Field field) {
  return [field](const Track& track) { return ArrayOf(track.states, field); };
}

py::array_t<double> TrackCommands(const Track& track) {
  return CommandArrayOf(track.states, &TimedState::delta);
}

std::string TrackText(const Track& track) {
  return "<telltale.Track of " + Counted(track.states.size(), "instant", "instants") + ", " +
         Plain(track.states.front().time_s) + " s to " + Plain(track.states.back().time_s) + " s>";
}

}  // namespace

void AddSimulate(py::module_& module) {
  const auto eta = [](double Eta::*of) {
    return OfEachState([of](const TimedState& s) { return s.state.eta.*of; });
  };
  const auto nu = [](double Nu::*of) {
    return OfEachState([of](const TimedState& s) { return s.state.nu.*of; });
  };
  py::class_<Track>(module, "Track",
                    "A simulated boat, an instant an element. Every array is a copy.")
      .def_property_readonly("time_s", OfEachState(&TimedState::time_s),
                             "From the first command on.")
      .def_property_readonly("north_m", eta(&Eta::x_m), "From where the boat starts.")
      .def_property_readonly("east_m", eta(&Eta::y_m), "From where the boat starts.")
      .def_property_readonly("heading_rad", eta(&Eta::psi_rad),
                             "Clockwise from north, without jumps.")
      .def_property_readonly("surge", nu(&Nu::u), "Velocity ahead, m/s.")
      .def_property_readonly("sway", nu(&Nu::v), "Velocity to starboard, m/s.")
      .def_property_readonly("yaw_rate", nu(&Nu::r), "To starboard, rad/s.")
      .def_property_readonly("commands", &TrackCommands,
                             "The commands that act, a row each, port first.")
      .def("__len__", [](const Track& track) { return track.states.size(); })
      .def("__repr__", &TrackText);

  module.def(
      "simulate",
      [](const ScoredIdentification& model, const Numbers& time_s, const Numbers& commands,
         const std::optional<VehicleOrFile>& vehicle, std::optional<double> step) {
        return Track{Simulated(model, time_s, commands, vehicle, step)};
      },
      py::arg("model"), py::arg("time_s"), py::arg("commands"), py::arg("vehicle") = py::none(),
      py::kw_only(), py::arg("step") = py::none(),
      "Drives a model open loop, from rest and heading north.\n\n"
      "Args:\n"
      "    model: a Model.\n"
      "    time_s: when each command begins, ascending; the run ends with the last,\n"
      "        a day after the first at most.\n"
      "    commands: shares of full command, [-1, 1], a row each, port first.\n"
      "    vehicle: a Vehicle or the path of a vehicle file, whose hull scales the effects that a\n"
      "        diagnosis added to a model.\n"
      "    step: integrate the continuous equations with this step, seconds, [0.001, 1]; by\n"
      "        default the discrete model as it was identified.\n\n"
      "Raises InputError, DataCannotTell where the model lacks an equation or diverges.");
}

}  // namespace telltale::python
