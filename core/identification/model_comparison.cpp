#include "identification/model_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace telltale {
namespace {

std::optional<Refusal> Unlike(const Identification& first, const Identification& second) {
  std::string what;
  const auto differs = [&](bool difference, const char* name) {
    if (difference) what += (what.empty() ? "" : ", ") + std::string(name);
  };
  differs(first.structure != second.structure, "structure");
  differs(first.parameterization != second.parameterization, "parameterization");
  differs(first.estimator != second.estimator, "estimator");
  differs(std::abs(first.sampling_period_s - second.sampling_period_s) > 1e-9, "sampling period");
  differs(first.dead_zone != second.dead_zone, "dead zone");
  if (what.empty()) return std::nullopt;
  return Refusal{"comparison", "the models differ in " + what,
                 "identify both with the same options"};
}

std::size_t SegmentsBehind(const Identification& identification) {
  if (identification.provenance.bootstrap_replicates == 0) return 0;
  return std::max<std::size_t>(identification.window.segments, 2);
}

/// The estimates of `model` in the order of `order`; what it lacks has infinite variance.
Estimates InOrderOf(const Identification& order, const Identification& model) {
  const auto p = static_cast<Eigen::Index>(order.coefficients.size());
  Estimates estimates;
  estimates.theta = Eigen::VectorXd::Zero(p);
  estimates.covariance = Eigen::MatrixXd::Zero(p, p);
  estimates.segments = SegmentsBehind(model);
  std::vector<Eigen::Index> places;
  for (const Coefficient& wanted : order.coefficients) {
    const auto found =
        std::find_if(model.coefficients.begin(), model.coefficients.end(), [&](const auto& c) {
          return c.equation == wanted.equation && c.regressor == wanted.regressor;
        });
    places.push_back(found == model.coefficients.end() ? -1 : found - model.coefficients.begin());
  }
  for (Eigen::Index i = 0; i < p; ++i) {
    const Eigen::Index from = places[static_cast<std::size_t>(i)];
    if (from < 0) {
      estimates.covariance(i, i) = std::numeric_limits<double>::infinity();
      continue;
    }
    estimates.theta[i] = model.coefficients[static_cast<std::size_t>(from)].estimate;
    for (Eigen::Index j = 0; j < p; ++j) {
      const Eigen::Index to = places[static_cast<std::size_t>(j)];
      if (to >= 0) estimates.covariance(i, j) = model.covariance(from, to);
    }
  }
  return estimates;
}

}  // namespace

Result<WaldTest> Compare(const Identification& first, const Identification& second) {
  if (auto refusal = Unlike(first, second)) return tl::unexpected(*refusal);
  return TestEquality(InOrderOf(first, first), InOrderOf(first, second));
}

}  // namespace telltale
