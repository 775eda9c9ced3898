#include "telltale/core/drift/drift_test.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string_view>
#include <utility>
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

/// What is known of an unknown times a number.
ChangeInformation Scaled(const ChangeInformation& unknown, double by) {
  return {unknown.precision / (by * by), unknown.projection / by};
}

using InformationByChange = std::array<ChangeInformation, kDrift.changes.size()>;
using Changes = std::array<double, kDrift.changes.size()>;

/// What a sum of windows says of each change, and the variance of unit weight.
struct Estimates {
  InformationByChange of_change;
  double residual_variance = 0.0;
};

Estimates EstimatesOf(const DriftEvidence& evidence) {
  const MarginalChanges forces(evidence.free_runs, PrecisionOfNuisances());
  const MarginalChanges sideslip(evidence.sideslip, PrecisionOfSideslip());
  Estimates estimates{{}, forces.ResidualVariance()};
  for (std::size_t j = 0; j < kDrift.changes.size(); ++j) {
    const ChangeInformation of_forces = forces.Of(static_cast<Eigen::Index>(j));
    estimates.of_change[j] =
        kDrift.changes[j].effect == kCompass ? Together(of_forces, sideslip.Of(0)) : of_forces;
  }
  return estimates;
}

/// By how much a change is beyond that of the reference; zero on a side that is not watched, and
/// where one of the two tells nothing.
double Beyond(const ChangeInformation& reference, const ChangeInformation& now,
              const WatchedChange& change) {
  if (reference.precision <= 0.0 || now.precision <= 0.0) return 0.0;
  const double value = now.Value() - reference.Value();
  return change.both_signs || value * change.step > 0.0 ? value : 0.0;
}

Changes AllBeyond(const InformationByChange& reference, const InformationByChange& now) {
  Changes beyond;
  for (std::size_t j = 0; j < beyond.size(); ++j) {
    beyond[j] = Beyond(reference[j], now[j], kDrift.changes[j]);
  }
  return beyond;
}

/// The nearer of two to zero; zero where they are on different sides of it.
double Lesser(double a, double b) {
  if (a * b <= 0.0) return 0.0;
  return std::abs(a) < std::abs(b) ? a : b;
}

/// What is left of each change whichever block is left out.
Changes LeastBeyond(const InformationByChange& reference, std::span<const DriftEvidence> blocks,
                    Changes least) {
  for (std::size_t left_out = 0; left_out < blocks.size(); ++left_out) {
    DriftEvidence others = SumOf(blocks.first(left_out));
    others.Add(SumOf(blocks.subspan(left_out + 1)));
    const Changes beyond = AllBeyond(reference, EstimatesOf(others).of_change);
    std::ranges::transform(least, beyond, least.begin(), Lesser);
  }
  return least;
}

double Margin(const DriftFinding& finding) {
  return finding.Excess() / finding.change->alarm_sigmas;
}

/// Of the findings the one that is beyond doubt and explains most, then those beyond their
/// tolerance that explain nearly as much; none where none is beyond doubt.
std::vector<DriftFinding> Inseparable(std::vector<DriftFinding> findings) {
  std::ranges::sort(findings, std::ranges::greater(), &DriftFinding::explained);
  const auto best = std::ranges::find_if(findings, &DriftFinding::IsBeyondDoubt);
  if (best == findings.end()) return {};
  std::vector<DriftFinding> likely = {*best};
  for (const DriftFinding& other : findings) {
    const bool rivals = other.explained >= kDrift.rival_share * best->explained;
    if (other.change != best->change && other.Excess() > 0.0 && rivals) likely.push_back(other);
  }
  return likely;
}

}  // namespace

double DriftFinding::Excess() const {
  return (std::abs(value) - change->tolerance) / standard_error;
}

bool DriftFinding::IsBeyondDoubt() const {
  return std::abs(least) >= change->tolerance + change->alarm_sigmas * standard_error;
}

std::string DriftFinding::Describe() const {
  const Effect* effect = FindEffect(change->effect);
  return effect->Describe(At({effect, change->parameter}, value).values);
}

