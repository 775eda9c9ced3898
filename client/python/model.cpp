#include "telltale/client/python/model.hpp"

#include <pybind11/eigen.h>

#include "telltale/client/exchange/posterior_draws.hpp"
#include "telltale/client/python/arguments.hpp"
#include "telltale/client/python/bindings.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/client/report/number_text.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/files.hpp"
#include "telltale/core/identification/posterior_draws.hpp"
#include "telltale/idl/codec/json/model.hpp"

namespace telltale::python {
namespace {

namespace py = pybind11;

using Bounded = ScoredIdentification;

std::vector<std::string> CoefficientNames(const Bounded& bounded) {
  std::vector<std::string> names;
  for (const Coefficient& c : bounded.model.coefficients) names.push_back(ColumnName(c));
  return names;
}

/// An array of one number of each coefficient.
template <class Number>
auto OfEachCoefficient(Number number) {
  return [number](const Bounded& bounded) { return ArrayOf(bounded.model.coefficients, number); };
}

py::array_t<double> CoefficientBounds(const Bounded& bounded) {
  const auto& coefficients = bounded.model.coefficients;
  py::array_t<double> bounds({static_cast<py::ssize_t>(coefficients.size()), py::ssize_t{2}});
  auto cells = bounds.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < cells.shape(0); ++i) {
    const Interval& interval = coefficients[static_cast<std::size_t>(i)].interval;
    cells(i, 0) = interval.lower;
    cells(i, 1) = interval.upper;
  }
  return bounds;
}

py::array_t<double> SimulationValuesOf(const Bounded& bounded) {
  return ArrayOf(WithSimulationParameters(bounded.model).coefficients, &Coefficient::estimate);
}

Coefficient CoefficientNamed(const Bounded& bounded, const std::string& name) {
  for (const Coefficient& c : bounded.model.coefficients) {
    if (name == ColumnName(c) || name == c.symbol) return c;
  }
  throw py::key_error(name);
}

struct NamedDraws {
  PosteriorDraws draws;
  std::vector<std::string> names;
};

NamedDraws Draw(const Bounded& bounded, std::size_t count, std::uint64_t seed) {
  RequireDraws("count", count);
  const py::gil_scoped_release unlocked;
  const Identification model = WithSimulationParameters(bounded.model);
  return {OrThrow(DrawFromPosterior(model, count, seed)), CoefficientNames(bounded)};
}

std::string ModelText(const Bounded& bounded) {
  const Identification& model = bounded.model;
  return "<telltale.Model of " + model.vehicle_id + ": " + std::string(Name(model.structure)) +
         ", " + std::string(Name(model.estimator)) + ", " +
         std::to_string(model.coefficients.size()) + " coefficients>";
}

void AddCoefficient(py::module_& module) {
  py::class_<Coefficient>(module, "Coefficient",
                          "One coefficient with its bounds, continuous-time, SI.")
      .def_property_readonly("name", &ColumnName,
                             "Equation and regressor, 'SURGE u|u|'; the symbol of a parameter that "
                             "belongs to no equation.")
      .def_property_readonly(
          "equation",
          [](const Coefficient& c) {
            return c.equation == Equation::kUnknown ? "" : std::string(Name(c.equation));
          },
          "'SURGE', 'SWAY' or 'YAW'; empty of a parameter that belongs to no equation.")
      .def_readonly("regressor", &Coefficient::regressor, "As in the notation: 'u|u|', 'f:d'.")
      .def_readonly("symbol", &Coefficient::symbol, "As in the notation: 'Pu11'.")
      .def_readonly("estimate", &Coefficient::estimate, "0 where NOT_EXCITED.")
      .def_readonly("standard_error", &Coefficient::standard_error, "Infinite where NOT_EXCITED.")
      .def_property_readonly(
          "lower", [](const Coefficient& c) { return c.interval.lower; }, "Lower bound.")
      .def_property_readonly(
          "upper", [](const Coefficient& c) { return c.interval.upper; }, "Upper bound.")
      .def_property_readonly(
          "level", [](const Coefficient& c) { return c.interval.level; },
          "The probability with which the bounds hold the true value.")
      .def_readonly("unit", &Coefficient::unit, "As '1/m'.")
      .def_property_readonly(
          "status", [](const Coefficient& c) { return std::string(Name(c.status)); },
          "'ESTIMATED', 'NOT_EXCITED', 'COLLINEAR' or 'PRIOR'.")
      .def("__repr__", [](const Coefficient& c) {
        return "<telltale.Coefficient " + ColumnName(c) + " = " + std::to_string(c.estimate) +
               " in [" + std::to_string(c.interval.lower) + ", " +
               std::to_string(c.interval.upper) + "] " + c.unit + '>';
      });
}

void AddDraws(py::module_& module) {
  py::class_<NamedDraws>(module, "Draws", "Models that the data allow.")
      .def_property_readonly(
          "values",
          [](const NamedDraws& draws) -> Eigen::MatrixXd { return draws.draws.theta.transpose(); },
          "One draw a row, one coefficient a column.")
      .def_readonly("names", &NamedDraws::names, "Of the columns.")
      .def_property_readonly(
          "time_constant_s",
          [](const NamedDraws& draws) -> std::optional<py::array_t<double>> {
            const auto& tau_s = draws.draws.time_constant_s;
            if (tau_s.empty()) return std::nullopt;
            return ArrayOf(tau_s, [](double value) { return value; });
          },
          "Thruster time constants, of the dynamic structure alone; else None.")
      .def_property_readonly(
          "not_drawn", [](const NamedDraws& draws) { return draws.draws.not_drawn; },
          "What is the same in every draw, since the data do not determine it.")
      .def("__repr__", [](const NamedDraws& draws) {
        return "<telltale.Draws: " +
               Counted(static_cast<std::size_t>(draws.draws.theta.cols()), "draw", "draws") +
               " of " + Counted(draws.names.size(), "coefficient", "coefficients") + '>';
      });
}

using ModelClass = py::class_<Bounded, std::shared_ptr<Bounded>>;

void AddText(ModelClass& model) {
  model
      .def_static(
          "from_json",
          [](const std::string& text) { return Bounded{OrThrow(ParseModelJson(text, "text"))}; },
          py::arg("text"), "Reads the text of a model.json. Raises InputError naming the field.")
      .def(
          "to_json", [](const Bounded& bounded) { return PrintModelJson(bounded.model); },
          "The text of a model.json, as telltale identify --out writes it.")
      .def(
          "to_dict", [](const Bounded& bounded) { return FromJson(PrintModelJson(bounded.model)); },
          "All that model.json holds.")
      .def(
          "save",
          [](const Bounded& bounded, const std::filesystem::path& path) {
            WriteFile(path, PrintModelJson(bounded.model));
          },
          py::arg("path"), "Writes a model.json. Raises OSError where it cannot.");
}

void AddOrigin(ModelClass& model) {
  model
      .def_property_readonly(
          "vehicle_id", [](const Bounded& bounded) { return bounded.model.vehicle_id; },
          "The boat that it is of.")
      .def_property_readonly(
          "structure",
          [](const Bounded& bounded) { return std::string(Name(bounded.model.structure)); },
          "'FOSSEN', 'STATIC_QUADRATIC' or 'FIRST_ORDER_DYNAMIC'.")
      .def_property_readonly(
          "estimator",
          [](const Bounded& bounded) { return std::string(Name(bounded.model.estimator)); },
          "How it was estimated: 'ONE_STEP', 'WEAK_IV', 'OUTPUT_ERROR' and the like.")
      .def_property_readonly(
          "sampling_period_s",
          [](const Bounded& bounded) { return bounded.model.sampling_period_s; },
          "Of the discrete model.");
}

void AddValues(ModelClass& model) {
  model
      .def_property_readonly(
          "coefficients", [](const Bounded& bounded) { return bounded.model.coefficients; },
          "Those of every equation that was answered.")
      .def_property_readonly(
          "parameters",
          [](const Bounded& bounded) {
            return bounded.model.physical ? bounded.model.physical->parameters
                                          : std::vector<Coefficient>();
          },
          "Physical parameters, of the structure FOSSEN alone; else empty.")
      .def_property_readonly("names", &CoefficientNames, "'SURGE u|u|' and the like.")
      .def_property_readonly("values", OfEachCoefficient(&Coefficient::estimate), "Estimates.")
      .def_property_readonly("standard_errors", OfEachCoefficient(&Coefficient::standard_error),
                             "Infinite where NOT_EXCITED.")
      .def_property_readonly("bounds", &CoefficientBounds,
                             "Lower and upper bound, a row a coefficient.")
      .def_property_readonly(
          "covariance",
          [](const Bounded& bounded) -> Eigen::MatrixXd { return bounded.model.covariance; },
          "Square; infinite variance and zero covariances where NOT_EXCITED.")
      .def_property_readonly(
          "simulation_values", &SimulationValuesOf,
          "What simulations use: the values, regularised where a simulation with them diverges.");
}

void AddUse(ModelClass& model) {
  model
      .def_property_readonly(
          "refusals", [](const Bounded& bounded) { return bounded.model.refusals; },
          "What the data do not determine, and what to record.")
      .def_readonly("held_out", &Bounded::held_out,
                    "Scores of a model of the first part of the recording on the rest of it, where "
                    "this one was identified just now; else None.")
      .def(
          "draws", &Draw, py::arg("count"), py::arg("seed") = 1,
          "Draws models that the data allow, [1, 100000] of them: joint draws of the coefficients, "
          "as wide as the bounds. The same seed gives the same bits. Raises DataCannotTell where "
          "no coefficient has a finite variance.")
      .def("__getitem__", &CoefficientNamed, py::arg("name"),
           "A coefficient by its name, 'SURGE u|u|', or its symbol.")
      .def("__repr__", &ModelText);
}

}  // namespace

void AddModel(py::module_& module) {
  AddCoefficient(module);
  AddDraws(module);
  ModelClass model(module, "Model",
                   "A boat's model with bounds: accelerations as linear combinations of "
                   "regressors. Coefficients "
                   "stand in the order of names. Every array is a copy.");
  AddText(model);
  AddOrigin(model);
  AddValues(model);
  AddUse(model);

  module.def(
      "load_model",
      [](const std::filesystem::path& path) {
        RequireThere(path);
        return Bounded{LoadModel(path)};
      },
      py::arg("path"), "Reads a model.json. Raises InputError naming field, value and range.");
}

}  // namespace telltale::python
