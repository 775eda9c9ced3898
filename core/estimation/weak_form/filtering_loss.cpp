#include "telltale/core/estimation/weak_form/filtering_loss.hpp"

#include <algorithm>

#include "telltale/core/vessel/body_regressors.hpp"

namespace telltale {
namespace {

template <class Series>
Series BetweenRows(const Series& rows) {
  const Eigen::Index intervals = rows.rows() - 1;
  return 0.5 * (rows.topRows(intervals) + rows.bottomRows(intervals));
}

template <class Surge, class Turning>
void WriteBodyRow(const Nu& nu, Eigen::Index row, Surge& surge, Turning& turning) {
  const BodyRow body = BodyRowAt(nu);
  std::ranges::copy(body.surge, surge.row(row).data());
  std::ranges::copy(body.turning, turning.row(row).data());
}

template <class Series>
auto LossOver(const Series& between, const Series& filtered, const Eigen::VectorXd& smoothed,
              const Eigen::VectorXd& phi, Eigen::Index first_interval, Eigen::Index first) {
  return (smoothed.transpose() * between.middleRows(first_interval, smoothed.size()) -
          phi.transpose() * filtered.middleRows(first, phi.size()))
      .eval();
}

}  // namespace

FilteringLoss::FilteringLoss(std::span<const PredictedInstant> predicted,
                             const Eigen::VectorXd& kernel)
    : filtered_surge_(Rows<5>::Zero(std::ssize(predicted), 5)),
      filtered_turning_(Rows<9>::Zero(std::ssize(predicted), 9)),
      half_width_(kernel.size() / 2) {
  const Eigen::Index n = std::ssize(predicted);
  Rows<3> nu(n, 3);
  Rows<5> surge(n, 5);
  Rows<9> turning(n, 9);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Nu& now = predicted[static_cast<std::size_t>(k)].nu;
    nu.row(k) << now.u, now.v, now.r;
    WriteBodyRow(now, k, surge, turning);
  }
  surge_ = BetweenRows(surge);
  turning_ = BetweenRows(turning);
  const Rows<3> mean = BetweenRows(nu);
  for (Eigen::Index k = half_width_; k + half_width_ < n; ++k) {
    const Eigen::RowVector3d smoothed =
        kernel.transpose() * mean.middleRows(k - half_width_, kernel.size());
    WriteBodyRow({smoothed[0], smoothed[1], smoothed[2]}, k, filtered_surge_, filtered_turning_);
  }
}

Eigen::RowVectorXd FilteringLoss::Over(Eigen::Index first, bool surge,
                                       const Eigen::VectorXd& smoothed,
                                       const Eigen::VectorXd& phi) const {
  const Eigen::Index interval = first - half_width_;
  if (surge) return LossOver(surge_, filtered_surge_, smoothed, phi, interval, first);
  return LossOver(turning_, filtered_turning_, smoothed, phi, interval, first);
}

}  // namespace telltale
