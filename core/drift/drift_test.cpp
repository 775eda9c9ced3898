#include "telltale/core/drift/drift_test.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <vector>

#include "telltale/core/diagnosis/residuals/sensitivity.hpp"
#include "telltale/core/effects/effect.hpp"

namespace telltale {
namespace {

constexpr std::string_view kCompass = "heading_bias";

double PrecisionOf(double sd) {
  return 1.0 / (sd * sd);
}

Eigen::VectorXd PrecisionOfNuisances() {
  Eigen::VectorXd precision(kDrift.nuisances.size());
  for (std::size_t i = 0; i < kDrift.nuisances.size(); ++i) {
    precision[static_cast<Eigen::Index>(i)] = PrecisionOf(kDrift.nuisances[i].prior_sd);
  }
  return precision;
}

/// Of what else makes sideslip: DriftEvidence::sideslip.
Eigen::VectorXd PrecisionOfSideslip() {
  const double through_water = PrecisionOf(kDrift.drift_through_water_sd);
  const double in_turns = PrecisionOf(kDrift.sideslip_in_turns_sd);
  return Eigen::Vector4d(through_water, through_water, in_turns, in_turns);
}

/// Sideslip tells of the compass too.
ChangeInformation Together(const ChangeInformation& of_free_runs,
                           const ChangeInformation& of_sideslip) {
  return {kDrift.free_runs_weight * of_free_runs.precision + of_sideslip.precision,
          kDrift.free_runs_weight * of_free_runs.projection + of_sideslip.projection};
}

/// Zero on a side that is not watched.
double Watched(const WatchedChange& change, double value) {
  return change.both_signs || value * change.step > 0.0 ? value : 0.0;
}

/// What a sum of windows says of each change, and the variance of unit weight.
struct Estimates {
  std::array<ChangeInformation, kDrift.changes.size()> of_change;
  std::array<double, kDrift.changes.size()> explained;  ///< squares of the free runs' errors
  double residual_variance = 0.0;
};

Estimates EstimatesOf(const DriftEvidence& evidence) {
  const MarginalChanges forces(evidence.free_runs, PrecisionOfNuisances());
  const MarginalChanges sideslip(evidence.sideslip, PrecisionOfSideslip());
  Estimates estimates{{}, {}, forces.ResidualVariance()};
  for (std::size_t j = 0; j < kDrift.changes.size(); ++j) {
    const ChangeInformation of_forces = forces.Of(static_cast<Eigen::Index>(j));
    estimates.explained[j] = of_forces.projection * of_forces.Value();
    estimates.of_change[j] =
        kDrift.changes[j].effect == kCompass ? Together(of_forces, sideslip.Of(0)) : of_forces;
  }
  return estimates;
}

}  // namespace

double DriftFinding::Excess() const {
  return (std::abs(value) - change->tolerance) / standard_error;
}

std::string DriftFinding::Describe() const {
  const Effect* effect = FindEffect(change->effect);
  return effect->Describe(At({effect, change->parameter}, value).values);
}

/// Weather stays for as long as it does in the shortest span.
DriftTest::DriftTest(std::span<const DriftEvidence> reference) : reference_{} {
  const std::size_t span = std::ranges::min(kDrift.spans) * kDrift.block_windows;
  for (; reference.size() >= span; reference = reference.subspan(span)) {
    const Estimates estimates = EstimatesOf(SumOf(reference.first(span)));
    for (std::size_t j = 0; j < reference_.size(); ++j) {
      reference_[j].precision += estimates.of_change[j].precision;
      reference_[j].projection += estimates.of_change[j].projection;
    }
  }
}

/// The changes that evidence tells enough of.
std::vector<DriftFinding> DriftTest::FindingsOf(const DriftEvidence& latest) const {
  const Estimates now = EstimatesOf(latest);
  std::vector<DriftFinding> findings;
  if (now.residual_variance > kDrift.largest_residual_variance) return findings;
  const double variance = std::max(1.0, now.residual_variance);
  for (std::size_t j = 0; j < reference_.size(); ++j) {
    const WatchedChange& change = kDrift.changes[j];
    const double squared_error = variance / now.of_change[j].precision;
    const bool tells = std::sqrt(squared_error) <= change.largest_standard_error;
    if (!tells || reference_[j].precision <= 0.0) continue;
    findings.push_back({&change, Watched(change, now.of_change[j].Value() - reference_[j].Value()),
                        std::sqrt(squared_error + 1.0 / reference_[j].precision),
                        now.explained[j]});
  }
  return findings;
}

void DriftTest::Add(std::span<const DriftEvidence> block) {
  blocks_.push_back(SumOf(block));
  if (blocks_.size() > std::ranges::max(kDrift.spans)) blocks_.pop_front();
  const auto margin = [](const DriftFinding& finding) {
    return finding.Excess() / finding.change->alarm_sigmas;
  };
  strongest_.reset();
  std::optional<DriftFinding> best;
  DriftEvidence latest = DriftEvidence::None();
  std::size_t blocks = 0;
  for (auto before = blocks_.rbegin(); before != blocks_.rend(); ++before) {
    latest.Add(*before);
    if (std::ranges::find(kDrift.spans, ++blocks) == kDrift.spans.end()) continue;
    for (const DriftFinding& finding : FindingsOf(latest)) {
      if (!strongest_ || margin(finding) > margin(*strongest_)) strongest_ = finding;
      if (!finding.IsBeyondDoubt()) continue;
      if (!best || finding.explained > best->explained) best = finding;
    }
  }
  if (best) alarm_ = best;
  if (strongest_ && strongest_->Excess() < 0.0) alarm_.reset();
}

}  // namespace telltale
