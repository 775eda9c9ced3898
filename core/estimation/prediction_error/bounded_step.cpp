#include "telltale/core/estimation/prediction_error/bounded_step.hpp"

#include <vector>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace telltale {

Eigen::VectorXd BoundedStep(const Eigen::VectorXd& z, const Eigen::VectorXd& least,
                            const Eigen::VectorXd& greatest, const Eigen::MatrixXd& information,
                            const Eigen::VectorXd& gradient, double damping) {
  const Eigen::Index n = z.size();
  Eigen::VectorXd step = Eigen::VectorXd::Zero(n);
  std::vector<bool> fixed(static_cast<std::size_t>(n), false);
  for (int pass = 0; pass < 12; ++pass) {
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < n; ++i)
      if (!fixed[static_cast<std::size_t>(i)]) free.push_back(i);
    Eigen::MatrixXd a(free.size(), free.size());
    Eigen::VectorXd b(free.size());
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      const Eigen::Index fi = free[static_cast<std::size_t>(i)];
      b[i] = gradient[fi];
      for (Eigen::Index j = 0; j < n; ++j) {
        if (fixed[static_cast<std::size_t>(j)]) b[i] -= information(fi, j) * step[j];
      }
      for (Eigen::Index j = 0; j < a.cols(); ++j) {
        a(i, j) = information(fi, free[static_cast<std::size_t>(j)]);
      }
      a(i, i) *= 1.0 + damping;
    }
    const Eigen::VectorXd solved = a.partialPivLu().solve(b);
    bool again = false;
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      const Eigen::Index fi = free[static_cast<std::size_t>(i)];
      const double to = z[fi] + solved[i];
      step[fi] = solved[i];
      if (to < least[fi]) {
        step[fi] = least[fi] - z[fi];
        fixed[static_cast<std::size_t>(fi)] = again = true;
      } else if (to > greatest[fi]) {
        step[fi] = greatest[fi] - z[fi];
        fixed[static_cast<std::size_t>(fi)] = again = true;
      }
    }
    if (!again) break;
  }
  return step;
}

}  // namespace telltale
