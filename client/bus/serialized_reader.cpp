#include "telltale/client/bus/serialized_reader.hpp"

#include <array>
#include <memory>

#include "telltale/client/bus/bus_error.hpp"
#include "telltale/client/bus/serialized_type.hpp"

namespace telltale {
namespace {

constexpr std::size_t kBatch = 256;

struct Unref {
  void operator()(ddsi_serdata* sample) const { ddsi_serdata_unref(sample); }
};

}  // namespace

SerializedReader::SerializedReader(const Participant& participant, const std::string& topic,
                                   const std::string& type, const dds_qos_t* qos)
    : Endpoint(participant, Kind::kReader, SerializedTopic(participant, topic, type), topic, qos) {
  Checked(dds_set_status_mask(handle(), DDS_DATA_AVAILABLE_STATUS), "setting a status mask");
}

void SerializedReader::Take(const Receive& receive) {
  std::array<ddsi_serdata*, kBatch> taken{};
  std::array<dds_sample_info_t, kBatch> infos{};
  for (;;) {
    const auto count = static_cast<std::size_t>(
        Checked(dds_takecdr(handle(), taken.data(), kBatch, infos.data(), DDS_ANY_STATE),
                "taking samples"));
    std::array<std::unique_ptr<ddsi_serdata, Unref>, kBatch> owned;
    for (std::size_t i = 0; i < count; ++i) owned[i].reset(taken[i]);
    for (std::size_t i = 0; i < count; ++i) {
      if (infos[i].valid_data) receive(static_cast<const SerializedSample*>(taken[i])->bytes);
    }
    if (count < kBatch) return;
  }
}

}  // namespace telltale
