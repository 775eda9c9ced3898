#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/models/published_models.hpp"
#include "telltale/service/monitoring/fleet_view.hpp"
#include "telltale/service/upkeep/upkeep_rules.hpp"

namespace telltale {

/// Does by itself what the configuration asks for: it considers every vehicle once a second, on a
/// thread of its own, and asks for diagnoses and refreshes, or advises the latter.
class Upkeep {
 public:
  struct Orders {
    std::function<void(const std::vector<std::string>& vehicle_ids)> refresh;
    std::function<void(const std::string& vehicle_id)> diagnose;
  };

  Upkeep(const UpkeepSettings& settings, const Fleet& fleet, const PublishedModels& models,
         FleetView& view, Orders orders);
  Upkeep(const Upkeep&) = delete;
  Upkeep& operator=(const Upkeep&) = delete;
  ~Upkeep();  ///< ends the thread

 private:
  void Run();
  void Look();
  UpkeepFacts FactsOf(const std::string& vehicle_id, VehicleWindow& window) const;
  void Advise(const std::string& vehicle_id, std::uint64_t revision, const std::string& reason);

  const RefreshMode refresh_;
  const Fleet& fleet_;
  const PublishedModels& models_;
  FleetView& view_;
  const Orders orders_;
  UpkeepRules rules_;  // of the thread

  std::mutex mutex_;  // of stopping_
  std::condition_variable wake_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace telltale
