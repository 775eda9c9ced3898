#include "telltale/core/diagnosis/report/missing_force_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "telltale/core/base/format_number.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

constexpr std::array<std::string_view, 3> kForces = {"surge force", "sway force", "yaw moment"};
constexpr std::array<std::string_view, 3> kUnits = {"N", "N", "N m"};

/// The part of the missing force that a sentence is about: a component, and what it varies over;
/// constant where that is unknown.
struct TellingPart {
  std::size_t component = 0;
  ForceVariable variable = ForceVariable::kUnknown;
  double share = 0.0;
};

TellingPart TellingPartOf(const MissingForce& missing) {
  TellingPart best;
  double most = -1.0;
  const auto consider = [&](std::size_t i, ForceVariable variable, double share) {
    const double weight = share * std::max(missing.excess[i], 0.0);
    if (weight <= most) return;
    most = weight;
    best = {i, variable, share};
  };
  for (std::size_t i = 0; i < kForces.size(); ++i) {
    consider(i, ForceVariable::kUnknown, missing.constant_share[i]);
    for (const ForceProfile& profile : missing.over)
      consider(i, profile.variable, profile.share[i]);
  }
  return best;
}

bool Tells(const TellingPart& part) {
  return part.share >= kDiagnosis.missing_force.telling_share;
}

int DecimalsFor(double half_width) {
  return half_width >= 2.0 || !(half_width > 0.0) ? 0 : half_width >= 0.2 ? 1 : 2;
}

std::string WithUnit(const ForceMean& force, std::size_t component) {
  const int decimals = DecimalsFor(force.half_width);
  return FormatNumber(force.mean, decimals) + " \u00b1 " +
         FormatNumber(force.half_width, decimals) + ' ' + std::string(kUnits[component]);
}

std::string Between(const ForceBin& bin, ForceVariable variable) {
  const auto range = [&](int decimals) {
    return FormatNumber(bin.low, decimals) + " to " + FormatNumber(bin.high, decimals);
  };
  switch (variable) {
    case ForceVariable::kSpeed: return "at " + range(1) + " m/s";
    case ForceVariable::kMeanCommand: return "at mean commands of " + range(2);
    case ForceVariable::kCommandDifference: return "at command differences of " + range(2);
    case ForceVariable::kHeading: return "on headings of " + range(0) + " deg";
    case ForceVariable::kTime: return "at " + range(0) + " s";
    case ForceVariable::kUnknown: break;
  }
  return "";
}

std::string DescribeVariation(const ForceProfile& profile, std::size_t component) {
  const auto less = [&](const ForceBin& a, const ForceBin& b) {
    return a.force[component].mean < b.force[component].mean;
  };
  const auto [least, most] = std::minmax_element(profile.bins.begin(), profile.bins.end(), less);
  const auto at = [&](const ForceBin& bin) {
    return WithUnit(bin.force[component], component) + ' ' + Between(bin, profile.variable);
  };
  return "a " + std::string(kForces[component]) + " that is " + at(*least) + " and " + at(*most);
}

}  // namespace

std::string DescribeMissingForce(const MissingForce& missing) {
  const TellingPart part = TellingPartOf(missing);
  const std::string share = " (" + FormatNumber(100.0 * part.share, 0) + " % of its mean square)";
  if (!Tells(part)) {
    std::string scatter;
    for (std::size_t i = 0; i < kForces.size(); ++i) {
      scatter.append(i == 0 ? "" : ", ").append(FormatNumber(missing.scatter[i], 1) + ' ');
      scatter.append(kUnits[i]).append(" of ").append(kForces[i]);
    }
    return "no force that repeats over speed, commands, heading or time, but " + scatter +
           " that come and go within seconds";
  }
  if (part.variable == ForceVariable::kUnknown) {
    return "a constant " + std::string(kForces[part.component]) + " of " +
           WithUnit(missing.mean[part.component], part.component) + share;
  }
  const auto profile = std::find_if(missing.over.begin(), missing.over.end(),
                                    [&](const auto& one) { return one.variable == part.variable; });
  return DescribeVariation(*profile, part.component) + share;
}

SeparationAdvice AdviseRecording(const MissingForce& missing) {
  const TellingPart part = TellingPartOf(missing);
  const auto record = [](std::string_view name, std::string_view how, double duration_s) {
    return SeparationAdvice{std::string(name), std::string(how), {}, duration_s, 0.0, false};
  };
  if (!Tells(part)) {
    return record(
        "drift and a straight course",
        "five minutes without thrust, then five on one course at half command: what moves "
        "the boat at rest is wind, current or waves; what it does under thrust alone is of "
        "the propellers",
        600.0);
  }
  switch (part.variable) {
    case ForceVariable::kHeading:
      return record("eight headings",
                    "eight headings 45 degrees apart, a minute each at half command, then the same "
                    "again on another day: a force that stays with the compass is wind, current or "
                    "the compass itself",
                    480.0);
    case ForceVariable::kTime:
      return record(
          "the same again",
          "the same manoeuvres on another day with the boat as it is: what stays is of the "
          "boat, what changes is weather, the battery or a sensor",
          600.0);
    case ForceVariable::kCommandDifference:
      return record(
          "each thruster alone",
          "each thruster alone from full astern to full ahead in ten steps, 8 s each, with "
          "the current that it draws: shows the side",
          160.0);
    case ForceVariable::kSpeed:
    case ForceVariable::kMeanCommand:
      return record(
          "staircase both ways",
          "both thrusters from 0.1 to 1 in six steps and down again, 10 s each, on a course "
          "and on its opposite: drag is the same both ways, a current is not",
          240.0);
    case ForceVariable::kUnknown: break;
  }
  return record("rest and turn about",
                "two minutes without thrust on each of two opposite headings: a force that turns "
                "with the boat is of the boat",
                240.0);
}

}  // namespace telltale
