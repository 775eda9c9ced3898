#include "baselines/regressions.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "baselines/accelerations.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace blind::baselines {
namespace {

constexpr std::size_t kMostEffects = 3;
constexpr double kWorthwhile = 0.1;        // of what is explained
constexpr double kRidge = 0.25;            // a prior of twice the typical size
constexpr double kLowestThreshold = 0.02;  // typical sizes
constexpr double kHighestThreshold = 2.0;
constexpr double kThresholdStep = 1.25;

/// Effects by their place in the library of those that have parameters.
using Support = std::set<std::size_t>;

struct Fit {
  Support support;
  std::vector<double> sizes;  ///< of its columns, typical sizes
  bool in_range = true;
  double square = 0.0;
  double bic = 0.0;
};

class Regression {
 public:
  explicit Regression(const ReferenceBasis& basis)
      : parameter_refs_(basis.parameter_refs), accelerations_(AccelerationsOf(basis)) {
    for (std::size_t i = 0; i < parameter_refs_.size(); ++i) {
      if (i == 0 || parameter_refs_[i].effect != parameter_refs_[i - 1].effect)
        columns_of_.emplace_back();
      columns_of_.back().push_back(static_cast<Eigen::Index>(i));
    }
  }

  std::size_t Effects() const { return columns_of_.size(); }

  Fit FitOf(const Support& support, double ridge) const {
    const std::vector<Eigen::Index> columns = ColumnsOf(support);
    const Eigen::MatrixXd signatures = accelerations_.signatures(Eigen::all, columns);
    Eigen::MatrixXd information = signatures.transpose() * signatures;
    information.diagonal().array() += ridge;
    const Eigen::VectorXd along = signatures.transpose() * accelerations_.residuals;
    const Eigen::VectorXd sizes = information.ldlt().solve(along);
    Fit fit{.support = support,
            .sizes = {sizes.begin(), sizes.end()},
            .square = (accelerations_.residuals - signatures * sizes).squaredNorm()};
    for (std::size_t i = 0; i < columns.size(); ++i) {
      fit.in_range = fit.in_range && InRange(columns[i], fit.sizes[i]) == fit.sizes[i];
    }
    const double n = accelerations_.independent;
    fit.bic = n * std::log(fit.square / static_cast<double>(accelerations_.residuals.size())) +
              static_cast<double>(columns.size()) * std::log(n);
    return fit;
  }

  /// Those of a fit whose largest size, within its range, is the threshold or more.
  Support Above(double threshold, const Fit& fit) const {
    Support above;
    std::size_t next = 0;
    for (const std::size_t effect : fit.support) {
      for (const Eigen::Index column : columns_of_[effect]) {
        if (std::abs(InRange(column, fit.sizes[next++])) >= threshold) above.insert(effect);
      }
    }
    return above;
  }

  ScoredExplanation ExplanationOf(const Fit& fit) const {
    ScoredExplanation explanation{.effects = {}, .bic = fit.bic};
    std::size_t next = 0;
    for (const std::size_t effect : fit.support) {
      for (const Eigen::Index column : columns_of_[effect]) {
        const telltale::EffectParameterRef& parameter_ref =
            parameter_refs_[static_cast<std::size_t>(column)];
        const double value = fit.sizes[next++] * Typical(parameter_ref);
        if (column == columns_of_[effect].front()) {
          explanation.effects.push_back(telltale::At(parameter_ref, value));
        } else {
          explanation.effects.back().values[parameter_ref.parameter] = value;
        }
      }
    }
    return explanation;
  }

 private:
  static const telltale::EffectParameter& ParameterOf(
      const telltale::EffectParameterRef& parameter_ref) {
    return parameter_ref.effect->Parameters()[parameter_ref.parameter];
  }
  static double Typical(const telltale::EffectParameterRef& parameter_ref) {
    return ParameterOf(parameter_ref).typical;
  }

  double InRange(Eigen::Index column, double size) const {
    const telltale::EffectParameter& parameter =
        ParameterOf(parameter_refs_[static_cast<std::size_t>(column)]);
    return std::clamp(size, parameter.lower / parameter.typical,
                      parameter.upper / parameter.typical);
  }

  std::vector<Eigen::Index> ColumnsOf(const Support& support) const {
    std::vector<Eigen::Index> columns;
    for (const std::size_t effect : support) {
      columns.insert(columns.end(), columns_of_[effect].begin(), columns_of_[effect].end());
    }
    return columns;
  }

  std::vector<telltale::EffectParameterRef> parameter_refs_;
  Accelerations accelerations_;
  std::vector<std::vector<Eigen::Index>> columns_of_;
};

/// Every fit with one effect more, the best first.
std::vector<Fit> OneMore(const Regression& regression, const Fit& fit) {
  std::vector<Fit> larger;
  for (std::size_t effect = 0; effect < regression.Effects(); ++effect) {
    Support support = fit.support;
    if (!support.insert(effect).second) continue;
    if (Fit more = regression.FitOf(support, 0.0); more.in_range) larger.push_back(std::move(more));
  }
  std::sort(larger.begin(), larger.end(), [](const Fit& a, const Fit& b) { return a.bic < b.bic; });
  return larger;
}

Support ThresholdedSupport(const Regression& regression, double threshold) {
  Support support;
  for (std::size_t effect = 0; effect < regression.Effects(); ++effect) support.insert(effect);
  while (true) {
    Support above = regression.Above(threshold, regression.FitOf(support, kRidge));
    if (above == support) return support;
    support = std::move(above);
  }
}

}  // namespace

std::vector<ScoredExplanation> Stepwise(const ReferenceBasis& basis) {
  const Regression regression(basis);
  const Fit none = regression.FitOf({}, 0.0);
  Fit best = none;
  std::vector<ScoredExplanation> explanations{regression.ExplanationOf(none)};
  while (best.support.size() < kMostEffects) {
    const std::vector<Fit> larger = OneMore(regression, best);
    if (larger.empty() || larger.front().bic >= best.bic) break;
    const Fit& next = larger.front();
    if (best.square - next.square < kWorthwhile * (none.square - next.square)) break;
    for (const Fit& fit : larger) explanations.push_back(regression.ExplanationOf(fit));
    best = next;
  }
  return explanations;
}

std::vector<ScoredExplanation> Sparse(const ReferenceBasis& basis) {
  const Regression regression(basis);
  std::vector<ScoredExplanation> explanations{regression.ExplanationOf(regression.FitOf({}, 0.0))};
  std::set<Support> seen{Support{}};
  for (double threshold = kLowestThreshold; threshold <= kHighestThreshold;
       threshold *= kThresholdStep) {
    const Support support = ThresholdedSupport(regression, threshold);
    if (support.size() > kMostEffects || !seen.insert(support).second) continue;
    if (const Fit fit = regression.FitOf(support, 0.0); fit.in_range) {
      explanations.push_back(regression.ExplanationOf(fit));
    }
  }
  return explanations;
}

}  // namespace blind::baselines
