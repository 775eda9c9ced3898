#include "telltale/client/workbench/errors.hpp"

#include <algorithm>
#include <exception>
#include <regex>
#include <string>
#include <system_error>
#include <utility>

#include "telltale/client/python/bindings.hpp"

namespace telltale::python {
namespace {

namespace py = pybind11;

/// Options spelled as the arguments of functions: `--skip-input-check` is skip_input_check.
std::string WithArgumentNames(const std::string& text) {
  static const std::regex option("--([a-z]+(-[a-z]+)*)");
  std::string spelled;
  auto rest = text.cbegin();
  for (std::sregex_iterator found(text.begin(), text.end(), option), end; found != end; ++found) {
    spelled.append(rest, (*found)[0].first);
    std::string name = (*found)[1];
    std::replace(name.begin(), name.end(), '-', '_');
    spelled += name == "map" ? "mapping" : name;
    rest = (*found)[0].second;
  }
  return spelled.append(rest, text.cend());
}

void Raise(const char* exception, const py::tuple& arguments) {
  const py::object type = py::module_::import("telltale.errors").attr(exception);
  PyErr_SetObject(type.ptr(), arguments.ptr());
}

void RaiseAsPython(std::exception_ptr failure) {
  try {
    if (failure) std::rethrow_exception(std::move(failure));
  } catch (const RefusedError& error) {
    const Refusal& refusal = error.Answer();
    Raise("DataCannotTell",
          py::make_tuple(WithArgumentNames(refusal.subject), WithArgumentNames(refusal.reason),
                         WithArgumentNames(refusal.advice)));
  } catch (const UsageError& error) {
    Raise("InputError", py::make_tuple(WithArgumentNames(error.what())));
  } catch (const FileError& error) {
    Raise("InputError", py::make_tuple(WithArgumentNames(error.what())));
  } catch (const std::system_error& error) {
    const auto arguments = py::make_tuple(error.code().value(), error.what());
    PyErr_SetObject(PyExc_OSError, arguments.ptr());
  }
}

}  // namespace

void AddErrors(py::module_&) {
  py::register_exception_translator(&RaiseAsPython);
}

}  // namespace telltale::python
