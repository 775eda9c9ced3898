#include "telltale/core/uncertainty/resampling_units.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "telltale/core/base/contract.hpp"

namespace telltale {

DrawPlan PlanSlices(std::size_t slices) {
  Require(slices > 0, "at least one segment");
  DrawPlan plan;
  plan.tickets.resize(slices);
  std::iota(plan.tickets.begin(), plan.tickets.end(), 0u);
  plan.units = slices;
  plan.draws = slices;
  return plan;
}

DrawPlan PlanBlocks(const Timeline& timeline, std::size_t length) {
  Require(length >= 1, "blocks of at least one instant");
  DrawPlan plan;
  for (const RowRange& run : timeline.runs) {
    const bool whole = run.size() <= length;
    for (std::size_t i = 0; i < std::max(run.size(), length); ++i) {
      plan.tickets.push_back(static_cast<std::uint32_t>(plan.units));
      if (!whole) ++plan.units;
    }
    if (whole) ++plan.units;
  }
  plan.draws = std::max<std::size_t>(1, (plan.tickets.size() + length / 2) / length);
  return plan;
}

SliceUnits::SliceUnits(const ClusteredFit& fit) {
  const auto r = static_cast<std::size_t>(fit.W.cols());
  systems_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(PackedLength(r)),
                                   static_cast<Eigen::Index>(fit.clusters.size()));
  for (std::size_t s = 0; s < fit.clusters.size(); ++s) {
    const auto first = static_cast<Eigen::Index>(fit.clusters[s].begin);
    const auto count = static_cast<Eigen::Index>(fit.clusters[s].size());
    const auto rows = fit.W.middleRows(first, count);
    const Eigen::MatrixXd gram = rows.transpose() * rows;
    const Eigen::VectorXd score = rows.transpose() * fit.residual.segment(first, count);
    double* system = systems_.col(static_cast<Eigen::Index>(s)).data();
    for (Eigen::Index j = 0; j < gram.cols(); ++j) {
      system = std::copy_n(gram.col(j).data() + j, gram.rows() - j, system);
      *system++ = score[j];
    }
  }
}

}  // namespace telltale
