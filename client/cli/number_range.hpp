#pragma once

#include <CLI/CLI.hpp>

namespace telltale {

/// Accepts numbers in [low, high]. CLI::Range accepts NaN too, since no comparison with NaN holds.
CLI::Validator NumberWithin(double low, double high);

}  // namespace telltale
