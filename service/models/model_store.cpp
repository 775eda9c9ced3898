#include "telltale/service/models/model_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <spdlog/spdlog.h>
#include <boost/crc.hpp>

#include "telltale/idl/codec/json/model.hpp"
#include "telltale/service/storage/checked_serialisation.hpp"
#include "telltale/service/storage/database.hpp"

namespace telltale {
namespace {

std::int64_t Checksum(const void* bytes, int size) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes, static_cast<std::size_t>(size));
  return crc.checksum();
}

PromotionVerdict VerdictNamed(std::string_view name) {
  for (const auto verdict :
       {PromotionVerdict::kOk, PromotionVerdict::kWarn, PromotionVerdict::kError}) {
    if (Name(verdict) == name) return verdict;
  }
  return PromotionVerdict::kUnknown;
}

std::optional<StoredModel> ReadRow(SQLite::Statement& row) {
  proto::Model message;
  const SQLite::Column blob = row.getColumn("model");
  const SQLite::Column checksum = row.getColumn("checksum");
  const bool changed =
      !checksum.isNull() && checksum.getInt64() != Checksum(blob.getBlob(), blob.getBytes());
  if (changed || !message.ParseFromArray(blob.getBlob(), blob.getBytes())) {
    spdlog::error("models.sqlite: revision {} of {} is not a model",
                  row.getColumn("revision").getInt64(), row.getColumn("vehicle_id").getString());
    return std::nullopt;
  }
  auto identification = IdentificationOf(message, "models.sqlite");
  if (!identification) {
    spdlog::error("{}", identification.error().Message());
    return std::nullopt;
  }
  StoredModel stored;
  stored.model = {std::move(*identification),
                  static_cast<std::uint64_t>(row.getColumn("revision").getInt64()),
                  row.getColumn("published_unix_s").getDouble(),
                  {VerdictNamed(row.getColumn("verdict").getString()),
                   row.getColumn("verdict_reason").getString()}};
  if (!row.getColumn("reference_error_u").isNull()) {
    stored.reference_error = {row.getColumn("reference_error_u").getDouble(),
                              row.getColumn("reference_error_v").getDouble(),
                              row.getColumn("reference_error_r").getDouble()};
  }
  return stored;
}

}  // namespace

ModelStore::ModelStore(const std::filesystem::path& directory)
    : database_(OpenDatabase(directory)) {}

ModelStore::~ModelStore() = default;
ModelStore::ModelStore(ModelStore&&) noexcept = default;
ModelStore& ModelStore::operator=(ModelStore&&) noexcept = default;

StoredModel ModelStore::Save(const Identification& identification, double published_unix_s,
                             const std::optional<FreeRunError>& reference_error,
                             const Promotion& promotion) {
  SQLite::Transaction transaction(*database_, SQLite::TransactionBehavior::IMMEDIATE);
  SQLite::Statement next(*database_,
                         "SELECT COALESCE(MAX(revision), 0) + 1 FROM models WHERE vehicle_id = ?");
  next.bind(1, identification.vehicle_id);
  next.executeStep();
  const std::int64_t revision = next.getColumn(0).getInt64();
  next.reset();  // a statement under way keeps the log from being checkpointed
  StoredModel stored{
      {identification, static_cast<std::uint64_t>(revision), published_unix_s, promotion},
      reference_error};
  Insert(stored);
  transaction.commit();
  return stored;
}

void ModelStore::Keep(const StoredModel& stored) {
  SQLite::Transaction transaction(*database_, SQLite::TransactionBehavior::IMMEDIATE);
  Insert(stored);
  transaction.commit();
}

/// The caller has begun a transaction.
void ModelStore::Insert(const StoredModel& stored) {
  const Identification& identification = stored.model.identification;
  const auto revision = static_cast<std::int64_t>(stored.model.revision);
  const proto::Model message = ToProto(identification);
  const std::string blob = SerialiseChecked(message, IdentificationOf(message, "model"));
  SQLite::Statement insert(
      *database_,
      "INSERT OR REPLACE INTO models (vehicle_id, revision, published_unix_s, model, checksum,"
      " reference_error_u, reference_error_v, reference_error_r, verdict, verdict_reason)"
      " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, identification.vehicle_id);
  insert.bind(2, revision);
  insert.bind(3, stored.model.published_unix_s);
  insert.bind(4, blob.data(), static_cast<int>(blob.size()));
  insert.bind(5, Checksum(blob.data(), static_cast<int>(blob.size())));
  if (stored.reference_error) {
    for (int i = 0; i < 3; ++i) insert.bind(6 + i, (*stored.reference_error)[i]);
  }
  insert.bind(9, std::string(Name(stored.model.promotion.verdict)));
  insert.bind(10, stored.model.promotion.reason);
  insert.exec();
  DropOldest(identification.vehicle_id, revision);
}

void ModelStore::DropOldest(const std::string& vehicle_id, std::int64_t newest) {
  SQLite::Statement drop(*database_, "DELETE FROM models WHERE vehicle_id = ? AND revision <= ?");
  drop.bind(1, vehicle_id);
  drop.bind(2, newest - static_cast<std::int64_t>(kModelsPerVehicle));
  drop.exec();
}

std::vector<std::uint64_t> ModelStore::Revisions(std::string_view vehicle_id) const {
  SQLite::Statement rows(*database_,
                         "SELECT revision FROM models WHERE vehicle_id = ? ORDER BY revision");
  rows.bind(1, std::string(vehicle_id));
  std::vector<std::uint64_t> revisions;
  while (rows.executeStep()) {
    revisions.push_back(static_cast<std::uint64_t>(rows.getColumn(0).getInt64()));
  }
  return revisions;
}

std::optional<StoredModel> ModelStore::Latest(std::string_view vehicle_id) const {
  return Newest(vehicle_id, [](const StoredModel&) { return true; });
}

std::optional<StoredModel> ModelStore::Newest(
    std::string_view vehicle_id, const std::function<bool(const StoredModel&)>& suits) const {
  SQLite::Statement rows(*database_,
                         "SELECT * FROM models WHERE vehicle_id = ? ORDER BY revision DESC");
  rows.bind(1, std::string(vehicle_id));
  while (rows.executeStep()) {
    if (auto stored = ReadRow(rows); stored && suits(*stored)) return stored;
  }
  return std::nullopt;
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
