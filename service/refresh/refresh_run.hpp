#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/idl/codec/messages/fleet_exchange.hpp"

namespace telltale {

/// The state of one refresh of many vehicles. Not thread safe.
class RefreshRun {
 public:
  using Clock = std::chrono::steady_clock;

  /// All of these vehicles wait. `slices`: whose boats it is about, where others share the fleet.
  RefreshRun(std::string correlation_id, const std::vector<std::string>& vehicle_ids,
             SliceSet slices = kAllSlices);

  const std::string& correlation_id() const { return correlation_id_; }
  SliceSet slices() const { return slices_; }
  const std::vector<RefreshedVehicle>& vehicles() const { return vehicles_; }
  bool finished() const { return unfinished_ == 0; }
  std::size_t running() const { return running_; }
  double ElapsedS() const;

  /// The first vehicle that waits, or null.
  const RefreshedVehicle* NextWaiting() const;

  /// Takes in the new state of one of the vehicles, which may have to wait again. A final state
  /// stays.
  void Update(const RefreshedVehicle& vehicle);

  /// Takes those that wait as cancelled.
  void CancelWaiting();

  /// The vehicles whose state has changed since the last call.
  std::vector<RefreshedVehicle> TakeChanges();

  /// The requests that get its progress and its reply, besides its own.
  void AddFollower(const std::string& correlation_id) { followers_.insert(correlation_id); }
  const std::set<std::string>& followers() const { return followers_; }

 private:
  std::string correlation_id_;
  SliceSet slices_;
  std::vector<RefreshedVehicle> vehicles_;
  std::map<std::string, std::size_t, std::less<>> places_;  ///< by vehicle id
  std::size_t next_waiting_ = 0;                            ///< no vehicle before this place waits
  std::size_t unfinished_;
  std::size_t running_ = 0;
  std::set<std::string> changed_;
  std::set<std::string> followers_;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point ended_ = begun_;
};

}  // namespace telltale
