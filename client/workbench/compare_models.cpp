#include "telltale/client/workbench/compare_models.hpp"

#include "telltale/client/workbench/errors.hpp"
#include "telltale/core/identification/model_comparison.hpp"

namespace telltale {

ModelChange CompareModels(const Identification& earlier, const Identification& later,
                          const NoteSink& note) {
  if (earlier.vehicle_id != later.vehicle_id) {
    note("the models are of " + earlier.vehicle_id + " and of " + later.vehicle_id);
  }
  if (WindowsOverlap(earlier, later)) {
    note(
        "by their clocks the windows of the two overlap; if they share data the "
        "test does not hold");
  }
  return OrThrow(ChangeBetween(earlier, later));
}

}  // namespace telltale
