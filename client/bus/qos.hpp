#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <dds/dds.h>

namespace telltale {

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, QosDeleter>;

/// The contracts of the topics, one function each, the same for readers and writers.

/// Best effort, volatile, keep last 64 per vehicle: a reader of this matches any writer, and a
/// stalled reader can hold up no boat. At most kMostBoats vehicle ids: each costs some kilobytes,
/// and anybody can invent them.
Qos TelemetryQos();

inline constexpr std::int32_t kMostBoats = 5000;

/// Reliable, transient local, keep last 1 per vehicle: a daemon that starts later hears of a boat
/// that announces itself. A boat that leaves is not retired by that.
Qos VehicleQos();

/// Reliable, volatile, keep last 64 per vehicle. A write gives up after 100 ms: one stalled client
/// must not keep the daemon from the others, and a client that missed something asks again.
Qos RequestReplyQos();

/// Reliable, transient local, keep last 1, exclusive ownership. Liveliness is asserted by hand
/// within kModelLease, so that a daemon that hangs loses its vehicles to a standby as one that died
/// does. A writer's end does not dispose of its models.
Qos ModelQos();

/// Reliable, transient local, keep last 1 per vehicle: who joins late is given the last diagnosis.
Qos DiagnosisQos();

/// Best effort, volatile, keep last 1 per vehicle.
Qos QualityQos();

/// Reliable, transient local, keep last 1 per daemon. Liveliness as of ModelQos().
Qos DaemonStatusQos();

/// The contract of a writer that asserts its liveliness within `lease`, at most kModelLease.
Qos WithLease(Qos qos, std::chrono::nanoseconds lease);

/// The contract of a writer whose samples hide those of weaker writers while it is alive.
Qos WithOwnershipStrength(Qos qos, std::int32_t strength);

/// The contract of a writer or reader in these partitions; "" is that of all who name none.
Qos InPartitions(Qos qos, const std::vector<std::string>& partitions);

/// The contract of a reader that is given the samples of other participants alone.
Qos FromOthers(Qos qos);

/// Topics of ROS 2. Sensors: best effort and volatile, keep last 64, which reads either kind of
/// publisher. Status: reliable and volatile, as its tools ask for. Latched: reliable and transient
/// local, keep last 1.
Qos RosSensorQos();
Qos RosStatusQos();
Qos RosLatchedQos();

inline constexpr dds_duration_t kModelLease = DDS_SECS(5);

}  // namespace telltale
