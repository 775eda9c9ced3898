#include "telltale/client/bus/qos.hpp"

namespace telltale {
namespace {

constexpr dds_duration_t kLongestWriteBlock = DDS_MSECS(100);
constexpr std::int32_t kHistoryDepth = 64;

Qos MakeQos(dds_reliability_kind_t reliability, std::int32_t depth) {
  Qos qos(dds_create_qos());
  dds_qset_reliability(qos.get(), reliability, kLongestWriteBlock);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  return qos;
}

}  // namespace

Qos TelemetryQos() {
  Qos qos = MakeQos(DDS_RELIABILITY_BEST_EFFORT, kHistoryDepth);
  dds_qset_resource_limits(qos.get(), DDS_LENGTH_UNLIMITED, kMostBoats, DDS_LENGTH_UNLIMITED);
  return qos;
}

Qos VehicleQos() {
  Qos qos = DiagnosisQos();
  dds_qset_writer_data_lifecycle(qos.get(), false);
  return qos;
}

Qos RequestReplyQos() {
  return MakeQos(DDS_RELIABILITY_RELIABLE, kHistoryDepth);
}

Qos DiagnosisQos() {
  Qos qos = MakeQos(DDS_RELIABILITY_RELIABLE, 1);
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, 1, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  return qos;
}

Qos ModelQos() {
  Qos qos = DiagnosisQos();
  dds_qset_ownership(qos.get(), DDS_OWNERSHIP_EXCLUSIVE);
  dds_qset_liveliness(qos.get(), DDS_LIVELINESS_MANUAL_BY_TOPIC, kModelLease);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  return qos;
}

Qos QualityQos() {
  return MakeQos(DDS_RELIABILITY_BEST_EFFORT, 1);
}

Qos DaemonStatusQos() {
  return WithLease(DiagnosisQos(), std::chrono::nanoseconds(kModelLease));
}

Qos WithLease(Qos qos, std::chrono::nanoseconds lease) {
  dds_qset_liveliness(qos.get(), DDS_LIVELINESS_MANUAL_BY_TOPIC, lease.count());
  return qos;
}

Qos WithOwnershipStrength(Qos qos, std::int32_t strength) {
  dds_qset_ownership_strength(qos.get(), strength);
  return qos;
}

Qos InPartitions(Qos qos, const std::vector<std::string>& partitions) {
  std::vector<const char*> names;
  for (const std::string& partition : partitions) names.push_back(partition.c_str());
  dds_qset_partition(qos.get(), static_cast<std::uint32_t>(names.size()), names.data());
  return qos;
}

Qos FromOthers(Qos qos) {
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return qos;
}

Qos RosSensorQos() {
  return MakeQos(DDS_RELIABILITY_BEST_EFFORT, kHistoryDepth);
}

Qos RosStatusQos() {
  return MakeQos(DDS_RELIABILITY_RELIABLE, kHistoryDepth);
}

Qos RosLatchedQos() {
  return DiagnosisQos();
}

}  // namespace telltale
