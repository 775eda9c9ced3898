#include "telltale/client/report/pictures.hpp"

namespace telltale {
namespace {

Markup LegendEntry(std::string_view style, std::string_view text) {
  return Styled("span", "key", Styled("i", style, {}) + Words(text));
}

std::string_view BeforeText(bool after, bool measured) {
  if (!after) return measured ? "predicted" : "this recording";
  return measured ? "predicted before" : "before";
}

}  // namespace

bool HasAfter(const Diagnosis& diagnosis) {
  const GapSize& gap = diagnosis.Main().all;
  return gap.after != gap.before;
}

Markup Legend(const Diagnosis& diagnosis, bool measured) {
  Markup entries;
  if (measured) entries += LegendEntry("swatch measured", "as measured");
  entries += LegendEntry("swatch before", BeforeText(HasAfter(diagnosis), measured));
  if (HasAfter(diagnosis)) {
    entries += LegendEntry("swatch after", measured ? "predicted after" : "after");
  }
  if (!measured) entries += LegendEntry("swatch floor", "nominal: 95 % stay inside");
  return Styled("p", "legend", entries);
}

Markup Nothing(std::string_view why) {
  return Styled("p", "nothing", Words(why));
}

}  // namespace telltale
