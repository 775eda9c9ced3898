#include "telltale/core/identification/progress.hpp"

namespace telltale {

Progress ProgressWithin(const Progress& progress, double from, double to) {
  if (!progress) return {};
  return [&progress, from, to](std::string_view stage, double fraction) {
    progress(stage, from + (to - from) * fraction);
  };
}

}  // namespace telltale
