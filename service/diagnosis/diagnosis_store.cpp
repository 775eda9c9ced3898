#include "telltale/service/diagnosis/diagnosis_store.hpp"

#include <string>
#include <utility>

#include <SQLiteCpp/SQLiteCpp.h>
#include <spdlog/spdlog.h>

#include "telltale/idl/codec/json/report.hpp"
#include "telltale/service/storage/checked_serialisation.hpp"
#include "telltale/service/storage/database.hpp"

namespace telltale {

DiagnosisStore::DiagnosisStore(const std::filesystem::path& directory)
    : database_(OpenDatabase(directory)) {}

DiagnosisStore::~DiagnosisStore() = default;
DiagnosisStore::DiagnosisStore(DiagnosisStore&&) noexcept = default;
DiagnosisStore& DiagnosisStore::operator=(DiagnosisStore&&) noexcept = default;

void DiagnosisStore::Save(const PublishedDiagnosis& diagnosis) {
  const proto::Report message = ToProto(diagnosis.diagnosis);
  const std::string blob = SerialiseChecked(message, DiagnosisOf(message, "diagnosis"));
  SQLite::Statement insert(*database_, "INSERT OR REPLACE INTO diagnoses VALUES (?, ?, ?, ?)");
  insert.bind(1, diagnosis.diagnosis.vehicle_id);
  insert.bind(2, static_cast<std::int64_t>(diagnosis.model_revision));
  insert.bind(3, diagnosis.published_unix_s);
  insert.bind(4, blob.data(), static_cast<int>(blob.size()));
  insert.exec();
}

std::optional<PublishedDiagnosis> DiagnosisStore::Last(std::string_view vehicle_id) const {
  SQLite::Statement row(*database_, "SELECT * FROM diagnoses WHERE vehicle_id = ?");
  row.bind(1, std::string(vehicle_id));
  if (!row.executeStep()) return std::nullopt;
  proto::Report message;
  const SQLite::Column blob = row.getColumn("report");
  if (!message.ParseFromArray(blob.getBlob(), blob.getBytes())) {
    spdlog::error("models.sqlite: the stored diagnosis of {} is not a diagnosis", vehicle_id);
    return std::nullopt;
  }
  auto diagnosis = DiagnosisOf(message, "models.sqlite");
  if (!diagnosis) {
    spdlog::error("{}", diagnosis.error().Message());
    return std::nullopt;
  }
  return PublishedDiagnosis{std::move(*diagnosis),
                            static_cast<std::uint64_t>(row.getColumn("model_revision").getInt64()),
                            row.getColumn("published_unix_s").getDouble()};
}

}  // namespace telltale
