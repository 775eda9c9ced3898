# TELLTALE_PYTHON: whether the package `telltale` of Python is built. A sanitizer would have to be loaded
# before the interpreter, which has none.
set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "The interpreter that the package is for: Debian's")
find_package(Python 3.11 QUIET COMPONENTS Interpreter Development.Module NumPy)
find_package(pybind11 2.10 QUIET)
if(Python_FOUND AND pybind11_FOUND AND NOT TELLTALE_SANITIZE)
  set(telltale_python_possible ON)
else()
  set(telltale_python_possible OFF)
endif()
option(TELLTALE_PYTHON "Build the Python package" ${telltale_python_possible})
