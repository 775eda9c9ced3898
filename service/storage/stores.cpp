#include "telltale/service/storage/stores.hpp"

namespace telltale {
namespace {

using enum ColumnType;

// CRC-32 of the blob of the row; none from programs that made none.
const Column kChecksum{"checksum", kInteger, ""};

// Of the lease under which the row was written; none where a daemon has the fleet alone.
const Column kFence{"fence", kInteger, ""};

std::vector<Column> DiagnosisColumns() {
  return {{"vehicle_id", kText, "NOT NULL"},
          {"model_revision", kInteger, "NOT NULL"},
          {"published_unix_s", kReal, "NOT NULL"},
          {"report", kBlob, "NOT NULL"},  // proto/report.proto, serialised
          kChecksum,
          kFence};
}

}  // namespace

const Schema& ModelsSchema() {
  static const Schema schema{
      .name = "models",
      .tables = {{"models",
                  {{"vehicle_id", kText, "NOT NULL"},
                   {"revision", kInteger, "NOT NULL"},
                   {"published_unix_s", kReal, "NOT NULL"},
                   {"model", kBlob, "NOT NULL"},  // proto/model.proto, serialised
                   {"reference_error_u", kReal, ""},
                   {"reference_error_v", kReal, ""},
                   {"reference_error_r", kReal, ""},
                   {"verdict", kText, "NOT NULL DEFAULT 'UNKNOWN'"},
                   {"verdict_reason", kText, "NOT NULL DEFAULT ''"},
                   kChecksum,
                   kFence,
                   {"rollback_of", kInteger, ""}},  // the revision that it publishes again
                  {"vehicle_id", "revision"}},
                 {"diagnoses", DiagnosisColumns(), {"vehicle_id"}},
                 {"earlier_diagnoses", DiagnosisColumns(), {"vehicle_id", "published_unix_s"}}},
      .version = 4,
      .oldest_version = 2,
  };
  return schema;
}

const Schema& WindowsSchema() {
  static const Schema schema{
      .name = "windows",
      .tables = {{"chunks",
                  {{"vehicle_id", kText, "NOT NULL"},
                   {"number", kInteger, "NOT NULL"},
                   {"last_s", kReal, "NOT NULL"},
                   {"samples", kBlob, "NOT NULL"},  // PackChunk(), with its checksum
                   {"saved_unix_s", kReal, ""}},    // none from programs that knew no retention
                  {"vehicle_id", "number"}}},
  };
  return schema;
}

const Schema& RequestsSchema() {
  static const Schema schema{
      .name = "requests",
      .tables = {{"requests",
                  {{"number", kCounter, ""},
                   {"correlation_id", kText, "NOT NULL UNIQUE"},
                   {"request", kBlob, "NOT NULL"},  // proto/stored_request.proto, serialised
                   kChecksum,
                   {"slice", kInteger, ""},                        // of its boat
                   {"attempts", kInteger, "NOT NULL DEFAULT 0"}},  // to answer it after a restart
                  {}}},
  };
  return schema;
}

const Schema& VehiclesSchema() {
  static const Schema schema{
      .name = "vehicles",
      .tables = {{"announced_vehicles",
                  {{"vehicle_id", kText, "NOT NULL"},
                   {"vehicle", kBlob, "NOT NULL"},  // proto/vehicle.proto, serialised
                   kChecksum},
                  {"vehicle_id"}}},
  };
  return schema;
}

const Schema& TermsSchema() {
  static const Schema schema{
      .name = "terms",
      .tables = {{"terms", {{"term", kInteger, "NOT NULL"}}, {"term"}}},
  };
  return schema;
}

const Schema& SlicesSchema() {
  static const Schema schema{
      .name = "slices",
      .tables = {{"slices",
                  {{"slice", kInteger, "NOT NULL"},
                   kFence,  // of its newest lease
                   {"owner", kText, "NOT NULL"},
                   {"until_unix_s", kReal, "NOT NULL"}},
                  {"slice"}},
                 {"leases",  // all there have been
                  {{"slice", kInteger, "NOT NULL"},
                   {"fence", kInteger, "NOT NULL"},
                   {"owner", kText, "NOT NULL"},
                   {"since_unix_s", kReal, "NOT NULL"},
                   {"until_unix_s", kReal, "NOT NULL"}},
                  {"slice", "fence"}},
                 {"daemons",
                  {{"owner", kText, "NOT NULL"}, {"until_unix_s", kReal, "NOT NULL"}},
                  {"owner"}}},
  };
  return schema;
}

const Schema& JobsSchema() {
  static const Schema schema{
      .name = "jobs",
      .tables = {{"jobs",
                  {{"number", kCounter, ""},
                   {"correlation_id", kText, "NOT NULL UNIQUE"},
                   {"vehicle_id", kText, "NOT NULL"},
                   {"version", kText, "NOT NULL"},              // of the daemon
                   {"wanted_until_unix_s", kReal, "NOT NULL"},  // by the daemon
                   {"task", kBlob, "NOT NULL"},                 // PackTask(), with its checksum
                   {"attempts", kInteger, "NOT NULL DEFAULT 0"},
                   {"worker", kText, "NOT NULL DEFAULT ''"},
                   {"taken_until_unix_s", kReal, "NOT NULL DEFAULT 0"},  // by the worker
                   {"stage", kText, "NOT NULL DEFAULT ''"},
                   {"fraction", kReal, "NOT NULL DEFAULT 0"},
                   {"outcome", kBlob, ""}},  // PackOutcome(), with its checksum
                  {}},
                 {"workers",
                  {{"worker", kText, "NOT NULL"},
                   {"version", kText, "NOT NULL"},
                   {"until_unix_s", kReal, "NOT NULL"}},
                  {"worker"}}},
  };
  return schema;
}

}  // namespace telltale
