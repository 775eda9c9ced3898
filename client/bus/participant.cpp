#include "telltale/client/bus/participant.hpp"

#include <string>

#include "telltale/client/bus/bus_error.hpp"

namespace telltale {

Participant::Participant(std::uint32_t domain)
    : entity_(Checked(dds_create_participant(domain, nullptr, nullptr),
                      "joining DDS domain " + std::to_string(domain))) {}

}  // namespace telltale
