#pragma once

#include <cstddef>

namespace telltale {

/// How residuals are grouped into clusters of neighbouring time, over which standard errors are
/// summed. Residuals of different clusters count as independent.
struct ClusterOptions {
  double longest_s = 20.0;  ///< of a cluster
  double shortest_s = 8.0;  ///< of a cluster, whatever `wanted` asks for
  std::size_t wanted = 80;  ///< clusters in the recording, before both limits apply
};

/// The length of a cluster in seconds: recorded_s / wanted, within the two limits.
double ClusterLength(const ClusterOptions& options, double recorded_s);

/// How many clusters a segment of `rows` rows at `sampling_period_s` gives, at least one.
double ClustersIn(std::size_t rows, double sampling_period_s, double cluster_s);

}  // namespace telltale
