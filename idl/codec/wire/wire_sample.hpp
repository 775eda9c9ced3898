#pragma once

#include <string_view>
#include <utility>

#include <dds/dds.h>

#include "telltale/idl/dds/telltale.h"

namespace telltale {

/// The descriptor idlc generated for a wire type.
template <class Wire>
const dds_topic_descriptor_t& Descriptor();

template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_GnssFix>() {
  return telltale_wire_GnssFix_desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_Heading>() {
  return telltale_wire_Heading_desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_Thrusters>() {
  return telltale_wire_Thrusters_desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_VehicleAnnouncement>() {
  return telltale_wire_VehicleAnnouncement_desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_Model>() {
  return telltale_wire_Model_desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_IdentifyRequest>() {
  return telltale_wire_IdentifyRequest_desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_IdentifyProgress>() {
  return telltale_wire_IdentifyProgress_desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_IdentifyReply>() {
  return telltale_wire_IdentifyReply_desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_Diagnosis>() {
  return telltale_wire_Diagnosis_desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_DiagnoseRequest>() {
  return telltale_wire_DiagnoseRequest_desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_DiagnoseProgress>() {
  return telltale_wire_DiagnoseProgress_desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_DiagnoseReply>() {
  return telltale_wire_DiagnoseReply_desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_FleetRequest>() {
  return telltale_wire_FleetRequest_desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_FleetProgress>() {
  return telltale_wire_FleetProgress_desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_FleetReply>() {
  return telltale_wire_FleetReply_desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_Quality>() {
  return telltale_wire_Quality_desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<telltale_wire_DaemonStatus>() {
  return telltale_wire_DaemonStatus_desc;
}

/// Owns one generated C struct and everything it points to: strings and sequences are allocated
/// with dds_alloc and dds_string_dup, and go when it goes.
template <class Wire>
class WireSample {
 public:
  WireSample() = default;
  WireSample(WireSample&& other) noexcept : value_(std::exchange(other.value_, Wire{})) {}
  WireSample& operator=(WireSample&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~WireSample() { dds_sample_free(&value_, &Descriptor<Wire>(), DDS_FREE_CONTENTS); }

  Wire* operator->() { return &value_; }
  const Wire* operator->() const { return &value_; }
  Wire& operator*() { return value_; }
  const Wire& operator*() const { return value_; }

 private:
  Wire value_{};
};

}  // namespace telltale
