#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace telltale {

/// Daemons on one domain that stand in for each other, each with a state directory of its own. Each
/// serves the vehicle of `vehicle.textproto` in the folder.
class DaemonPair {
 public:
  /// A busy machine that runs other tests keeps a daemon waiting for seconds: a test that measures
  /// nothing takes the longest lease, of 5 s. `settings`: further fields of the configuration.
  DaemonPair(std::uint32_t domain, const TemporaryFolder& folder, double lease_s,
             std::string settings)
      : domain_(domain), folder_(folder), lease_s_(lease_s), settings_(std::move(settings)) {}

  /// telltaled of this name, which takes in telemetry. The same name again is the same daemon after
  /// a restart.
  std::unique_ptr<Process> Start(const std::string& name, int ownership_strength) const {
    const auto state = folder_.Path() / ("state-" + name);
    const auto file = folder_.Write(
        name + ".textproto", "domain: " + std::to_string(domain_) +
                                 "\nvehicle_files: \"vehicle.textproto\"\nstate_directory: \"" +
                                 state.string() +
                                 "\"\nquality_period_s: 0.1\nstandby { ownership_strength: " +
                                 std::to_string(ownership_strength) +
                                 " lease_s: " + std::to_string(lease_s_) + " }\n" + settings_);
    auto daemon = std::make_unique<Process>(std::vector<std::string>{TELLTALED, "--config", file});
    EXPECT_TRUE(daemon->WaitForOutput("serving 1 vehicles")) << daemon->output();
    return daemon;
  }

  /// The term for which the daemon serves or served last; 0: it has not served.
  static int NewestTerm(const Process& daemon) {
    static const std::string kServes = "this daemon serves from now on, for term ";
    const std::string log = daemon.output();
    const auto at = log.rfind(kServes);
    return at == std::string::npos ? 0 : std::stoi(log.substr(at + kServes.size()));
  }

  static bool TakesOver(Process& daemon, int term) {
    return daemon.WaitForOutput("this daemon serves from now on, for term " + std::to_string(term) +
                                '\n');
  }

  static bool StandsBy(Process& daemon, int term) {
    return daemon.WaitForOutput("another daemon serves, for term " + std::to_string(term) +
                                "; this one stands by");
  }

  /// For whichever term.
  static bool StandsBy(Process& daemon) { return daemon.WaitForOutput("; this one stands by"); }

  static bool Keeps(Process& daemon, std::uint64_t revision) {
    return daemon.WaitForOutput("revision " + std::to_string(revision) +
                                " of yellowfish is kept as another daemon has published it");
  }

  /// What was published while it was down is in its store.
  static bool IsComplete(Process& daemon) {
    return daemon.WaitForOutput("the models of yellowfish are as complete");
  }

 private:
  std::uint32_t domain_;
  const TemporaryFolder& folder_;
  double lease_s_;
  std::string settings_;
};

}  // namespace telltale