/// Weather stays for as long as it does in the shortest span. The regression of later estimates on
/// those of the reference predicts what the model errs itself.
DriftTest::DriftTest(std::span<const DriftEvidence> reference) : reference_{} {
  const std::size_t span = std::ranges::min(kDrift.spans) * kDrift.block_windows;
  for (; reference.size() >= span; reference = reference.subspan(span)) {
    const Estimates estimates = EstimatesOf(SumOf(reference.first(span)));
    for (std::size_t j = 0; j < reference_.size(); ++j) {
      reference_[j].precision += estimates.of_change[j].precision;
      reference_[j].projection += estimates.of_change[j].projection;
    }
  }
  for (std::size_t j = 0; j < reference_.size(); ++j) {
    reference_[j] = Scaled(reference_[j], kDrift.changes[j].reference_slope);
  }
}

/// The changes that the blocks tell enough of.
DriftTest::Findings DriftTest::FindingsOf(std::span<const DriftEvidence> blocks) const {
  const Estimates now = EstimatesOf(SumOf(blocks));
  Findings findings;
  findings.follow_no_pattern = now.residual_variance > kDrift.largest_residual_variance;
  if (findings.follow_no_pattern) return findings;
  const double variance = std::max(1.0, now.residual_variance);
  const Changes beyond = AllBeyond(reference_, now.of_change);
  const Changes least = LeastBeyond(reference_, blocks, beyond);
  for (std::size_t j = 0; j < reference_.size(); ++j) {
    const WatchedChange& change = kDrift.changes[j];
    const double precision = now.of_change[j].precision;
    const double squared_error = variance / precision;
    const bool tells = std::sqrt(squared_error) <= change.largest_standard_error;
    if (!tells || reference_[j].precision <= 0.0) continue;
    findings.of_changes.push_back({&change, beyond[j], least[j],
                                   std::sqrt(squared_error + 1.0 / reference_[j].precision),
                                   beyond[j] * beyond[j] * precision});
  }
  return findings;
}

void DriftTest::Add(std::span<const DriftEvidence> block) {
  blocks_.push_back(SumOf(block));
  if (blocks_.size() > std::ranges::max(kDrift.spans)) blocks_.erase(blocks_.begin());
  strongest_.reset();
  is_tested_ = {};
  follow_no_pattern_ = true;
  std::vector<DriftFinding> likeliest;
  for (const std::size_t span : kDrift.spans) {
    if (blocks_.size() < span) continue;
    const Findings findings = FindingsOf(std::span(blocks_).last(span));
    NoteTested(findings);
    for (const DriftFinding& finding : findings.of_changes) {
      if (!strongest_ || Margin(finding) > Margin(*strongest_)) strongest_ = finding;
    }
    std::vector<DriftFinding> likely = Inseparable(findings.of_changes);
    if (likely.empty()) continue;
    const bool better = likeliest.empty() || likely[0].explained > likeliest[0].explained;
    if (better) likeliest = std::move(likely);
  }
  const bool is_beyond_doubt = !likeliest.empty();
  if (is_beyond_doubt && was_beyond_doubt_) alarm_ = std::move(likeliest);
  was_beyond_doubt_ = is_beyond_doubt;
  if (strongest_ && strongest_->Excess() < 0.0) alarm_.clear();
}

void DriftTest::NoteTested(const Findings& findings) {
  follow_no_pattern_ = follow_no_pattern_ && findings.follow_no_pattern;
  for (const DriftFinding& finding : findings.of_changes) {
    is_tested_[static_cast<std::size_t>(finding.change - kDrift.changes.data())] = true;
  }
}

std::string DriftTest::Untested() const {
  std::string changes;
  for (std::size_t j = 0; j < is_tested_.size(); ++j) {
    if (is_tested_[j]) continue;
    changes.append(changes.empty() ? "" : ", ").append(kDrift.changes[j].of_what);
  }
  if (changes.empty()) return "";
  if (blocks_.size() < std::ranges::min(kDrift.spans)) return changes + ": too little has come yet";
  if (follow_no_pattern_) return changes + ": the errors are large and follow no known pattern";
  return changes + ": commands and heading vary too little";
}

}  // namespace telltale
