#include "telltale/service/models/model_store.hpp"

#include <limits>
#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/idl/codec/json/model.hpp"
#include "telltale/service/storage/checked_serialisation.hpp"
#include "telltale/service/storage/stored_blob.hpp"
#include "telltale/service/storage/stores.hpp"

namespace telltale {
namespace {

constexpr std::int64_t kReadAtATime = 8;  // of some thirty kilobytes each

std::optional<StoredModel> ReadModel(const Row& row, const std::string& database) {
  proto::Model message;
  if (!ReadBlob(row, "model", message)) {
    spdlog::error("{}: revision {} of {} is not a model", database, row.Integer("revision"),
                  row.Text("vehicle_id"));
    return std::nullopt;
  }
  auto identification = IdentificationOf(message, database);
  if (!identification) {
    spdlog::error("{}", identification.error().Message());
    return std::nullopt;
  }
  StoredModel stored;
  stored.model = {std::move(*identification),
                  static_cast<std::uint64_t>(row.Integer("revision")),
                  row.Real("published_unix_s"),
                  {PromotionVerdictNamed(row.Text("verdict")), row.Text("verdict_reason")}};
  if (!row.IsNull("reference_error_u")) {
    stored.reference_error = {row.Real("reference_error_u"), row.Real("reference_error_v"),
                              row.Real("reference_error_r")};
  }
  if (!row.IsNull("rollback_of")) {
    stored.rollback_of = static_cast<std::uint64_t>(row.Integer("rollback_of"));
  }
  return stored;
}

Parameter ErrorOf(const std::optional<FreeRunError>& error, std::size_t channel) {
  return error ? Parameter((*error)[channel]) : std::monostate();
}

Parameter RevisionOrNull(const std::optional<std::uint64_t>& revision) {
  return revision ? Parameter(static_cast<std::int64_t>(*revision)) : std::monostate();
}

}  // namespace

ModelStore::ModelStore(const Storage& storage)
    : storage_(storage), database_(storage.Open(ModelsSchema())) {}

StoredModel ModelStore::Save(const Identification& identification, double published_unix_s,
                             const std::optional<FreeRunError>& reference_error,
                             const Promotion& promotion, std::optional<std::uint64_t> rollback_of) {
  StoredModel stored{
      {identification, 0, published_unix_s, promotion}, reference_error, rollback_of};
  const std::string& vehicle_id = identification.vehicle_id;
  database_->InTransaction([&] {
    const Parameter fence = storage_.RequireLease(*database_, vehicle_id);
    stored.model.revision = static_cast<std::uint64_t>(IntegerOf(
        *database_,
        "SELECT COALESCE(MAX(revision), 0) + 1 AS value FROM models WHERE vehicle_id = $1",
        {vehicle_id}));
    Insert(stored, fence);
  });
  return stored;
}

void ModelStore::Keep(const StoredModel& stored) {
  database_->InTransaction([&] {
    const std::string& vehicle_id = stored.model.identification.vehicle_id;
    const Parameter fence = storage_.RequireLease(*database_, vehicle_id);
    database_->Execute("DELETE FROM models WHERE vehicle_id = $1 AND revision = $2",
                       {vehicle_id, static_cast<std::int64_t>(stored.model.revision)});
    Insert(stored, fence);
  });
}

/// The caller has begun a transaction.
void ModelStore::Insert(const StoredModel& stored, const Parameter& fence) {
  const auto& [identification, published_revision, published_unix_s, promotion] = stored.model;
  const auto revision = static_cast<std::int64_t>(published_revision);
  const proto::Model message = ToProto(identification);
  const std::string blob = SerialiseChecked(message, IdentificationOf(message, "model"));
  const std::string& vehicle_id = identification.vehicle_id;
  const auto& reference_error = stored.reference_error;
  database_->Execute(
      "INSERT INTO models (vehicle_id, revision, published_unix_s, model, checksum,"
      " reference_error_u, reference_error_v, reference_error_r, verdict, verdict_reason, fence,"
      " rollback_of) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12)",
      {vehicle_id, revision, published_unix_s, Blob(blob), std::int64_t{ChecksumOf(blob)},
       ErrorOf(reference_error, 0), ErrorOf(reference_error, 1), ErrorOf(reference_error, 2),
       Name(promotion.verdict), promotion.reason, fence, RevisionOrNull(stored.rollback_of)});
  database_->Execute("DELETE FROM models WHERE vehicle_id = $1 AND revision <= $2",
                     {vehicle_id, revision - static_cast<std::int64_t>(kModelsPerVehicle)});
}

std::vector<std::uint64_t> ModelStore::Revisions(std::string_view vehicle_id) const {
  std::vector<std::uint64_t> revisions;
  database_->Query("SELECT revision FROM models WHERE vehicle_id = $1 ORDER BY revision",
                   {vehicle_id}, [&](const Row& row) {
                     revisions.push_back(static_cast<std::uint64_t>(row.Integer("revision")));
                   });
  return revisions;
}

std::optional<double> ModelStore::PublishedUnixS(std::string_view vehicle_id,
                                                 std::uint64_t revision) const {
  std::optional<double> published_unix_s;
  database_->Query("SELECT published_unix_s FROM models WHERE vehicle_id = $1 AND revision = $2",
                   {vehicle_id, static_cast<std::int64_t>(revision)},
                   [&](const Row& row) { published_unix_s = row.Real("published_unix_s"); });
  return published_unix_s;
}

std::optional<StoredModel> ModelStore::Latest(std::string_view vehicle_id) const {
  return Newest(vehicle_id, [](const StoredModel&) { return true; });
}

std::optional<StoredModel> ModelStore::Newest(
    std::string_view vehicle_id, const std::function<bool(const StoredModel&)>& suits) const {
  std::int64_t before = std::numeric_limits<std::int64_t>::max();
  std::optional<StoredModel> found;
  for (bool more = true; more && !found;) {
    std::int64_t rows = 0;
    database_->Query(
        "SELECT * FROM models WHERE vehicle_id = $1 AND revision < $2"
        " ORDER BY revision DESC LIMIT $3",
        {vehicle_id, before, kReadAtATime}, [&](const Row& row) {
          ++rows;
          before = row.Integer("revision");
          if (found) return;
          if (auto stored = ReadModel(row, database_->name()); stored && suits(*stored)) {
            found = std::move(stored);
          }
        });
    more = rows == kReadAtATime;
  }
  return found;
}

std::vector<StoredModel> ModelStore::History(std::string_view vehicle_id) const {
  std::vector<StoredModel> models;
  Newest(vehicle_id, [&](const StoredModel& stored) {
    models.push_back(stored);
    return false;
  });
  return models;
}

}  // namespace telltale
