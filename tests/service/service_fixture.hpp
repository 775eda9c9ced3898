#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bus/participant.hpp"
#include "codec/messages.hpp"
#include "data/samples.hpp"
#include "fleet/identification_client.hpp"
#include "support/loopback_domain.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace telltale {

/// Two minutes of the simulated Yellowfish under random steps in all four regions.
Recording SimulatedRecording();

std::size_t SizeOf(const Recording& recording);

/// Real programs on a domain and in a folder of the test's own.
class ServiceTest : public testing::Test {
 protected:
  static constexpr const char* kVehicleId = "yellowfish";

  ServiceTest();

  /// telltaled, serving.
  std::unique_ptr<Process> StartDaemon() const;

  /// telltale with these arguments on this test's domain.
  std::unique_ptr<Process> Start(const std::vector<std::string>& arguments) const;

  /// Writes the simulated recording as a log and replays it to the end.
  void ReplaySimulation() const;

  IdentifyRequest Request(const std::string& correlation_id) const;

  /// The first report on `vehicle_id` that is `as_expected`; empty when none is within 20 s.
  std::optional<Quality> AwaitQuality(const std::string& vehicle_id,
                                      const std::function<bool(const Quality&)>& as_expected) const;

  LoopbackDomain domain_;
  TemporaryFolder folder_;
  std::filesystem::path config_file_;
};

/// How often this was set aside for that reason.
std::uint64_t CountOf(const Quality& quality, const std::string& channel,
                      const std::string& reason);

}  // namespace telltale
