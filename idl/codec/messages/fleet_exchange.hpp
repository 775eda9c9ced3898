#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/core/validation/promotion.hpp"
#include "telltale/core/vessel/model_structure.hpp"
#include "telltale/idl/codec/fleet_slices.hpp"
#include "telltale/idl/codec/messages/diagnosis.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"
#include "telltale/idl/codec/messages/model.hpp"

namespace telltale {

/// kList: the vehicles served. kHistory: a vehicle's models. kModels and kDiagnoses: its
/// models and its diagnoses in full, for a daemon that stands by. kRollback: an earlier model
/// published again. kRefresh: identifies many vehicles. kFollow: the progress and the reply of a
/// refresh that another request began. kCancel: ends a request of any kind.
enum class FleetCommand {
  kUnknown,
  kList,
  kHistory,
  kModels,
  kDiagnoses,
  kRollback,
  kRefresh,
  kFollow,
  kCancel
};

inline constexpr std::array kFleetCommands = {FleetCommand::kList,     FleetCommand::kHistory,
                                              FleetCommand::kModels,   FleetCommand::kDiagnoses,
                                              FleetCommand::kRollback, FleetCommand::kRefresh,
                                              FleetCommand::kFollow,   FleetCommand::kCancel};

std::string_view Name(FleetCommand command);

/// Asks the daemon for what concerns several vehicles or their earlier models.
struct FleetRequest {
  std::string correlation_id;  ///< as in ExchangeRequest
  FleetCommand command = FleetCommand::kUnknown;
  std::vector<std::string> vehicle_ids;  ///< of kRefresh any number, of others one
  bool all = false;                      ///< of kRefresh: every vehicle that is served
  std::uint64_t revision = 0;            ///< of kRollback; of kModels: only later ones
  /// Of kRefresh: only vehicles without a model, or whose model has a worse verdict. Unknown: any.
  PromotionVerdict worse_than = PromotionVerdict::kUnknown;
  double older_than_s = 0.0;   ///< of kRefresh: only vehicles without a model, or an older one
  std::string target;          ///< of kFollow and kCancel: the correlation id of another request
  double deadline_s = 0.0;     ///< as in ExchangeRequest
  double before_unix_s = 0.0;  ///< of kDiagnoses: only those published earlier; 0: any
};

struct VehicleSummary {
  std::string vehicle_id;
  double window_s = 0.0;       ///< time span of the window
  double window_fill = 0.0;    ///< share of the configured span, [0, 1]
  std::uint64_t revision = 0;  ///< of the newest model; 0: there is none
  double model_age_s = 0.0;
  Promotion promotion;  ///< of that model

  bool operator==(const VehicleSummary&) const = default;
};

struct ModelSummary {
  std::uint64_t revision = 0;
  double published_unix_s = 0.0;
  std::string structure;  ///< by its name, which may be one that this program does not know
  std::string estimator;  ///< likewise
  double window_start_s = 0.0;
  double window_end_s = 0.0;
  std::uint64_t window_samples = 0;
  Promotion promotion;

  bool operator==(const ModelSummary&) const = default;
};

enum class RefreshState {
  kUnknown,
  kWaiting,
  kRunning,
  kPublished,
  kUnchanged,  ///< no telemetry since its model was made
  kRefused,
  kFailed,
  kCancelled,
};

inline constexpr std::array kRefreshStates = {RefreshState::kWaiting,   RefreshState::kRunning,
                                              RefreshState::kPublished, RefreshState::kUnchanged,
                                              RefreshState::kRefused,   RefreshState::kFailed,
                                              RefreshState::kCancelled};

std::string_view Name(RefreshState state);

/// Whether nothing follows this state.
bool IsFinal(RefreshState state);

struct RefreshedVehicle {
  std::string vehicle_id;
  RefreshState state = RefreshState::kUnknown;
  std::uint64_t revision = 0;                             ///< when published
  PromotionVerdict verdict = PromotionVerdict::kUnknown;  ///< likewise
  std::string reason;                                     ///< why not, or why with this verdict

  bool operator==(const RefreshedVehicle&) const = default;
};

/// The progress of a refresh.
struct FleetProgress {
  std::string correlation_id;
  std::uint32_t total = 0;                 ///< vehicles
  std::vector<RefreshedVehicle> vehicles;  ///< whose state has changed
};

struct FleetReply : ExchangeReply {         // of no vehicle: its vehicle_id is empty
  std::vector<VehicleSummary> vehicles;     ///< of kList
  std::vector<ModelSummary> models;         ///< of kHistory, newest first; of kRollback the new one
  std::vector<RefreshedVehicle> refreshed;  ///< of kRefresh and kFollow: all
  std::vector<PublishedModel> later_models;  ///< of kModels, oldest first, kModelsAtATime at most
  /// Of kDiagnoses, newest first, kDiagnosesAtATime at most.
  std::vector<PublishedDiagnosis> earlier_diagnoses;
  SliceSet slices = 0;  ///< whose boats the daemon answers for; 0: all, of an older daemon
};

inline constexpr std::size_t kModelsAtATime = 16;    ///< some 30 kB each
inline constexpr std::size_t kDiagnosesAtATime = 4;  ///< some 100 kB each

}  // namespace telltale
