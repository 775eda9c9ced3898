#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <utility>

#include "bus_type.hpp"
#include "support/made_up_diagnoses.hpp"
#include "support/made_up_identifications.hpp"
#include "telltale/core/base/result.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/idl/codec/json/metrics.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/json/report.hpp"
#include "telltale/idl/codec/stored_request.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"
#include "telltale/idl/codec/wire/daemon_status.hpp"
#include "telltale/idl/codec/wire/diagnosis.hpp"
#include "telltale/idl/codec/wire/exchange.hpp"
#include "telltale/idl/codec/wire/fleet_exchange.hpp"
#include "telltale/idl/codec/wire/model.hpp"
#include "telltale/idl/codec/wire/quality.hpp"
#include "telltale/idl/codec/wire/telemetry.hpp"
#include "telltale/idl/codec/wire/vehicle_announcement.hpp"
#include "telltale/service/storage/packed_blob.hpp"
#include "telltale/service/windows/window_chunk.hpp"
#include "telltale/service/workers/heavy_job_codec.hpp"

namespace telltale {
namespace {

/// The seeds of one fuzzer, each after the byte that says what it is.
class Seeds {
 public:
  explicit Seeds(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::filesystem::create_directories(folder_);
  }

  void Save(int kind, const std::string& bytes) {
    std::ofstream file(folder_ / std::to_string(count_++), std::ios::binary);
    file << static_cast<char>(kind) << bytes;
  }

  template <class Wire>
  void SaveSample(int kind, const WireSample<Wire>& sample) {
    Save(kind, BusType<Wire>::Instance().Write(*sample));
  }

  template <class Wire>
  void SaveStruct(int kind, const Wire& sample) {
    Save(kind, BusType<Wire>::Instance().Write(sample));
  }

