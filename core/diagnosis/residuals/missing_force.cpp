#include "telltale/core/diagnosis/residuals/missing_force.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/residuals/acceleration_residuals.hpp"
#include "telltale/core/effects/hull_scale.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {
namespace {

constexpr const MissingForceConstants& kLimits = kDiagnosis.missing_force;
constexpr std::size_t kComponents = 3;

using Residuals = std::vector<AccelerationResidual>;
using Components = std::array<double, kComponents>;

/// Residual acceleration over the constant acceleration that it stands for: a little below one,
/// since within a row's period drag already answers. Mean over the rows.
Components ResponseOf(const PreparedDataset& recording, const AugmentedModel& boat,
                      const Residuals& residuals) {
  constexpr double kPushed = 0.01;  // m/s^2, m/s^2, rad/s^2: small enough to stay linear
  const ModelledEffect push{FindEffect("body_bias"), {kPushed, kPushed, kPushed}};
  const Residuals pushed = AccelerationResidualsOf(recording, boat.With({{push}}));
  Components response{};
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    for (std::size_t i = 0; i < kComponents; ++i) {
      response[i] += (residuals[k].error[i] - pushed[k].error[i]) /
                     (kPushed * static_cast<double>(residuals.size()));
    }
  }
  return response;
}

/// Force over residual acceleration, and moment over residual yaw acceleration.
Components InertiaOf(const HullParticulars& hull, const Components& response) {
  const HullScale scale(hull);
  const double yaw = scale.yaw_inertia * scale.gyration_radius_m * scale.gyration_radius_m;
  return {hull.mass_kg / response[0], hull.mass_kg * scale.sway_mass / response[1],
          hull.mass_kg * yaw / response[2]};
}

double ValueOf(ForceVariable variable, const AccelerationResidual& residual) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  switch (variable) {
    case ForceVariable::kSpeed: return residual.nu.u;
    case ForceVariable::kMeanCommand: return 0.5 * (residual.delta.port + residual.delta.starboard);
    case ForceVariable::kCommandDifference: return residual.delta.port - residual.delta.starboard;
    case ForceVariable::kHeading: {
      const double degrees = std::fmod(residual.eta.psi_rad / kDegree, 360.0);
      return degrees < 0.0 ? degrees + 360.0 : degrees;
    }
    case ForceVariable::kTime: return residual.time_s;
    case ForceVariable::kUnknown: break;
  }
  return 0.0;
}

/// Sums of one component over the rows of a bin, by cluster.
class ClusteredMean {
 public:
  void Add(std::size_t cluster, double value) {
    auto& [sum, count] = clusters_[cluster];
    sum += value;
    count += 1.0;
    sum_ += value;
    rows_ += 1.0;
  }

  std::size_t Clusters() const { return clusters_.size(); }
  double Rows() const { return rows_; }
  double Mean() const { return sum_ / rows_; }

  double Variance() const {
    double squares = 0.0;
    for (const auto& [cluster, sums] : clusters_) {
      const double off = sums.first - sums.second * Mean();
      squares += off * off;
    }
    const auto n = static_cast<double>(clusters_.size());
    return squares / (rows_ * rows_) * (n / std::max(n - 1.0, 1.0));
  }

  ForceMean Bounded() const {
    constexpr double kNormal95 = 1.96;
    return {Mean(), kNormal95 * std::sqrt(Variance())};
  }

  /// Mean square of the clusters' means, each weighted by its rows.
  double MeanSquare() const {
    double squares = 0.0;
    for (const auto& [cluster, sums] : clusters_) squares += sums.first * sums.first / sums.second;
    return squares / rows_;
  }

 private:
  std::map<std::size_t, std::pair<double, double>> clusters_;
  double sum_ = 0.0;
  double rows_ = 0.0;
};

using Means = std::array<ClusteredMean, kComponents>;

Means MeansOf(const Residuals& residuals, const Components& inertia) {
  Means means;
  for (const AccelerationResidual& residual : residuals) {
    for (std::size_t i = 0; i < kComponents; ++i) {
      means[i].Add(residual.cluster, inertia[i] * residual.error[i]);
    }
  }
  return means;
}

/// The range of a variable in equal bins; headings all the way round.
std::vector<double> EdgesOf(ForceVariable variable, const Residuals& residuals) {
  double low = 0.0;
  double high = 360.0;
  if (variable != ForceVariable::kHeading) {
    const auto less = [&](const auto& a, const auto& b) {
      return ValueOf(variable, a) < ValueOf(variable, b);
    };
    const auto [first, last] = std::minmax_element(residuals.begin(), residuals.end(), less);
    low = ValueOf(variable, *first);
    high = ValueOf(variable, *last);
  }
  std::vector<double> edges;
  for (std::size_t i = 0; i <= kLimits.bins; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(kLimits.bins);
    edges.push_back(low + share * (high - low));
  }
  return edges;
}

