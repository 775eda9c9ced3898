#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/search.hpp"

namespace telltale {

/// An explanation and how probable it is, docs/diagnosis.md (91).
struct RankedFit {
  EffectFit fit;
  double probability = 0.0;
  std::vector<EffectFit> alike;  ///< less probable ones that predict the same

  /// Effects that would do as well in its place.
  std::vector<std::string> Indistinguishable() const;
};

struct Ranking {
  std::vector<RankedFit> fits;  ///< most probable first
  double nothing = 0.0;         ///< probability that all is well
  double unknown = 0.0;         ///< that it is something the library lacks
};

/// What is left once the likeliest explanation is in, as far as windows that did not take part in
/// fitting tell.
struct Remainder {
  double log_before = 0.0;        ///< ln of what a Judge leaves of the errors without it,
  double log_leftover = 0.0;      ///< and with it,
  double healthy_mean = 0.0;      ///< and of healthy recordings
  std::optional<double> closure;  ///< held out; none where there is no gap
};

/// Weighs explanations by their scores, tempered, and against something unknown by what they leave.
/// Those that predict the same, to within kClassDistance, are one class: its likeliest member
/// stands for all and has their probability.
Ranking Rank(const Explanations& explanations, const Judge& judge, const Remainder& remainder);

/// Whether a gap is more than health can be taken for: by size, by what explains it, or by
/// its pattern.
bool IsMaterial(double squared_gap, double squared_limit, double best_score,
                const Remainder& remainder);

Verdict VerdictOf(const Ranking& ranking, const Remainder& remainder, bool material,
                  bool conclusive);

}  // namespace telltale
