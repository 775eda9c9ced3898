#include "telltale/service/diagnosis/diagnosis_store.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/idl/codec/json/report.hpp"
#include "telltale/service/storage/checked_serialisation.hpp"
#include "telltale/service/storage/stored_blob.hpp"
#include "telltale/service/storage/stores.hpp"

namespace telltale {
namespace {

std::optional<PublishedDiagnosis> ReadDiagnosis(const Row& row, const std::string& database) {
  proto::Report message;
  if (!ReadBlob(row, "report", message)) {
    spdlog::error("{}: the stored diagnosis of {} is not a diagnosis", database,
                  row.Text("vehicle_id"));
    return std::nullopt;
  }
  auto diagnosis = DiagnosisOf(message, database);
  if (!diagnosis) {
    spdlog::error("{}", diagnosis.error().Message());
    return std::nullopt;
  }
  return PublishedDiagnosis{std::move(*diagnosis),
                            static_cast<std::uint64_t>(row.Integer("model_revision")),
                            row.Real("published_unix_s")};
}

std::string BlobOf(const PublishedDiagnosis& diagnosis) {
  const proto::Report message = ToProto(diagnosis.diagnosis);
  return SerialiseChecked(message, DiagnosisOf(message, "diagnosis"));
}

}  // namespace

DiagnosisStore::DiagnosisStore(const Storage& storage)
    : storage_(storage), database_(storage.Open(ModelsSchema())) {}

void DiagnosisStore::Save(const PublishedDiagnosis& diagnosis) {
  const std::string blob = BlobOf(diagnosis);
  const std::string& vehicle_id = diagnosis.diagnosis.vehicle_id;
  database_->InTransaction([&] {
    const Parameter fence = storage_.RequireLease(*database_, vehicle_id);
    KeepLastAsEarlier(vehicle_id, diagnosis.published_unix_s);
    database_->Execute(
        "INSERT INTO diagnoses"
        " (vehicle_id, model_revision, published_unix_s, report, checksum, fence)"
        " VALUES ($1, $2, $3, $4, $5, $6)"
        " ON CONFLICT (vehicle_id) DO UPDATE SET model_revision = excluded.model_revision,"
        " published_unix_s = excluded.published_unix_s, report = excluded.report,"
        " checksum = excluded.checksum, fence = excluded.fence",
        {vehicle_id, static_cast<std::int64_t>(diagnosis.model_revision),
         diagnosis.published_unix_s, Blob(blob), std::int64_t{ChecksumOf(blob)}, fence});
  });
}

bool DiagnosisStore::SaveEarlier(const PublishedDiagnosis& diagnosis) {
  const std::string& vehicle_id = diagnosis.diagnosis.vehicle_id;
  const std::vector<double> known = PublicationTimes(vehicle_id);
  if (std::ranges::find(known, diagnosis.published_unix_s) != known.end()) return false;
  if (known.empty() || diagnosis.published_unix_s > known.front()) {
    Save(diagnosis);
    return true;
  }
  const std::string blob = BlobOf(diagnosis);
  database_->InTransaction([&] {
    const Parameter fence = storage_.RequireLease(*database_, vehicle_id);
    database_->Execute(
        "INSERT INTO earlier_diagnoses"
        " (vehicle_id, model_revision, published_unix_s, report, checksum, fence)"
        " VALUES ($1, $2, $3, $4, $5, $6)"
        " ON CONFLICT (vehicle_id, published_unix_s) DO NOTHING",
        {vehicle_id, static_cast<std::int64_t>(diagnosis.model_revision),
         diagnosis.published_unix_s, Blob(blob), std::int64_t{ChecksumOf(blob)}, fence});
    DropOldest(vehicle_id);
  });
  return true;
}

/// The caller has begun a transaction.
void DiagnosisStore::KeepLastAsEarlier(std::string_view vehicle_id, double next_published_unix_s) {
  const std::string columns =
      "vehicle_id, model_revision, published_unix_s, report, checksum, fence";
  database_->Execute("INSERT INTO earlier_diagnoses (" + columns + ") SELECT " + columns +
                         " FROM diagnoses WHERE vehicle_id = $1 AND published_unix_s <> $2"
                         " ON CONFLICT (vehicle_id, published_unix_s) DO NOTHING",
                     {vehicle_id, next_published_unix_s});
  DropOldest(vehicle_id);
}

void DiagnosisStore::DropOldest(std::string_view vehicle_id) {
  database_->Execute(
      "DELETE FROM earlier_diagnoses WHERE vehicle_id = $1 AND published_unix_s NOT IN"
      " (SELECT published_unix_s FROM earlier_diagnoses WHERE vehicle_id = $1"
      " ORDER BY published_unix_s DESC LIMIT $2)",
      {vehicle_id, static_cast<std::int64_t>(kDiagnosesPerVehicle) - 1});
}

/// Newest first.
std::vector<double> DiagnosisStore::PublicationTimes(std::string_view vehicle_id) const {
  std::vector<double> times;
  database_->Query(
      "SELECT published_unix_s FROM diagnoses WHERE vehicle_id = $1 UNION"
      " SELECT published_unix_s FROM earlier_diagnoses WHERE vehicle_id = $1"
      " ORDER BY published_unix_s DESC",
      {vehicle_id}, [&](const Row& row) { times.push_back(row.Real("published_unix_s")); });
  return times;
}

std::optional<PublishedDiagnosis> DiagnosisStore::Last(std::string_view vehicle_id) const {
  std::optional<PublishedDiagnosis> last;
  database_->Query("SELECT * FROM diagnoses WHERE vehicle_id = $1", {vehicle_id},
                   [&](const Row& row) { last = ReadDiagnosis(row, database_->name()); });
  return last;
}

std::vector<PublishedDiagnosis> DiagnosisStore::History(std::string_view vehicle_id) const {
  const std::string columns = "vehicle_id, model_revision, published_unix_s, report, checksum";
  std::vector<PublishedDiagnosis> diagnoses;
  database_->Query("SELECT " + columns + " FROM diagnoses WHERE vehicle_id = $1 UNION ALL SELECT " +
                       columns +
                       " FROM earlier_diagnoses WHERE vehicle_id = $1"
                       " ORDER BY published_unix_s DESC",
                   {vehicle_id}, [&](const Row& row) {
                     if (auto read = ReadDiagnosis(row, database_->name())) {
                       diagnoses.push_back(std::move(*read));
                     }
                   });
  return diagnoses;
}

}  // namespace telltale
