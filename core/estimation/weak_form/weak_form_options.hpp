#pragma once

#include "telltale/core/estimation/regression/cluster_options.hpp"

namespace telltale {

/// How the equations of motion are projected onto test functions. Lengths are in seconds. A test
/// function spans at least five sampling periods to each side of its centre, whatever they say.
struct WeakFormOptions {
  double half_support_s = 2.0;  ///< of a test function, T
  double spacing_s = 1.0;       ///< of neighbouring test functions
  ClusterOptions clusters;      ///< of supports, by their centres
};

}  // namespace telltale
