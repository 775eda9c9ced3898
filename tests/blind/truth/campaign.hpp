#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hull.hpp"

namespace blind::truth {

struct AppliedEffect {
  std::string effect;
  double size = 1.0;  // times typical
  double sign = 1.0;
};

/// One recording to be diagnosed.
struct Case {
  std::string kind;  // nominal, single, pair or outside (the library)
  std::vector<AppliedEffect> effects;
  std::vector<AppliedEffect> weather;  // beside those: wind, current or waves on half of all days
  std::size_t hull = 0;
  std::uint64_t day = 0;  // of no two cases alike
};

/// All cases of a set in the order of their numbers, which is drawn. Half of each kind is in
/// weather, that of its effects or some beside them.
std::vector<Case> PlannedCases(Set set, std::uint64_t seed, std::size_t repeats);

/// Calm days with nothing wrong, none of them one of the set's cases, dealt out over its hulls.
std::vector<Case> NominalDays(Set set, std::uint64_t seed, std::size_t days);

struct CampaignOptions {
  Set set = Set::kDevelopment;
  std::uint64_t seed = 1;
  std::size_t repeats = 1;
  std::optional<std::size_t> nominal_days;  ///< so many of these in place of the set's cases
  std::optional<std::size_t> most_cases;
  double duration_s = 600.0;
  /// Each case once more beside it: hull, weather and effects as they were, another mission, other
  /// gusts, waves and sensor noise.
  bool again = false;
};

/// Called before each recording with how many there are and are done.
using Progress = std::function<void(std::size_t done, std::size_t all)>;

/// Writes hulls/, cases/ and labels/ below `folder`.
void WriteCampaign(const CampaignOptions& options, const std::filesystem::path& folder,
                   const Progress& progress);

struct SingleCaseOptions {
  Set set = Set::kDevelopment;
  std::uint64_t seed = 1;
  std::string hull;  // empty: the first
  std::vector<AppliedEffect> effects;
  double onset_s = 0.0;
  double duration_s = 600.0;
};

/// Writes log/, hull, vehicle.textproto and label.sealed (sealed as "single") below `folder`;
/// returns the label. Throws std::invalid_argument for an unknown hull or effect.
std::string WriteSingleCase(const SingleCaseOptions& options, const std::filesystem::path& folder);

}  // namespace blind::truth
