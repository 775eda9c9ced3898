#include "telltale/service/models/predecessor.hpp"

#include <utility>

namespace telltale {
namespace {

constexpr std::size_t kCoefficientsReported = 5;
constexpr std::size_t kModelsSearched = 200;  // each is some ten kilobytes to read

ModelChange Inconclusive(std::uint64_t revision, std::string reason) {
  ModelChange change;
  change.revision = revision;
  change.verdict = ChangeVerdict::kInconclusive;
  change.reason = std::move(reason);
  return change;
}

}  // namespace

std::optional<ModelChange> ChangeSincePredecessor(const ModelStore& store,
                                                  const Identification& identification) {
  std::size_t seen = 0;
  std::size_t overlapping = 0;
  const auto predecessor = store.Newest(identification.vehicle_id, [&](const StoredModel& stored) {
    if (++seen > kModelsSearched) return true;
    const bool overlaps = WindowsOverlap(stored.model.identification, identification);
    overlapping += overlaps ? 1 : 0;
    return !overlaps && AreComparable(stored.model.identification, identification);
  });
  if (seen == 0) return std::nullopt;
  if (!predecessor || seen > kModelsSearched) {
    return Inconclusive(0, overlapping > 0
                               ? "all earlier models of the same options share data with it"
                               : "no earlier model was made with the same options");
  }
  const std::uint64_t revision = predecessor->model.revision;
  auto change = ChangeBetween(predecessor->model.identification, identification);
  if (!change) return Inconclusive(revision, change.error().reason);
  change->revision = revision;
  if (change->coefficients.size() > kCoefficientsReported)
    change->coefficients.resize(kCoefficientsReported);
  return *std::move(change);
}

}  // namespace telltale
