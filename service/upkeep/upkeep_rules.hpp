#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "telltale/idl/codec/daemon_config.hpp"

namespace telltale {

/// What upkeep knows of a vehicle. Times are Unix seconds by the daemon's clock.
struct UpkeepFacts {
  bool has_telemetry = false;            ///< its window holds samples
  std::uint64_t revision = 0;            ///< of its newest model; 0: none
  double published_unix_s = 0.0;         ///< likewise
  double drift_since_unix_s = 0.0;       ///< onset of the drift; 0: none
  double drift_lasts_s = 0.0;            ///< by the vehicle's clock, in what its window holds
  std::uint64_t diagnosed_revision = 0;  ///< the model that its last diagnosis is about; 0: none
};

/// What a vehicle needs.
struct UpkeepStep {
  bool diagnose = false;
  std::string refresh;  ///< why it needs a new model; empty: it does not
};

/// Decides which models need a refresh and which drifts a diagnosis.
/// - By schedule: once in every period since the start.
/// - By age: where the newest model is older, or where there is none.
/// - By drift: where the model drifts. With diagnose_on_drift the diagnosis comes first, since it
///   is about the model that drifts.
/// A diagnosis waits until the drift has lasted for a minute and a half, so that it has data of the
/// vehicle as it is now.
/// A vehicle without telemetry needs nothing. A refresh is due again after retry_s where its cause
/// is still there, a diagnosis once for each drift. Not thread safe.
class UpkeepRules {
 public:
  UpkeepRules(const UpkeepSettings& settings, double start_unix_s);

  UpkeepStep Consider(const std::string& vehicle_id, const UpkeepFacts& facts, double now_unix_s);

 private:
  struct Vehicle {
    double rounds = 0.0;                     ///< of the schedule that it has had
    std::optional<double> refreshed_unix_s;  ///< the last try
    std::optional<double> diagnosed_unix_s;  ///< likewise
    std::uint64_t diagnosed_revision = 0;    ///< that the last try was about
  };

  bool NeedsDiagnosis(const Vehicle& vehicle, const UpkeepFacts& facts) const;
  bool AwaitsDiagnosis(const Vehicle& vehicle, const UpkeepFacts& facts, double now_unix_s) const;
  std::string RefreshReason(const Vehicle& vehicle, const UpkeepFacts& facts,
                            double now_unix_s) const;
  bool IsRecent(std::optional<double> unix_s, double now_unix_s) const;
  double Rounds(double now_unix_s) const;

  const UpkeepSettings settings_;
  const double start_unix_s_;
  std::map<std::string, Vehicle> vehicles_;
};

}  // namespace telltale
