#include "telltale/idl/codec/daemon_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "support/test_name.hpp"

namespace telltale {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string VehicleNamed(const std::string& id) {
  return "vehicles { vehicle_id: \"" + id +
         "\" propeller_separation_m: 0.5 "
         "port { neutral_us: 1500 full_forward_us: 1900 full_reverse_us: 1100 } "
         "starboard { neutral_us: 1500 full_forward_us: 1900 full_reverse_us: 1100 } }\n";
}

TEST(DaemonConfig, AnEmptyFileMeansTheDefaultsOfTheSchema) {
  const auto config = ParseDaemonConfig("");
  ASSERT_TRUE(config) << config.error().Message();
  EXPECT_EQ(config->domain, 0u);
  EXPECT_TRUE(config->vehicles.empty());
  EXPECT_TRUE(config->vehicle_files.empty());
  EXPECT_EQ(config->state_directory, "/var/lib/telltale");
  EXPECT_EQ(config->database, "");
  EXPECT_EQ(config->window.duration_s, 1200.0);
  EXPECT_EQ(config->window.memory_bytes, std::size_t{64} << 20);
  EXPECT_EQ(config->window.reorder_tolerance_s, 0.5);
  EXPECT_EQ(config->window.clock_jump_s, 60.0);
  EXPECT_EQ(config->window.stuck_after_s, 5.0);
  EXPECT_EQ(config->window_unload_after_s, 3600.0);
  EXPECT_EQ(config->identification.workers, 1u);
  EXPECT_EQ(config->identification.bootstrap_replicates, 1000u);
  EXPECT_EQ(config->identification.interval_level, 0.95);
  EXPECT_EQ(config->identification.queue_limit, 1024u);
  EXPECT_EQ(config->identification.structure, Structure::kFossen);
  EXPECT_EQ(config->quality_period_s, 1.0);
  EXPECT_EQ(config->log_level, "info");
  EXPECT_FALSE(config->http);
}

TEST(DaemonConfig, AnEmptyHttpBlockIsALoopbackServerThatChangesNothing) {
  const auto config = ParseDaemonConfig("http {}");
  ASSERT_TRUE(config && config->http);
  EXPECT_EQ(config->http->address, "127.0.0.1");
  EXPECT_EQ(config->http->port, 8480u);
  EXPECT_EQ(config->http->token_file, "");
  EXPECT_EQ(config->http->connections, 128u);
  EXPECT_EQ(config->http->tls_chain_file, "");
}

TEST(DaemonConfig, ReadsTheHttpBlock) {
  const auto config = ParseDaemonConfig(
      "http { address: \"::1\" port: 0 token_file: \"t\" connections: 8 tls_chain_file: \"c\" "
      "tls_key_file: \"k\" }");
  ASSERT_TRUE(config && config->http);
  EXPECT_EQ(config->http->address, "::1");
  EXPECT_EQ(config->http->port, 0u);
  EXPECT_EQ(config->http->token_file, "t");
  EXPECT_EQ(config->http->connections, 8u);
  EXPECT_EQ(config->http->tls_chain_file, "c");
  EXPECT_EQ(config->http->tls_key_file, "k");
}

TEST(DaemonConfig, ServesAloneUnlessItIsTold) {
  EXPECT_FALSE(ParseDaemonConfig("")->standby);
  const auto config = ParseDaemonConfig("standby { ownership_strength: 7 }");
  ASSERT_TRUE(config && config->standby);
  EXPECT_EQ(config->standby->ownership_strength, 7u);
  EXPECT_EQ(config->standby->lease_s, 2.0);
}

TEST(DaemonConfig, RefusesAStandbyWithoutAStrengthOrALease) {
  for (const char* text : {"standby {}", "standby { ownership_strength: 0 }",
                           "standby { ownership_strength: 1001 }"}) {
    const auto config = ParseDaemonConfig(text);
    ASSERT_FALSE(config) << text;
    EXPECT_THAT(config.error().field, HasSubstr("ownership_strength"));
    EXPECT_THAT(config.error().Message(), HasSubstr("[1, 1000]"));
  }
  const auto config = ParseDaemonConfig("standby { ownership_strength: 1 lease_s: 0.4 }");
  ASSERT_FALSE(config);
  EXPECT_THAT(config.error().field, HasSubstr("lease_s"));
}

TEST(DaemonConfig, RequiresNoPartitionUnlessItIsTold) {
  EXPECT_FALSE(ParseDaemonConfig("")->require_partition);
  EXPECT_TRUE(ParseDaemonConfig("require_partition: true")->require_partition);
}

TEST(DaemonConfig, DoesNothingByItselfUnlessTold) {
  const auto config = ParseDaemonConfig("upkeep {}");
  ASSERT_TRUE(config);
  EXPECT_EQ(config->upkeep.refresh, RefreshMode::kOff);
  EXPECT_FALSE(config->upkeep.refresh_on_drift);
  EXPECT_FALSE(config->upkeep.diagnose_on_drift);
  EXPECT_EQ(config->upkeep.retry_s, 600.0);
}

TEST(DaemonConfig, ReadsTheUpkeepBlock) {
  const auto config = ParseDaemonConfig(
      "upkeep { refresh: \"act\" refresh_every_s: 86400 refresh_older_than_s: 10 "
      "refresh_on_drift: true diagnose_on_drift: true retry_s: 60 }");
  ASSERT_TRUE(config) << config.error().Message();
  EXPECT_EQ(config->upkeep.refresh, RefreshMode::kAct);
  EXPECT_EQ(config->upkeep.refresh_every_s, 86400.0);
  EXPECT_EQ(config->upkeep.refresh_older_than_s, 10.0);
  EXPECT_TRUE(config->upkeep.refresh_on_drift);
  EXPECT_TRUE(config->upkeep.diagnose_on_drift);
  EXPECT_EQ(config->upkeep.retry_s, 60.0);
  EXPECT_EQ(
      ParseDaemonConfig("upkeep { refresh: \"advise\" refresh_on_drift: true }")->upkeep.refresh,
      RefreshMode::kAdvise);
}

TEST(DaemonConfig, KeepsModelsOfAnyAgeAndWindowsOfNinetyDaysUnlessItIsTold) {
  const RetentionSettings retention = ParseDaemonConfig("retention {}")->retention;
  EXPECT_EQ(retention.models_per_vehicle, 200u);
  EXPECT_EQ(retention.model_age_s, 0.0);
  EXPECT_EQ(retention.diagnosis_age_s, 0.0);
  EXPECT_EQ(retention.window_age_s, 90.0 * 86400.0);
  EXPECT_EQ(retention.store_bytes, std::size_t{20} << 30);
  EXPECT_EQ(retention.period_s, 600.0);
}

TEST(DaemonConfig, ReadsTheRetentionBlock) {
  const auto config = ParseDaemonConfig(
      "retention { models_per_vehicle: 2 model_age_s: 3.2e9 diagnosis_age_s: 10 window_age_s: 0 "
      "store_mib: 3 period_s: 1 }");
  ASSERT_TRUE(config) << config.error().Message();
  EXPECT_EQ(config->retention.models_per_vehicle, 2u);
  EXPECT_EQ(config->retention.model_age_s, 3.2e9);
  EXPECT_EQ(config->retention.diagnosis_age_s, 10.0);
  EXPECT_EQ(config->retention.window_age_s, 0.0);
  EXPECT_EQ(config->retention.store_bytes, std::size_t{3} << 20);
  EXPECT_EQ(config->retention.period_s, 1.0);
  EXPECT_EQ(ParseDaemonConfig("retention { store_mib: 0 }")->retention.store_bytes, 0u);
}

TEST(DaemonConfig, AdmitsNoBoatThatAnnouncesItselfUnlessItIsTold) {
  EXPECT_THAT(ParseDaemonConfig("")->announced.admit, ElementsAre());
  EXPECT_THAT(ParseDaemonConfig("announced {}")->announced.admit, ElementsAre());
  EXPECT_EQ(ParseDaemonConfig("announced {}")->announced.most, 1000u);
}

TEST(DaemonConfig, ReadsWhichBoatsMayAnnounceThemselves) {
  const auto config =
      ParseDaemonConfig("announced { admit: \"boat-*\" admit: \"buoy.?\" most: 7 }");
  ASSERT_TRUE(config) << config.error().Message();
  EXPECT_THAT(config->announced.admit, ElementsAre("boat-*", "buoy.?"));
  EXPECT_EQ(config->announced.most, 7u);
  const auto field_at_fault = [](const std::string& fields) {
    const auto wrong = ParseDaemonConfig("announced { " + fields + " }");
    return wrong ? std::string() : wrong.error().field;
  };
  EXPECT_EQ(field_at_fault("admit: \"*\" admit: \"two words\""), "announced.admit[1]");
  EXPECT_EQ(field_at_fault("admit: \"[ab]\""), "announced.admit[0]");
  EXPECT_EQ(field_at_fault("admit: \"\""), "announced.admit[0]");
  EXPECT_EQ(field_at_fault("admit: \"*\" most: 0"), "announced.most");
  EXPECT_EQ(field_at_fault("admit: \"*\" most: 5001"), "announced.most");
}

TEST(DaemonConfig, ReadsEveryField) {
  const auto config = ParseDaemonConfig(
      "domain: 42\n" + VehicleNamed("a") + VehicleNamed("b") +
      "vehicle_files: \"c.textproto\" vehicle_files: \"d.textproto\"\n"
      "state_directory: \"/tmp/state\"\n"
      "window { duration_s: 600 memory_mib: 2 reorder_tolerance_s: 0 clock_jump_s: 5 "
      "stuck_after_s: 9 total_memory_mib: 3 unload_after_s: 10 }\n"
      "intake { samples_per_s: 5000 vehicle_samples_per_s: 70 }\n"
      "identification { workers: 3 bootstrap_replicates: 0 interval_level: 0.9 queue_limit: 7 "
      "structure: \"auto\" }\n"
      "quality_period_s: 0.5 log_level: \"debug\"\n");
  ASSERT_TRUE(config) << config.error().Message();
  EXPECT_EQ(config->domain, 42u);
  EXPECT_EQ(config->total_window_bytes, 3u << 20);
  EXPECT_EQ(config->window_unload_after_s, 10.0);
  EXPECT_EQ(config->intake.samples_per_s, 5000.0);
  EXPECT_EQ(config->intake.vehicle_samples_per_s, 70.0);
  ASSERT_EQ(config->vehicles.size(), 2u);
  EXPECT_EQ(config->vehicles[1].vehicle_id, "b");
  EXPECT_THAT(config->vehicle_files, ElementsAre("c.textproto", "d.textproto"));
  EXPECT_EQ(config->state_directory, "/tmp/state");
  EXPECT_EQ(config->window.duration_s, 600.0);
  EXPECT_EQ(config->window.memory_bytes, std::size_t{2} << 20);
  EXPECT_EQ(config->window.reorder_tolerance_s, 0.0);
  EXPECT_EQ(config->window.clock_jump_s, 5.0);
  EXPECT_EQ(config->window.stuck_after_s, 9.0);
  EXPECT_EQ(config->identification.workers, 3u);
  EXPECT_EQ(config->identification.bootstrap_replicates, 0u);
  EXPECT_EQ(config->identification.interval_level, 0.9);
  EXPECT_EQ(config->identification.queue_limit, 7u);
  EXPECT_EQ(config->identification.structure, std::nullopt);
  EXPECT_EQ(config->quality_period_s, 0.5);
  EXPECT_EQ(config->log_level, "debug");
}

struct ConfigFault {
  std::string text, field, value, allowed;
};

void PrintTo(const ConfigFault& fault, std::ostream* out) {
  *out << AsTestName(fault.text);
}

class WrongConfig : public testing::TestWithParam<ConfigFault> {};

TEST_P(WrongConfig, IsRefusedNamingFieldValueRangeAndLine) {
  const ConfigFault& fault = GetParam();
  const auto config = ParseDaemonConfig("# first line\n" + fault.text, "d.textproto");
  ASSERT_FALSE(config);
  EXPECT_EQ(config.error().field, fault.field);
  EXPECT_EQ(config.error().value, fault.value);
  EXPECT_THAT(config.error().allowed, HasSubstr(fault.allowed));
  EXPECT_EQ(config.error().where, "d.textproto:2");
}

INSTANTIATE_TEST_SUITE_P(
    DaemonConfig, WrongConfig,
    testing::Values(
        ConfigFault{"domain: 102", "domain", "102", "[0, 101]"},
        ConfigFault{"domain: -1", "domain", "-1", "integer"},
        ConfigFault{"domian: 1", "domian", "1", "domain"},
        ConfigFault{"state_directory: \"\"", "state_directory", "\"\"", "folder"},
        ConfigFault{"vehicle_files: \"\"", "vehicle_files[0]", "\"\"", "path"},
        ConfigFault{"window { duration_s: 9 }", "window.duration_s", "9", "[10, 86400]"},
        ConfigFault{"window { duration_s: nan }", "window.duration_s", "nan", "[10, 86400]"},
        ConfigFault{"window { memory_mib: 0 }", "window.memory_mib", "0", "[1, 65536]"},
        ConfigFault{"window { total_memory_mib: 0 }", "window.total_memory_mib", "0",
                    "[1, 16777216]"},
        ConfigFault{"window { unload_after_s: 9 }", "window.unload_after_s", "9", "[10, 31536000]"},
        ConfigFault{"intake { samples_per_s: 9 }", "intake.samples_per_s", "9", "[10, 10000000]"},
        ConfigFault{"intake { vehicle_samples_per_s: inf }", "intake.vehicle_samples_per_s", "inf",
                    "[10, 1000000]"},
        ConfigFault{"window { reorder_tolerance_s: -0.1 }", "window.reorder_tolerance_s", "-0.1",
                    "[0, 10]"},
        ConfigFault{"window { clock_jump_s: 0 }", "window.clock_jump_s", "0", "[1, 86400]"},
        ConfigFault{"window { stuck_after_s: 601 }", "window.stuck_after_s", "601", "[1, 600]"},
        ConfigFault{"identification { workers: 65 }", "identification.workers", "65", "[1, 64]"},
        ConfigFault{"identification { bootstrap_replicates: 99 }",
                    "identification.bootstrap_replicates", "99", "0 or a number in [100, 100000]"},
        ConfigFault{"identification { bootstrap_replicates: 100001 }",
                    "identification.bootstrap_replicates", "100001", "100000]"},
        ConfigFault{"identification { interval_level: 1 }", "identification.interval_level", "1",
                    "[0.5, 0.999]"},
        ConfigFault{"identification { structure: \"best\" }", "identification.structure",
                    "\"best\"", "one of fossen, static, dynamic, auto"},
        ConfigFault{"identification { queue_limit: 0 }", "identification.queue_limit", "0",
                    "[1, 10000]"},
        ConfigFault{"http { port: 65536 }", "http.port", "65536", "[0, 65535]"},
        ConfigFault{"http { connections: 7 }", "http.connections", "7", "[8, 1024]"},
        ConfigFault{"http { address: \"\" }", "http.address", "\"\"", "an IP address"},
        ConfigFault{"http { tls_chain_file: \"c\" }", "http.tls_key_file", "\"\"",
                    "together with tls_chain_file"},
        ConfigFault{"upkeep { refresh: \"on\" }", "upkeep.refresh", "\"on\"", "off, advise, act"},
        ConfigFault{"upkeep { refresh: \"act\" }", "upkeep.refresh", "\"act\"",
                    "refresh_every_s, refresh_older_than_s or refresh_on_drift"},
        ConfigFault{"upkeep { refresh_every_s: 9 }", "upkeep.refresh_every_s", "9",
                    "[10, 31536000]"},
        ConfigFault{"upkeep { refresh_older_than_s: -1 }", "upkeep.refresh_older_than_s", "-1",
                    "[0, 31536000]"},
        ConfigFault{"upkeep { retry_s: 0 }", "upkeep.retry_s", "0", "[1, 86400]"},
        ConfigFault{"retention { models_per_vehicle: 1 }", "retention.models_per_vehicle", "1",
                    "[2, 200]"},
        ConfigFault{"retention { model_age_s: 9 }", "retention.model_age_s", "9",
                    "0 or a number in [10, 3200000000]"},
        ConfigFault{"retention { window_age_s: nan }", "retention.window_age_s", "nan", "[0, "},
        ConfigFault{"retention { store_mib: 16777217 }", "retention.store_mib", "16777217",
                    "[0, 16777216]"},
        ConfigFault{"retention { period_s: 0 }", "retention.period_s", "0", "[1, 86400]"},
        ConfigFault{"database: \"mysql://boat:sesame@db\"", "database", "\"...\"", "postgresql://"},
        ConfigFault{"slices {}", "slices", "{}", "with database"},
        ConfigFault{"database: \"postgresql:///t\" standby { ownership_strength: 1 }", "standby",
                    "{}", "without database"},
        ConfigFault{"database: \"postgresql:///t\" slices { lease_s: 0.5 }", "slices.lease_s",
                    "0.5", "[1, 600]"},
        ConfigFault{"workers {}", "workers", "{}", "with database"},
        ConfigFault{"database: \"postgresql:///t\" workers { lease_s: 0.5 }", "workers.lease_s",
                    "0.5", "[1, 600]"},
        ConfigFault{"database: \"postgresql:///t\" workers { attempts: 0 }", "workers.attempts",
                    "0", "[1, 100]"},
        ConfigFault{"database: \"postgresql:///t\" workers { most_jobs: 257 }", "workers.most_jobs",
                    "257", "[1, 256]"},
        ConfigFault{"quality_period_s: 0.01", "quality_period_s", "0.01", "[0.1, 3600]"},
        ConfigFault{"log_level: \"loud\"", "log_level", "\"loud\"",
                    "trace, debug, info, warn, error"},
        ConfigFault{"vehicles { vehicle_id: \"a\" }", "vehicles[0].propeller_separation_m", "",
                    "required"}));

TEST(DaemonConfig, TheSameVehicleTwiceIsRefusedWhereItComesAgain) {
  const auto config =
      ParseDaemonConfig(VehicleNamed("a") + VehicleNamed("b") + VehicleNamed("a"), "d.textproto");
  ASSERT_FALSE(config);
  EXPECT_EQ(config.error().field, "vehicles[2].vehicle_id");
  EXPECT_EQ(config.error().value, "\"a\"");
  EXPECT_EQ(config.error().where, "d.textproto:3");
}

TEST(DaemonConfig, DuplicatesAcrossFilesCanBeAskedFor) {
  std::vector<Vehicle> vehicles(2);
  vehicles[0].vehicle_id = "a";
  vehicles[1].vehicle_id = "b";
  EXPECT_FALSE(DuplicateVehicle(vehicles));
  vehicles.push_back(vehicles.front());
  ASSERT_TRUE(DuplicateVehicle(vehicles));
  EXPECT_EQ(DuplicateVehicle(vehicles)->value, "\"a\"");
}

}  // namespace
}  // namespace telltale
