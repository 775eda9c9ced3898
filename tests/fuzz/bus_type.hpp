#pragma once

#include <sys/uio.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <dds/dds.h>

#include <dds/ddsi/ddsi_serdata.h>

#include "insist.hpp"
#include "telltale/idl/codec/wire/wire_sample.hpp"

namespace telltale {

/// A participant of a domain that no other process can reach.
inline dds_entity_t LonelyParticipant() {
  static const dds_entity_t participant = [] {
    constexpr dds_domainid_t kDomain = 7;
    const dds_entity_t domain = dds_create_domain(
        kDomain,
        "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces>"
        "<AllowMulticast>false</AllowMulticast></General><Discovery>"
        "<ParticipantIndex>none</ParticipantIndex></Discovery></Domain></CycloneDDS>");
    Insist(domain > 0);
    return dds_create_participant(kDomain, nullptr, nullptr);
  }();
  Insist(participant > 0);
  return participant;
}

/// How the library reads the samples of a type from the bytes that arrive, and writes them.
template <class Wire>
class BusType {
 public:
  static const BusType& Instance() {
    static const BusType type;
    return type;
  }

  /// Hands on the sample in these bytes: four of encapsulation, then its fields. The library
  /// refuses most of what is none, and so does this: false.
  template <class Take>
  bool Read(std::span<const std::uint8_t> bytes, Take take) const {
    constexpr std::size_t kEncapsulation = 4;
    if (bytes.size() < kEncapsulation) return false;
    std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
    copy.resize((copy.size() + 3) / 4 * 4);  // as it is padded on the way
    const ddsrt_iovec_t piece{copy.data(), copy.size()};
    ddsi_serdata* const data = ddsi_serdata_from_ser_iov(type_, SDK_DATA, 1, &piece, copy.size());
    if (data == nullptr) return false;
    WireSample<Wire> sample;
    const bool readable = ddsi_serdata_to_sample(data, &*sample, nullptr, nullptr);
    ddsi_serdata_unref(data);
    if (readable) take(*sample);
    return readable;
  }

  std::string Write(const WireSample<Wire>& sample) const { return Write(*sample); }
  std::string Write(const Wire& sample) const {
    ddsi_serdata* const data = ddsi_serdata_from_sample(type_, SDK_DATA, &sample);
    Insist(data != nullptr);
    std::string bytes(ddsi_serdata_size(data), '\0');
    ddsi_serdata_to_ser(data, 0, bytes.size(), bytes.data());
    ddsi_serdata_unref(data);
    return bytes;
  }

 private:
  /// The library tells its own name of the type with a sample alone.
  BusType() {
    const dds_entity_t participant = LonelyParticipant();
    std::string name = Descriptor<Wire>().m_typename;  // "telltale::wire::Model"
    std::ranges::replace(name, ':', '/');
    const dds_entity_t topic =
        dds_create_topic(participant, &Descriptor<Wire>(), name.c_str(), nullptr, nullptr);
    const dds_entity_t reader = dds_create_reader(participant, topic, nullptr, nullptr);
    const dds_entity_t writer = dds_create_writer(participant, topic, nullptr, nullptr);
    Insist(topic > 0 && reader > 0 && writer > 0);
    Wire empty{};
    ddsi_serdata* data = nullptr;
    dds_sample_info_t info;
    Insist(dds_write(writer, &empty) == DDS_RETCODE_OK);
    Insist(dds_takecdr(reader, &data, 1, &info, DDS_ANY_STATE) == 1);
    type_ = data->type;  // which the topic keeps
    ddsi_serdata_unref(data);
  }

  const ddsi_sertype* type_ = nullptr;
};

}  // namespace telltale
