#include "telltale/client/bus/publication_reader.hpp"

#include <array>
#include <vector>

#include "telltale/client/bus/bus_error.hpp"

namespace telltale {

PublicationReader::PublicationReader(const Participant& participant)
    // The topic is the library's own, which it does not delete.
    : Endpoint(participant, Kind::kReader, Entity(DDS_BUILTIN_TOPIC_DCPSPUBLICATION),
               "publications", nullptr) {
  Checked(dds_set_status_mask(handle(), DDS_DATA_AVAILABLE_STATUS), "setting a status mask");
}

void PublicationReader::Take(const std::function<void(const Publication&)>& discovered) {
  constexpr std::size_t kBatch = 64;
  std::size_t count = kBatch;
  while (count == kBatch) {
    std::array<void*, kBatch> samples{};
    std::array<dds_sample_info_t, kBatch> infos{};
    count = static_cast<std::size_t>(Checked(
        dds_take(handle(), samples.data(), infos.data(), kBatch, kBatch), "taking publications"));
    std::vector<Publication> publications;
    for (std::size_t i = 0; i < count; ++i) {
      if (!infos[i].valid_data || infos[i].instance_state != DDS_ALIVE_INSTANCE_STATE) continue;
      const auto& endpoint = *static_cast<const dds_builtintopic_endpoint_t*>(samples[i]);
      publications.push_back({endpoint.topic_name, endpoint.type_name});
    }
    if (count > 0) {
      dds_return_loan(handle(), samples.data(), static_cast<std::int32_t>(count));
    }
    for (const Publication& publication : publications) discovered(publication);
  }
}

}  // namespace telltale
