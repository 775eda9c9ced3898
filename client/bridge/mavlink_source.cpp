#include "telltale/client/bridge/mavlink_source.hpp"

#include <utility>

namespace telltale {

MavlinkSource::MavlinkSource(const Participant& participant, const MavlinkAddress& address,
                             MavlinkBridgeOptions options, Report report)
    : report_(std::move(report)),
      link_(address),
      bridge_(
          participant, std::move(options),
          [this](const std::string& sender, auto bytes) { link_.Send(sender, bytes); }, report_) {}

void MavlinkSource::Run(const std::function<void()>& second) {
  link_.Run({[this](const std::string& sender, auto bytes, bool whole) {
               bridge_.Receive(sender, bytes, whole, clock_.Now());
             },
             [&] {
               bridge_.EachSecond(clock_.Now());
               second();
             },
             report_});
}

}  // namespace telltale
