#include "telltale/core/estimation/regression/cluster_options.hpp"

#include <algorithm>
#include <cmath>

namespace telltale {

double ClusterLength(const ClusterOptions& options, double recorded_s) {
  return std::clamp(recorded_s / static_cast<double>(options.wanted), options.shortest_s,
                    options.longest_s);
}

double ClustersIn(std::size_t rows, double sampling_period_s, double cluster_s) {
  return std::max(1.0, std::round(static_cast<double>(rows) * sampling_period_s / cluster_s));
}

}  // namespace telltale