std::size_t BinOf(double value, const std::vector<double>& edges) {
  const double width = edges[1] - edges[0];
  if (width <= 0.0) return 0;
  const auto bin = static_cast<std::size_t>(std::max((value - edges[0]) / width, 0.0));
  return std::min(bin, edges.size() - 2);
}

/// How much of a component the differences between bins hold; zero where they are chance.
double ShareBetween(const std::vector<const ClusteredMean*>& bins, const ClusteredMean& all) {
  if (bins.size() < 2) return 0.0;
  double chi_square = 0.0;
  double between = 0.0;
  double rows = 0.0;
  double weighted = 0.0;
  for (const ClusteredMean* bin : bins) {
    rows += bin->Rows();
    weighted += bin->Rows() * bin->Mean();
  }
  for (const ClusteredMean* bin : bins) {
    const double off = bin->Mean() - weighted / rows;
    chi_square += off * off / std::max(bin->Variance(), 1e-300);
    between += bin->Rows() / rows * (off * off - bin->Variance());
  }
  constexpr double kTests = static_cast<double>(kComponents * kForceVariables.size());
  const double limit =
      ChiSquaredQuantile(static_cast<double>(bins.size() - 1), 1.0 - kLimits.significance / kTests);
  if (chi_square < limit) return 0.0;
  return std::clamp(between / all.MeanSquare(), 0.0, 1.0);
}

ForceProfile ProfileOf(ForceVariable variable, const Residuals& residuals,
                       const Components& inertia, const Means& all) {
  const std::vector<double> edges = EdgesOf(variable, residuals);
  std::vector<Means> means(kLimits.bins);
  for (const AccelerationResidual& residual : residuals) {
    Means& bin = means[BinOf(ValueOf(variable, residual), edges)];
    for (std::size_t i = 0; i < kComponents; ++i) {
      bin[i].Add(residual.cluster, inertia[i] * residual.error[i]);
    }
  }
  ForceProfile profile;
  profile.variable = variable;
  std::array<std::vector<const ClusteredMean*>, kComponents> kept;
  for (std::size_t b = 0; b < means.size(); ++b) {
    if (means[b][0].Clusters() < kDiagnosis.localisation.minimum_clusters) continue;
    ForceBin& bin = profile.bins.emplace_back();
    bin.low = edges[b];
    bin.high = edges[b + 1];
    bin.rows = static_cast<std::size_t>(means[b][0].Rows());
    for (std::size_t i = 0; i < kComponents; ++i) {
      bin.force[i] = means[b][i].Bounded();
      kept[i].push_back(&means[b][i]);
    }
  }
  for (std::size_t i = 0; i < kComponents; ++i) profile.share[i] = ShareBetween(kept[i], all[i]);
  return profile;
}

/// Mean square of the clusters' means over that of all references.
Components ExcessOf(const Means& means, const std::vector<PreparedDataset>& references,
                    const AugmentedModel& boat, const Components& inertia) {
  Components nominal{};
  for (const PreparedDataset& reference : references) {
    const Means of_day = MeansOf(AccelerationResidualsOf(reference, boat), inertia);
    for (std::size_t i = 0; i < kComponents; ++i) {
      nominal[i] += of_day[i].MeanSquare() / static_cast<double>(references.size());
    }
  }
  Components excess{};
  for (std::size_t i = 0; i < kComponents; ++i) {
    excess[i] = means[i].MeanSquare() / std::max(nominal[i], 1e-300) - 1.0;
  }
  return excess;
}

}  // namespace

MissingForce MissingForceOf(const PreparedDataset& recording,
                            const std::vector<PreparedDataset>& references,
                            const AugmentedModel& boat) {
  const Residuals residuals = AccelerationResidualsOf(recording, boat);
  MissingForce missing;
  missing.mass_kg = recording.hull.mass_kg;
  if (residuals.empty()) return missing;
  const Components inertia = InertiaOf(recording.hull, ResponseOf(recording, boat, residuals));
  const Means means = MeansOf(residuals, inertia);
  for (std::size_t i = 0; i < kComponents; ++i) {
    missing.mean[i] = means[i].Bounded();
    missing.scatter[i] = std::sqrt(means[i].MeanSquare());
    const double constant = means[i].Mean() * means[i].Mean() - means[i].Variance();
    missing.constant_share[i] = std::clamp(constant / means[i].MeanSquare(), 0.0, 1.0);
  }
  for (const ForceVariable variable : kForceVariables) {
    missing.over.push_back(ProfileOf(variable, residuals, inertia, means));
  }
  missing.excess = ExcessOf(means, references, boat, inertia);
  return missing;
}

}  // namespace telltale