 private:
  const std::filesystem::path folder_;
  int count_ = 0;
};

Vehicle SomeVehicle() {
  Vehicle vehicle;
  vehicle.vehicle_id = "made-up.1";
  vehicle.propeller_separation_m = 0.57;
  vehicle.port = {1500.0, 1900.0, 1100.0};
  vehicle.starboard = {1500.0, 1100.0, 1900.0};
  return vehicle;
}

Recording SomeRecording() {
  Recording recording;
  recording.gnss = {{100.0, 54.1, 10.2}, {100.2, 54.25, 10.3}};
  recording.heading = {{100.1, 359.5}};
  recording.thrusters = {{100.3, 1500.0, 1625.5}};
  recording.starts_s = {100.0};
  return recording;
}

template <class Message>
Message Named(Message message) {
  message.correlation_id = "one";
  if constexpr (requires { message.vehicle_id; }) message.vehicle_id = "made-up.1";
  return message;
}

IdentifyRequest SomeIdentifyRequest() {
  auto request = Named(IdentifyRequest());
  request.structure = Structure::kStaticQuadratic;
  request.estimator = Estimator::kWeakIv;
  request.bootstrap_replicates = 100;
  request.coverage_check_replicates = 10;
  return request;
}

DiagnoseRequest SomeDiagnoseRequest() {
  auto request = Named(DiagnoseRequest());
  request.without = {"wind", "current"};
  return request;
}

FleetRequest SomeRefresh() {
  auto request = Named(FleetRequest());
  request.command = FleetCommand::kRefresh;
  request.vehicle_ids = {"boat-1", "boat-2"};
  return request;
}

IdentifyReply SomeIdentifyReply() {
  auto reply = Named(IdentifyReply());
  reply.outcome = ReplyOutcome::kPublished;
  reply.model = PublishedModel{MadeUpIdentification(), 3, 1.7e9, {PromotionVerdict::kOk, ""}};
  return reply;
}

DiagnoseReply SomeDiagnoseReply() {
  auto reply = Named(DiagnoseReply());
  reply.outcome = ReplyOutcome::kPublished;
  reply.diagnosis = PublishedDiagnosis{MadeUpDiagnosis(), 3, 1.7e9};
  reply.augmented = MadeUpIdentification();
  return reply;
}

FleetReply SomeFleetReply() {
  auto reply = Named(FleetReply());
  reply.outcome = ReplyOutcome::kAnswered;
  reply.vehicles.emplace_back().vehicle_id = "boat-1";
  return reply;
}

Quality SomeQuality() {
  Quality quality;
  quality.vehicle_id = "made-up.1";
  quality.reasons.push_back({"SILENT", QualityVerdict::kWarn, "for a minute"});
  return quality;
}

/// The numbers are those by which the fuzzers choose.
void SaveCodec(Seeds seeds) {
  const PublishedModel model{MadeUpIdentification(), 3, 1.7e9, {PromotionVerdict::kOk, ""}};
  for (const Identification& made :
       {MadeUpIdentification(), MadeUpDynamicIdentification(), MadeUpPhysicalIdentification()}) {
    seeds.Save(0, PrintModelJson(made));
    seeds.Save(2, ToProto(made).SerializeAsString());
  }
  seeds.Save(1, PrintReportJson(MadeUpDiagnosis()));
  seeds.Save(3, ToProto(MadeUpDiagnosis()).SerializeAsString());
  seeds.Save(4, PrintMetricsJson(Metrics()));
  seeds.SaveSample(5, Encode(model));
  seeds.SaveSample(6, Encode(PublishedDiagnosis{MadeUpDiagnosis(), 3, 1.7e9}));
  seeds.SaveSample(7, Encode(SomeQuality()));
  seeds.SaveSample(8, Encode(SomeIdentifyReply()));
  seeds.SaveSample(9, Encode(Named(IdentifyProgress())));
  seeds.SaveSample(10, Encode(SomeDiagnoseReply()));
  seeds.SaveSample(11, Encode(Named(DiagnoseProgress())));
  seeds.SaveSample(12, Encode(SomeFleetReply()));
  seeds.SaveSample(13, Encode(Named(FleetProgress())));
  DaemonStatus status;
  status.daemon_id = "one";
  seeds.SaveStruct(14, Encode(status));
  seeds.SaveStruct(15, Encode(Telemetry<GnssFix>{"made-up.1", 1, {100.0, 54.1, 10.2}}));
  seeds.SaveStruct(16, Encode(Telemetry<HeadingSample>{"made-up.1", 1, {100.0, 359.5}}));
  seeds.SaveSample(17, Encode(SomeVehicle()));
  seeds.SaveStruct(18, Encode(Telemetry<ThrusterSample>{"made-up.1", 1, {100.0, 1500.0, 1600.0}}));
}

void SaveConfiguration(Seeds seeds) {
  seeds.Save(0, PrintVehicle(SomeVehicle()));
  seeds.Save(1, "domain: 3\nvehicles { " + PrintVehicle(SomeVehicle()) +
                    "}\nidentification { workers: 2 structure: \"fossen\" }\nhttp { port: 0 }\n"
                    "database: \"postgresql:///t\"\nslices { lease_s: 2 }\nworkers {}\n"
                    "sources { mavlink { address: \"udp:0.0.0.0:14550\" system_ids: 1 } }\n"
                    "upkeep { refresh: \"act\" refresh_on_drift: true }\n");
  seeds.Save(2,
             "time { field: \"stamp_ms\" unit: \"ms\" }\n"
             "positions { latitude: \"lat\" longitude: \"lon\" }\n"
             "headings { field: \"yaw\" unit: \"rad\" frame: \"ENU\" offset_deg: 2.5 }\n"
             "port { field: \"left\" unit: \"share\" }\nstarboard { field: \"right\" unit: \"N\""
             " full_forward: 50 full_reverse: -40 }\n");
}

void SaveStore(Seeds seeds) {
  const std::string chunk = ToProto(SomeRecording()).SerializeAsString();
  seeds.Save(0, chunk);
  seeds.Save(1, PackBlob(chunk).substr(4));
  const IdentificationTask identify{SomeIdentifyRequest(), {}, SomeVehicle(), SomeRecording()};
  const DiagnosisTask diagnose{SomeDiagnoseRequest(), {},
                               SomeVehicle(),         MadeUpIdentification(),
                               SomeRecording(),       SomeRecording()};
  seeds.Save(2, *UnpackBlob(PackTask(identify)));
  seeds.Save(2, *UnpackBlob(PackTask(diagnose)));
  const Result<AssessedModel> model =
      AssessedModel{MadeUpIdentification(), {PromotionVerdict::kWarn, "of one"}, FreeRunError{}};
  const Result<DiagnosedModel> diagnosed =
      DiagnosedModel{MadeUpDiagnosis(), MadeUpIdentification()};
  seeds.Save(3, *UnpackBlob(PackOutcome(model)));
  seeds.Save(4, *UnpackBlob(PackOutcome(diagnosed)));
  seeds.Save(5, SerialiseRequest(SomeIdentifyRequest(), 1e9));
  seeds.Save(5, SerialiseRequest(SomeDiagnoseRequest(), 1e9));
  seeds.Save(5, SerialiseRequest(SomeRefresh(), 1e9));
}

void SaveRequests(Seeds seeds) {
  seeds.SaveSample(0, Encode(SomeIdentifyRequest()));
  seeds.SaveSample(1, Encode(SomeDiagnoseRequest()));
  seeds.SaveSample(2, Encode(SomeRefresh()));
  seeds.Save(3, "{\"vehicleId\": \"boat-1\"}");
  seeds.Save(4, "{\"vehicleId\": \"boat-1\", \"revision\": 3}");
}

}  // namespace
}  // namespace telltale

/// message_seeds FOLDER: whole messages of every kind, from which the fuzzers of the codec, the
/// configuration, the requests and the store start, a folder for each.
int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: message_seeds FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  telltale::SaveCodec(telltale::Seeds(folder / "codec"));
  telltale::SaveConfiguration(telltale::Seeds(folder / "configuration"));
  telltale::SaveStore(telltale::Seeds(folder / "store"));
  telltale::SaveRequests(telltale::Seeds(folder / "requests"));
}
