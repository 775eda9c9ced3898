#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/data/window.hpp"
#include "telltale/core/vessel/model_structure.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/mapping_file.hpp"

namespace telltale {

/// How the daemon identifies.
struct IdentificationSettings {
  std::uint32_t workers = 1;                  ///< [1, 64]
  std::uint32_t bootstrap_replicates = 1000;  ///< 0 or [100, 100000]
  double interval_level = 0.95;               ///< [0.5, 0.999]
  std::uint32_t queue_limit = 1024;           ///< [1, 10000]
  /// Of requests that name none; nothing: by the data.
  std::optional<Structure> structure;
};

/// The web server of the daemon. Paths are as written; who opens them resolves them.
struct HttpSettings {
  std::string address = "127.0.0.1";
  std::uint32_t port = 8480;                 ///< [0, 65535]; 0: any that is free
  std::string token_file;                    ///< empty: nothing can be changed over HTTP
  std::uint32_t connections = 128;           ///< [8, 1024]
  std::uint32_t requests_per_minute = 6000;  ///< [60, 1000000] of one client
  std::string tls_chain_file;                ///< both or neither
  std::string tls_key_file;
};

/// Whether the daemon refreshes models by itself. kAdvise: it says which need it.
enum class RefreshMode { kOff, kAdvise, kAct };

/// What the daemon does by itself.
struct UpkeepSettings {
  RefreshMode refresh = RefreshMode::kOff;
  double refresh_every_s = 0.0;       ///< 0: not by schedule, or [10, 31536000]
  double refresh_older_than_s = 0.0;  ///< 0: not by age, or [10, 31536000]
  bool refresh_on_drift = false;
  bool diagnose_on_drift = false;
  double retry_s = 600.0;  ///< [1, 86400] to the next try of the same vehicle
};

/// How the daemon and another stand in for each other.
struct StandbySettings {
  std::uint32_t ownership_strength = 1;  ///< [1, 1000]; the stronger serves where both start
  double lease_s = 2.0;                  ///< [0.5, 5] of silence until a daemon counts as dead
};

/// Running boats on a MAVLink link.
struct MavlinkSourceSettings {
  std::string address;       ///< as written; who opens it checks it
  std::set<int> system_ids;  ///< [1, 255]; empty: every vehicle that is heard
  double rate_hz = 10.0;     ///< [0.1, 100]
  bool listen_only = false;
};

/// Running boats on topics of ROS 2.
struct Ros2SourceSettings {
  std::string name_space;                  ///< as written; empty: the default
  std::string mapping_file;                ///< as written; who opens it resolves it
  std::shared_ptr<const Mapping> mapping;  ///< what it holds; null: by the types of the topics
  std::optional<std::uint32_t> domain;     ///< [0, 101]; unset: that of the daemon
  bool telemetry_only = false;
};

/// Running boats whose telemetry comes another way than on the bus: exactly one of the two.
struct SourceSettings {
  std::string vehicle_id;                ///< a pattern as written; empty: the default
  std::set<Channel> channels;            ///< empty: all
  std::optional<int> port_channel;       ///< [1, 16]
  std::optional<int> starboard_channel;  ///< [1, 16]
  std::optional<MavlinkSourceSettings> mavlink;
  std::optional<Ros2SourceSettings> ros2;
};

/// What the daemon takes in at most; it sheds the samples that come beyond.
struct IntakeLimits {
  double samples_per_s = 100'000.0;         ///< [10, 1e7] of all vehicles
  double vehicle_samples_per_s = 20'000.0;  ///< [10, 1e6] of each
};

/// How daemons share the fleet.
struct SliceSettings {
  double lease_s = 10.0;  ///< [1, 600] after which others take over
};

/// What the store keeps at most.
struct RetentionSettings {
  std::uint32_t models_per_vehicle = 200;              ///< [2, 200] the newest
  double model_age_s = 0.0;                            ///< 0: of any age, or [10, 3.2e9]
  double diagnosis_age_s = 0.0;                        ///< likewise, of those before the last
  double window_age_s = 7'776'000.0;                   ///< likewise, since it was saved
  std::size_t store_bytes = std::size_t{20480} << 20;  ///< 0: of any size, or [1 MiB, 16 TiB]
  double period_s = 600.0;                             ///< [1, 86400] from check to check
};

/// How a daemon shares heavy jobs with workers: coverage checks and diagnoses.
struct WorkerSettings {
  double lease_s = 10.0;        ///< [1, 600] after which a silent worker counts as dead
  std::uint32_t attempts = 3;   ///< [1, 100] of workers at a job that none finishes
  std::uint32_t most_jobs = 8;  ///< [1, 256] of the daemon and of each kind at a time
};

/// Which boats may join the fleet by announcing themselves.
struct AnnouncedSettings {
  std::vector<std::string> admit;  ///< ids, with * and ? as in file names; none: no boat
  std::uint32_t most = 1000;       ///< [1, 5000] boats
};

/// Configuration of telltaled; defaults and ranges are those of proto/daemon.proto.
struct DaemonConfig {
  std::uint32_t domain = 0;  ///< [0, 101]
  std::vector<Vehicle> vehicles;
  std::vector<std::string> vehicle_files;  ///< as written; who opens them resolves them
  std::string vehicle_folder;              ///< likewise; empty: none
  AnnouncedSettings announced;
  std::string state_directory = "/var/lib/telltale";
  std::string database;                   ///< postgresql://...; empty: SQLite in state_directory
  std::optional<SliceSettings> slices;    ///< unset: it has the fleet alone
  std::optional<WorkerSettings> workers;  ///< unset: it computes everything itself
  WindowLimits window;
  std::size_t total_window_bytes = std::size_t{4096} << 20;  ///< [1 MiB, 16 TiB] of all vehicles
  IntakeLimits intake;
  RetentionSettings retention;
  bool require_partition = false;     ///< telemetry only from the DDS partition of the vehicle's id
  double window_save_period_s = 5.0;  ///< [0.1, 600]
  double window_unload_after_s = 3600.0;  ///< 0: never, or [10, 31536000] of silence
  IdentificationSettings identification;
  std::optional<HttpSettings> http;
  UpkeepSettings upkeep;
  std::vector<SourceSettings> sources;
  std::optional<StandbySettings> standby;  ///< unset: this daemon serves alone
  double quality_period_s = 1.0;           ///< [0.1, 3600]
  std::string log_level = "info";          ///< trace, debug, info, warn, error
};

/// Text format -> DaemonConfig. `file` is only what errors call the text.
/// Refuses: unknown fields, values out of range, a wrong vehicle, a vehicle id given twice, a
/// source of no kind or of two. The vehicles of vehicle_files and the mappings of mapping_file are
/// not read here; add them and ask DuplicateVehicle again.
Decoded<DaemonConfig> ParseDaemonConfig(std::string_view text,
                                        const std::string& file = "configuration");

/// The first vehicle whose id an earlier one has.
std::optional<CodecError> DuplicateVehicle(std::span<const Vehicle> vehicles);

}  // namespace telltale
