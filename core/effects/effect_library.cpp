#include "telltale/core/effects/effect_library.hpp"

#include <algorithm>

namespace telltale {

std::span<const Effect* const> EffectLibrary() {
#define TELLTALE_LIST(Name) &Name(),
  static const std::vector<const Effect*> library = {TELLTALE_EFFECTS(TELLTALE_LIST)};
#undef TELLTALE_LIST
  return library;
}

const Effect* FindEffect(std::string_view name) {
  const auto library = EffectLibrary();
  const auto found = std::find_if(library.begin(), library.end(),
                                  [&](const Effect* effect) { return effect->Name() == name; });
  return found == library.end() ? nullptr : *found;
}

}  // namespace telltale
