#include "telltale/service/retention/store_retention.hpp"

#include <algorithm>
#include <set>

#include "telltale/service/storage/stores.hpp"

namespace telltale {
namespace {

// Some two megabytes of models: others that write wait no longer than for those.
constexpr std::size_t kRowsTogether = 64;
constexpr std::size_t kCandidatesAtATime = 1024;

/// Of a row m of the models. A model that cannot be read counts as one that can.
constexpr const char* kIsNeitherNewestNorGoodToRollBackTo =
    "m.revision < (SELECT MAX(n.revision) FROM models AS n WHERE n.vehicle_id = m.vehicle_id)"
    " AND m.revision <> COALESCE((SELECT n.rollback_of FROM models AS n"
    " WHERE n.vehicle_id = m.vehicle_id ORDER BY n.revision DESC LIMIT 1), 0)"
    " AND m.revision <> COALESCE((SELECT MAX(s.revision) FROM models AS s"
    " WHERE s.vehicle_id = m.vehicle_id AND s.verdict IN ('OK', 'UNKNOWN') AND s.revision <"
    " (SELECT MAX(n.revision) FROM models AS n WHERE n.vehicle_id = m.vehicle_id)), 0)";

constexpr const char* kIsBeyondTheNewest =
    "(m.vehicle_id, m.revision) IN (SELECT vehicle_id, revision FROM"
    " (SELECT vehicle_id, revision, ROW_NUMBER() OVER"
    " (PARTITION BY vehicle_id ORDER BY revision DESC) AS place FROM models) AS ranked"
    " WHERE place > $1)";

}  // namespace

std::string_view Name(RemovedKind kind) {
  switch (kind) {
    case RemovedKind::kEarlierModel: return "model";
    case RemovedKind::kEarlierDiagnosis: return "diagnosis";
    case RemovedKind::kWindowChunk: return "window_chunk";
  }
  return "";
}

std::string_view Name(RemovalReason reason) {
  switch (reason) {
    case RemovalReason::kCount: return "count";
    case RemovalReason::kAge: return "age";
    case RemovalReason::kSize: return "size";
  }
  return "";
}

std::int64_t RetentionPass::UsedBytes() const {
  std::int64_t sum = 0;
  for (const auto& [store, bytes] : used_bytes) sum += bytes;
  return sum;
}

StoreRetention::StoreRetention(const Storage& storage, const RetentionSettings& settings,
                               IsInFleet is_in_fleet)
    : storage_(storage),
      settings_(settings),
      is_in_fleet_(std::move(is_in_fleet)),
      models_(storage.Open(ModelsSchema())),
      windows_(storage.Open(WindowsSchema())),
      requests_(storage.Open(RequestsSchema())) {}

RetentionPass StoreRetention::Apply(double now_unix_s) {
  RetentionPass pass;
  RemoveAll(Models(), RemovalReason::kCount, kIsBeyondTheNewest,
            {std::int64_t{settings_.models_per_vehicle}}, pass);
  RemoveOlder(Models(), settings_.model_age_s, now_unix_s, pass);
  RemoveOlder(Diagnoses(), settings_.diagnosis_age_s, now_unix_s, pass);
  RemoveOlder(Windows(), settings_.window_age_s, now_unix_s, pass);
  RemoveBeyondSize(pass);
  GiveBackSpace();
  return pass;
}

StoreRetention::Target StoreRetention::Models() const {
  return {RemovedKind::kEarlierModel,         *models_, "models", "revision", "published_unix_s",
          kIsNeitherNewestNorGoodToRollBackTo};
}

StoreRetention::Target StoreRetention::Diagnoses() const {
  return {RemovedKind::kEarlierDiagnosis,
          *models_,
          "earlier_diagnoses",
          "published_unix_s",
          "published_unix_s",
          "TRUE"};
}

StoreRetention::Target StoreRetention::Windows() const {
  return {RemovedKind::kWindowChunk, *windows_, "chunks", "number", "saved_unix_s", "TRUE"};
}

/// The oldest that meet the condition, of the vehicles that this daemon may remove of.
StoreRetention::Candidates StoreRetention::Find(const Target& target, const std::string& condition,
                                                const Parameters& parameters) const {
  Candidates found;
  const std::string place = "m." + target.place;
  target.database.Query("SELECT m.vehicle_id AS vehicle_id, " + place + " AS place FROM " +
                            target.table + " AS m WHERE " + condition + " AND " + target.may_go +
                            " ORDER BY m." + target.time + ", m.vehicle_id, " + place,
                        parameters, [&](const Row& row) {
                          if (found.size() == kCandidatesAtATime) return;
                          Candidate candidate{row.Text("vehicle_id"), {}};
                          const HeldSlices* held = storage_.held();
                          if (held != nullptr && !held->FenceOf(candidate.vehicle_id)) return;
                          if (target.kind == RemovedKind::kEarlierDiagnosis) {
                            candidate.place = row.Real("place");
                          } else {
                            candidate.place = row.Integer("place");
                          }
                          found.push_back(std::move(candidate));
                        });
  return found;
}

StoreRetention::Candidates StoreRetention::FindOfFormerVehicles(const Target& target) const {
  std::vector<std::string> former;
  target.database.Query("SELECT DISTINCT vehicle_id FROM " + target.table, {}, [&](const Row& row) {
    std::string vehicle_id = row.Text("vehicle_id");
    if (!is_in_fleet_(vehicle_id)) former.push_back(std::move(vehicle_id));
  });
  Candidates found;
  for (const std::string& vehicle_id : former) {
    std::ranges::move(Find(target, "m.vehicle_id = $1", {vehicle_id}), std::back_inserter(found));
  }
  return found;
}

/// In one transaction. What has become the model of a rollback in the meantime stays.
std::size_t StoreRetention::Remove(const Target& target, std::span<const Candidate> candidates) {
  std::set<int> slices;
  for (const Candidate& candidate : candidates) slices.insert(SliceOf(candidate.vehicle_id));
  const std::string statement = "DELETE FROM " + target.table +
                                " AS m WHERE m.vehicle_id = $1 AND m." + target.place +
                                " = $2 AND " + target.may_go;
  std::size_t removed = 0;
  target.database.InTransaction([&] {
    const std::set<int> held = storage_.LockLeases(target.database, slices);
    for (const auto& [vehicle_id, place] : candidates) {
      if (!held.contains(SliceOf(vehicle_id))) continue;
      const auto value = std::visit([](auto number) { return Parameter(number); }, place);
      removed += target.database.Execute(statement, {vehicle_id, value});
    }
  });
  return removed;
}

void StoreRetention::RemoveAll(const Target& target, RemovalReason reason,
                               const std::string& condition, const Parameters& parameters,
                               RetentionPass& pass) {
  std::size_t removed = 0;
  do {
    removed = 0;
    const Candidates found = Find(target, condition, parameters);
    for (std::span rest(found); !rest.empty();) {
      const std::size_t together = std::min(rest.size(), kRowsTogether);
      removed += Remove(target, rest.first(together));
      rest = rest.subspan(together);
    }
    if (removed > 0) pass.removed[{target.kind, reason}] += removed;
  } while (removed > 0);
}

void StoreRetention::RemoveOlder(const Target& target, double age_s, double now_unix_s,
                                 RetentionPass& pass) {
  if (age_s <= 0.0) return;
  RemoveAll(target, RemovalReason::kAge, "m." + target.time + " < $1", {now_unix_s - age_s}, pass);
}

void StoreRetention::RemoveBeyondSize(RetentionPass& pass) {
  Measure(pass);
  if (Fits(pass)) return;
  RemoveUntilItFits(Windows(), FindOfFormerVehicles(Windows()), pass);
  for (const Target& target : {Diagnoses(), Models()}) {
    while (!Fits(pass) && RemoveUntilItFits(target, Find(target, "TRUE", {}), pass) > 0) {
    }
  }
  pass.over_limit = !Fits(pass);
}

/// Returns how many of the candidates have gone: fewer than there were where what is left fits, or
/// where another daemon holds their leases by now.
std::size_t StoreRetention::RemoveUntilItFits(const Target& target, const Candidates& candidates,
                                              RetentionPass& pass) {
  std::size_t removed = 0;
  for (std::span rest(candidates); !rest.empty() && !Fits(pass);) {
    const std::size_t together = std::min(rest.size(), kRowsTogether);
    removed += Remove(target, rest.first(together));
    rest = rest.subspan(together);
    Measure(pass);
  }
  if (removed > 0) pass.removed[{target.kind, RemovalReason::kSize}] += removed;
  return removed;
}

bool StoreRetention::Fits(const RetentionPass& pass) const {
  return settings_.store_bytes == 0 ||
         pass.UsedBytes() <= static_cast<std::int64_t>(settings_.store_bytes);
}

void StoreRetention::GiveBackSpace() {
  for (Database* database : {models_.get(), windows_.get(), requests_.get()}) {
    while (database->GiveBackSpace()) {
    }
  }
}

void StoreRetention::Measure(RetentionPass& pass) const {
  pass.used_bytes = {{"models", models_->UsedBytes()},
                     {"windows", windows_->UsedBytes()},
                     {"requests", requests_->UsedBytes()}};
}

}  // namespace telltale
