#include "telltale/client/cli/promotion_text.hpp"

#include "telltale/client/cli/table.hpp"

namespace telltale {

std::string PromotionText(const Promotion& promotion) {
  if (promotion.verdict == PromotionVerdict::kUnknown) return "";
  return Wrapped("verdict " + std::string(Name(promotion.verdict)) +
                 (promotion.reason.empty() ? "" : ": " + promotion.reason));
}

}  // namespace telltale
