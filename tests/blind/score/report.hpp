#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace blind::score {

/// Effects by name; a cause is a set of them, alone or together.
using EffectSet = std::set<std::string>;

inline constexpr std::string_view kUnknown = "unknown";

/// What the label of a case says.
struct Label {
  std::string kind;  // nominal, single, pair or outside (the library)
  EffectSet effects;
  EffectSet weather = {};                          // there besides: may be named, and need not
  std::map<std::string, double> sizes = {};        // of all these, in typical sizes
  std::map<std::string, double> towards_deg = {};  // where of these what has a direction runs to
};

/// A 95 % interval of directions, degrees clockwise from north.
struct Direction {
  double towards_deg = 0.0;
  double half_width_deg = 180.0;
  bool or_opposite = false;
};

struct Cause {
  EffectSet effects;
  double probability = 0.0;
  EffectSet indistinguishable;                       // single effects
  std::set<EffectSet> indistinguishable_sets;        // whole sets, where a report gives such
  std::map<std::string, Direction> directions = {};  // by effect
};

/// What a report.json says, as far as it is scored.
struct Report {
  std::string verdict;
  std::vector<Cause> causes;  // the likeliest first
  std::map<std::string, double> detectability;
  std::map<std::string, double> unknown_regressors;  // of the odds of the unknown cause, by name
  std::optional<double> closure;                     // predicted
  std::optional<double> realised;                    // from NNN.realised.json
};

/// Both throw std::invalid_argument naming what is wrong with the text.
Label ParseLabel(const std::string& json);
Report ParseReport(const std::string& json);

/// The "closure" of a realised.json; throws std::invalid_argument likewise.
double ParseRealised(const std::string& json);

}  // namespace blind::score
