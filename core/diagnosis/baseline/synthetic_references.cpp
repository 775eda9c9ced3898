#include "telltale/core/diagnosis/baseline/synthetic_references.hpp"

#include <utility>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/simulation/synthetic_dataset.hpp"

namespace telltale {

std::vector<PreparedDataset> SyntheticReferences(const PreparedDataset& recording,
                                                 const VesselModel& model, std::uint64_t seed) {
  std::vector<PreparedDataset> references;
  for (std::size_t i = 0; i < kDiagnosis.recording.synthetic_references; ++i) {
    SyntheticDatasetOptions options;
    options.seed = seed + i;
    if (auto synthetic = SimulateDataset(recording, model, options))
      references.push_back(*std::move(synthetic));
  }
  return references;
}

}  // namespace telltale
