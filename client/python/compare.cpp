#include "telltale/client/workbench/compare_models.hpp"

#include "telltale/client/python/arguments.hpp"
#include "telltale/client/python/bindings.hpp"
#include "telltale/client/python/model.hpp"
#include "telltale/core/identification/model_comparison.hpp"
#include "telltale/idl/codec/json/model_change.hpp"

namespace telltale::python {
namespace {

namespace py = pybind11;

struct NotedChange {
  ModelChange change;
  std::vector<std::string> notes;
};

NotedChange Compared(const ScoredIdentification& earlier, const ScoredIdentification& later) {
  NotedChange noted;
  noted.change = CompareModels(earlier.model, later.model,
                               [&](const std::string& note) { noted.notes.push_back(note); });
  return noted;
}

std::string EquationOf(const CoefficientChange& change) {
  return change.equation == Equation::kUnknown ? "" : std::string(Name(change.equation));
}

}  // namespace

void AddCompare(py::module_& module) {
  py::class_<CoefficientChange>(module, "CoefficientChange",
                                "How one coefficient changed, later less earlier.")
      .def_property_readonly("equation", &EquationOf,
                             "'SURGE', 'SWAY' or 'YAW'; empty of the boat's own parameters.")
      .def_readonly("regressor", &CoefficientChange::regressor, "As in the notation.")
      .def_readonly("symbol", &CoefficientChange::symbol, "As in the notation.")
      .def_readonly("difference", &CoefficientChange::difference, "In the coefficient's unit.")
      .def_readonly("standard_error", &CoefficientChange::standard_error, "Of the difference.")
      .def_property_readonly("sigmas", &CoefficientChange::Sigmas,
                             "The difference in standard errors.")
      .def_readonly("p_value", &CoefficientChange::p_value,
                    "Of this coefficient alone, not corrected for looking at many.");
  py::class_<NotedChange>(module, "Change", "Whether two models differ by more than their errors.")
      .def_property_readonly(
          "differ",
          [](const NotedChange& noted) { return noted.change.verdict == ChangeVerdict::kChanged; },
          "Whether they do.")
      .def_property_readonly(
          "sentence", [](const NotedChange& noted) { return AnswerOf(noted.change); },
          "The answer in words.")
      .def_property_readonly(
          "p_value", [](const NotedChange& noted) { return noted.change.p_value; },
          "That models of one unchanged boat differ this much.")
      .def_property_readonly(
          "statistic", [](const NotedChange& noted) { return noted.change.statistic; },
          "Wald statistic.")
      .def_property_readonly(
          "degrees_of_freedom",
          [](const NotedChange& noted) { return noted.change.degrees_of_freedom; },
          "Combinations that it sums over.")
      .def_property_readonly(
          "coefficients", [](const NotedChange& noted) { return noted.change.coefficients; },
          "The most significant first.")
      .def_readonly("notes", &NotedChange::notes, "What makes the test doubtful.")
      .def(
          "to_json", [](const NotedChange& noted) { return PrintChangeJson(noted.change); },
          "The text of a change.json.")
      .def(
          "to_dict",
          [](const NotedChange& noted) { return FromJson(PrintChangeJson(noted.change)); },
          "All that change.json holds.");

  module.def("compare", &Compared, py::arg("earlier"), py::arg("later"),
             "Tests whether two models of a boat differ by more than their errors. They must rest "
             "on different data and be identified with the same options. Raises DataCannotTell "
             "where they cannot be compared.");
}

}  // namespace telltale::python
