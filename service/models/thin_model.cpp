#include "telltale/service/models/thin_model.hpp"

#include <algorithm>
#include <string>

namespace telltale {

Promotion WarnIfThin(Promotion promotion, const Identification& identification, double window_fill,
                     const PublishedModel& sound) {
  constexpr double kThinShare = 1.0 / 3.0;
  constexpr double kFilled = 0.5;
  const std::size_t rows = identification.window.samples;
  const std::size_t sound_rows = sound.identification.window.samples;
  const bool thin = static_cast<double>(rows) < kThinShare * static_cast<double>(sound_rows);
  if (!thin || window_fill >= kFilled) return promotion;
  promotion.verdict = std::max(promotion.verdict, PromotionVerdict::kWarn);
  promotion.reason += std::string(promotion.reason.empty() ? "" : "; ") + "it rests on " +
                      std::to_string(rows) + " rows of data, revision " +
                      std::to_string(sound.revision) + " on " + std::to_string(sound_rows);
  return promotion;
}

}  // namespace telltale
