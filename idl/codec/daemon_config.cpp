#include "telltale/idl/codec/daemon_config.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/codec/text_message.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"
#include "telltale/idl/proto/daemon.pb.h"

namespace telltale {
namespace {

constexpr std::array<std::string_view, 5> kLogLevels = {"trace", "debug", "info", "warn", "error"};
constexpr std::uint32_t kFewestReplicates = 100;  // fewer cannot place a 95 % bound

constexpr std::size_t kMiB = std::size_t{1} << 20;

WindowLimits ReadWindowLimits(FieldReader reader) {
  WindowLimits limits;
  limits.duration_s = reader.Number("duration_s", {10.0, 86400.0}, limits.duration_s);
  const auto default_mib = static_cast<std::uint32_t>(limits.memory_bytes / kMiB);
  limits.memory_bytes = reader.Count("memory_mib", {1.0, 65536.0}, default_mib) * kMiB;
  limits.reorder_tolerance_s =
      reader.Number("reorder_tolerance_s", {0.0, 10.0}, limits.reorder_tolerance_s);
  limits.clock_jump_s = reader.Number("clock_jump_s", {1.0, 86400.0}, limits.clock_jump_s);
  limits.stuck_after_s = reader.Number("stuck_after_s", {1.0, 600.0}, limits.stuck_after_s);
  return limits;
}

std::size_t ReadTotalWindowBytes(FieldReader reader, std::size_t fallback) {
  const auto fallback_mib = static_cast<std::uint32_t>(fallback / kMiB);
  return reader.Count("total_memory_mib", {1.0, 16777216.0}, fallback_mib) * kMiB;
}

constexpr double kYearS = 31536000.0;
constexpr double kCenturyS = 3.2e9;

/// A time that is 0 where it is not to be.
double ReadTimeOrNone(FieldReader& reader, std::string_view field, double longest_s,
                      double fallback_s = 0.0) {
  constexpr double kShortestS = 10.0;
  const double time_s = reader.Number(field, {0.0, longest_s}, fallback_s);
  if (time_s > 0.0 && time_s < kShortestS) {
    reader.Fail(field, NumberText(time_s), "0 or " + FieldRange{kShortestS, longest_s}.Text());
  }
  return time_s;
}

double ReadUnloadAfter(FieldReader reader, double fallback_s) {
  return ReadTimeOrNone(reader, "unload_after_s", kYearS, fallback_s);
}

IntakeLimits ReadIntake(FieldReader reader) {
  IntakeLimits limits;
  limits.samples_per_s = reader.Number("samples_per_s", {10.0, 1e7}, limits.samples_per_s);
  limits.vehicle_samples_per_s =
      reader.Number("vehicle_samples_per_s", {10.0, 1e6}, limits.vehicle_samples_per_s);
  return limits;
}

std::optional<Structure> ReadStructure(FieldReader& reader) {
  const std::string name = reader.Text("structure", "fossen");
  if (name == "static") return Structure::kStaticQuadratic;
  if (name == "dynamic") return Structure::kFirstOrderDynamic;
  if (name == "fossen") return Structure::kFossen;
  if (name != "auto") {
    reader.Fail("structure", '"' + name + '"', "one of fossen, static, dynamic, auto");
  }
  return std::nullopt;
}

IdentificationSettings ReadIdentification(FieldReader reader) {
  IdentificationSettings settings;
  settings.workers = reader.Count("workers", {1.0, 64.0}, settings.workers);
  settings.bootstrap_replicates =
      reader.Count("bootstrap_replicates", {0.0, 100000.0}, settings.bootstrap_replicates);
  if (settings.bootstrap_replicates > 0 && settings.bootstrap_replicates < kFewestReplicates) {
    reader.Fail("bootstrap_replicates", std::to_string(settings.bootstrap_replicates),
                "0 or a number in [100, 100000]");
  }
  settings.interval_level = reader.Number("interval_level", {0.5, 0.999}, settings.interval_level);
  settings.queue_limit = reader.Count("queue_limit", {1.0, 10000.0}, settings.queue_limit);
  settings.structure = ReadStructure(reader);
  return settings;
}

HttpSettings ReadHttp(FieldReader reader) {
  HttpSettings settings;
  settings.address = reader.Text("address", settings.address);
  settings.port = reader.Count("port", {0.0, 65535.0}, settings.port);
  settings.token_file = reader.Text("token_file", settings.token_file);
  settings.connections = reader.Count("connections", {8.0, 1024.0}, settings.connections);
  settings.requests_per_minute =
      reader.Count("requests_per_minute", {60.0, 1e6}, settings.requests_per_minute);
  settings.tls_chain_file = reader.Text("tls_chain_file", settings.tls_chain_file);
  settings.tls_key_file = reader.Text("tls_key_file", settings.tls_key_file);
  if (settings.address.empty()) reader.Fail("address", "\"\"", "an IP address");
  if (settings.tls_chain_file.empty() != settings.tls_key_file.empty()) {
    reader.Fail("tls_key_file", '"' + settings.tls_key_file + '"',
                "a file together with tls_chain_file");
  }
  return settings;
}

RefreshMode ReadRefreshMode(FieldReader& reader) {
  const std::string mode = reader.Text("refresh", "off");
  if (mode == "act") return RefreshMode::kAct;
  if (mode == "advise") return RefreshMode::kAdvise;
  if (mode != "off") reader.Fail("refresh", '"' + mode + '"', "one of off, advise, act");
  return RefreshMode::kOff;
}

UpkeepSettings ReadUpkeep(FieldReader reader, const proto::DaemonConfig::Upkeep& message) {
  UpkeepSettings settings;
  settings.refresh = ReadRefreshMode(reader);
  settings.refresh_every_s = ReadTimeOrNone(reader, "refresh_every_s", kYearS);
  settings.refresh_older_than_s = ReadTimeOrNone(reader, "refresh_older_than_s", kYearS);
  settings.refresh_on_drift = message.refresh_on_drift();
  settings.diagnose_on_drift = message.diagnose_on_drift();
  settings.retry_s = reader.Number("retry_s", {1.0, 86400.0}, settings.retry_s);
  const bool has_occasion = settings.refresh_every_s > 0.0 || settings.refresh_older_than_s > 0.0 ||
                            settings.refresh_on_drift;
  if (settings.refresh != RefreshMode::kOff && !has_occasion) {
    reader.Fail("refresh", '"' + message.refresh() + '"',
                "this with refresh_every_s, refresh_older_than_s or refresh_on_drift");
  }
  return settings;
}

StandbySettings ReadStandby(FieldReader reader) {
  StandbySettings settings;
  if (!reader.Has("ownership_strength")) {
    reader.Fail("ownership_strength", "not given", "a number in [1, 1000], of each daemon another");
  }
  settings.ownership_strength =
      reader.Count("ownership_strength", {1.0, 1000.0}, settings.ownership_strength);
  settings.lease_s = reader.Number("lease_s", {0.5, 5.0}, settings.lease_s);
  return settings;
}

MavlinkSourceSettings ReadMavlinkSource(FieldReader reader,
                                        const proto::DaemonConfig::Source::Mavlink& message) {
  MavlinkSourceSettings settings;
  settings.address = reader.Text("address");
  for (int i = 0; i < message.system_ids_size(); ++i) {
    const std::uint32_t id = message.system_ids(i);
    if (id < 1 || id > 255) {
      reader.FailItem("system_ids", i, std::to_string(id), "a number in [1, 255]");
    }
    settings.system_ids.insert(static_cast<int>(id));
  }
  settings.rate_hz = reader.Number("rate_hz", {0.1, 100.0}, settings.rate_hz);
  settings.listen_only = message.listen_only();
  return settings;
}

Ros2SourceSettings ReadRos2Source(FieldReader reader,
                                  const proto::DaemonConfig::Source::Ros2& message) {
  Ros2SourceSettings settings;
  settings.name_space = reader.Text("namespace", "");
  settings.mapping_file = reader.Text("mapping_file", "");
  if (reader.Has("domain")) settings.domain = reader.Count("domain", {0.0, 101.0}, 0);
  settings.telemetry_only = message.telemetry_only();
  return settings;
}

std::optional<int> ReadOutputChannel(FieldReader& reader, std::string_view field) {
  if (!reader.Has(field)) return std::nullopt;
  return static_cast<int>(reader.Count(field, {1.0, 16.0}, 1));
}

SourceSettings ReadSource(FieldReader reader, const proto::DaemonConfig::Source& message) {
  SourceSettings settings;
  settings.vehicle_id = reader.Text("vehicle_id", "");
  for (int i = 0; i < message.channels_size(); ++i) {
    const auto channel = ChannelNamed(message.channels(i));
    if (channel) {
      settings.channels.insert(*channel);
    } else {
      reader.FailItem("channels", i, Quoted(message.channels(i)),
                      "one of gnss, heading, thrusters");
    }
  }
  settings.port_channel = ReadOutputChannel(reader, "port_channel");
  settings.starboard_channel = ReadOutputChannel(reader, "starboard_channel");
  if (message.has_mavlink() == message.has_ros2()) {
    reader.Fail("mavlink", message.has_mavlink() ? "given with ros2" : "absent, as is ros2",
                "one of the two");
  }
  if (message.has_mavlink()) {
    settings.mavlink = ReadMavlinkSource(reader.Required("mavlink"), message.mavlink());
  }
  if (message.has_ros2()) settings.ros2 = ReadRos2Source(reader.Required("ros2"), message.ros2());
  return settings;
}

std::vector<SourceSettings> ReadSources(FieldReader& reader, const proto::DaemonConfig& message) {
  std::vector<SourceSettings> sources;
  for (const FieldReader& item : reader.Repeated("sources")) {
    sources.push_back(ReadSource(item, message.sources(static_cast<int>(sources.size()))));
  }
  return sources;
}

std::vector<Vehicle> ReadVehicles(FieldReader& reader) {
  std::vector<Vehicle> vehicles;
  std::set<std::string> seen;
  for (FieldReader& item : reader.Repeated("vehicles")) {
    vehicles.push_back(ReadVehicle(item));
    const std::string& id = vehicles.back().vehicle_id;
    if (!seen.insert(id).second) item.Fail("vehicle_id", '"' + id + '"', "an id given only once");
  }
  return vehicles;
}

std::vector<std::string> ReadVehicleFiles(FieldReader& reader, const proto::DaemonConfig& message) {
  for (int i = 0; i < message.vehicle_files_size(); ++i) {
    if (message.vehicle_files(i).empty()) {
      reader.FailItem("vehicle_files", i, "\"\"", "the path of a vehicle file");
    }
  }
  return {message.vehicle_files().begin(), message.vehicle_files().end()};
}

/// Ids with the wildcards of file names, and no more than an id may have.
bool IsIdPattern(std::string pattern) {
  std::ranges::replace(pattern, '*', '_');
  std::ranges::replace(pattern, '?', '_');
  return IsVehicleId(pattern);
}

AnnouncedSettings ReadAnnounced(FieldReader reader, const proto::DaemonConfig::Announced& message) {
  AnnouncedSettings settings;
  settings.admit = {message.admit().begin(), message.admit().end()};
  for (std::size_t i = 0; i < settings.admit.size(); ++i) {
    if (IsIdPattern(settings.admit[i])) continue;
    reader.FailItem("admit", static_cast<int>(i), Quoted(settings.admit[i]),
                    std::string(kVehicleIdAllowed) + ", '*' and '?'");
  }
  settings.most = reader.Count("most", {1.0, 5000.0}, settings.most);
  return settings;
}

std::string ReadLogLevel(FieldReader& reader, const std::string& fallback) {
  std::string level = reader.Text("log_level", fallback);
  if (std::find(kLogLevels.begin(), kLogLevels.end(), level) == kLogLevels.end()) {
    reader.Fail("log_level", '"' + level + '"', "one of trace, debug, info, warn, error");
  }
  return level;
}

/// The value may hold a password, so that no message shows it.
std::string ReadDatabase(FieldReader& reader) {
  std::string database = reader.Text("database", "");
  if (!database.empty() && !database.starts_with("postgresql://")) {
    reader.Fail("database", "\"...\"", "an address that begins with postgresql://");
  }
  return database;
}

SliceSettings ReadSlices(FieldReader reader) {
  SliceSettings settings;
  settings.lease_s = reader.Number("lease_s", {1.0, 600.0}, settings.lease_s);
  return settings;
}

RetentionSettings ReadRetention(FieldReader reader) {
  RetentionSettings settings;
  settings.models_per_vehicle =
      reader.Count("models_per_vehicle", {2.0, 200.0}, settings.models_per_vehicle);
  settings.model_age_s = ReadTimeOrNone(reader, "model_age_s", kCenturyS, settings.model_age_s);
  settings.diagnosis_age_s =
      ReadTimeOrNone(reader, "diagnosis_age_s", kCenturyS, settings.diagnosis_age_s);
  settings.window_age_s = ReadTimeOrNone(reader, "window_age_s", kCenturyS, settings.window_age_s);
  const auto default_mib = static_cast<std::uint32_t>(settings.store_bytes / kMiB);
  settings.store_bytes = reader.Count("store_mib", {0.0, 16777216.0}, default_mib) * kMiB;
  settings.period_s = reader.Number("period_s", {1.0, 86400.0}, settings.period_s);
  return settings;
}

WorkerSettings ReadWorkers(FieldReader reader) {
  WorkerSettings settings;
  settings.lease_s = reader.Number("lease_s", {1.0, 600.0}, settings.lease_s);
  settings.attempts = reader.Count("attempts", {1.0, 100.0}, settings.attempts);
  settings.most_jobs = reader.Count("most_jobs", {1.0, 256.0}, settings.most_jobs);
  return settings;
}

DaemonConfig ReadConfig(FieldReader reader, const proto::DaemonConfig& message) {
  DaemonConfig config;
  config.domain = reader.Count("domain", {0.0, 101.0}, config.domain);
  config.vehicles = ReadVehicles(reader);
  config.vehicle_files = ReadVehicleFiles(reader, message);
  config.vehicle_folder = reader.Text("vehicle_folder", config.vehicle_folder);
  if (message.has_announced()) {
    config.announced = ReadAnnounced(reader.Optional("announced"), message.announced());
  }
  config.state_directory = reader.Text("state_directory", config.state_directory);
  if (config.state_directory.empty()) reader.Fail("state_directory", "\"\"", "a folder");
  config.require_partition = message.require_partition();
  config.database = ReadDatabase(reader);
  if (message.has_slices()) config.slices = ReadSlices(reader.Optional("slices"));
  if (config.slices && config.database.empty()) {
    reader.Fail("slices", "{}", "this with database, which the daemons share");
  }
  if (message.has_workers()) config.workers = ReadWorkers(reader.Optional("workers"));
  if (config.workers && config.database.empty()) {
    reader.Fail("workers", "{}", "this with database, where the workers find their jobs");
  }
  config.window = ReadWindowLimits(reader.Optional("window"));
  config.total_window_bytes =
      ReadTotalWindowBytes(reader.Optional("window"), config.total_window_bytes);
  config.intake = ReadIntake(reader.Optional("intake"));
  config.retention = ReadRetention(reader.Optional("retention"));
  config.window_save_period_s =
      reader.Optional("window").Number("save_period_s", {0.1, 600.0}, config.window_save_period_s);
  config.window_unload_after_s =
      ReadUnloadAfter(reader.Optional("window"), config.window_unload_after_s);
  config.identification = ReadIdentification(reader.Optional("identification"));
  if (message.has_http()) config.http = ReadHttp(reader.Optional("http"));
  config.upkeep = ReadUpkeep(reader.Optional("upkeep"), message.upkeep());
  if (message.has_standby()) config.standby = ReadStandby(reader.Optional("standby"));
  config.sources = ReadSources(reader, message);
  if (config.standby && !config.database.empty()) {
    reader.Fail("standby", "{}", "this without database: daemons share one by slices");
  }
  config.quality_period_s =
      reader.Number("quality_period_s", {0.1, 3600.0}, config.quality_period_s);
  config.log_level = ReadLogLevel(reader, config.log_level);
  return config;
}

}  // namespace

Decoded<DaemonConfig> ParseDaemonConfig(std::string_view text, const std::string& file) {
  proto::DaemonConfig message;
  google::protobuf::TextFormat::ParseInfoTree lines;
  std::optional<CodecError> fault = ParseTextMessage(text, file, message, lines);
  if (fault) return tl::unexpected(*fault);
  const FieldSource source{file, FieldSource::Names::kProto, &lines};
  DaemonConfig config = ReadConfig(FieldReader(message, source, fault), message);
  if (fault) return tl::unexpected(*fault);
  return config;
}

std::optional<CodecError> DuplicateVehicle(std::span<const Vehicle> vehicles) {
  std::set<std::string_view> seen;
  for (const Vehicle& vehicle : vehicles) {
    if (seen.insert(vehicle.vehicle_id).second) continue;
    return CodecError{"vehicle_id", '"' + vehicle.vehicle_id + '"', "an id given only once"};
  }
  return std::nullopt;
}

}  // namespace telltale
