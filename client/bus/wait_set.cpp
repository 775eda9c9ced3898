#include "telltale/client/bus/wait_set.hpp"

#include <algorithm>
#include <array>

#include "telltale/client/bus/bus_error.hpp"

namespace telltale {

WaitSet::WaitSet(const Participant& participant)
    : guard_(
          Checked(dds_create_guardcondition(participant.handle()), "creating a guard condition")),
      wait_set_(Checked(dds_create_waitset(participant.handle()), "creating a wait set")) {
  Checked(dds_waitset_attach(wait_set_.handle(), guard_.handle(), 0),
          "attaching a guard condition");
}

void WaitSet::Attach(const Endpoint& endpoint, std::function<void()> on_data) {
  const auto& attachment = attachments_.emplace_back(
      std::make_unique<Attachment>(endpoint.handle(), std::move(on_data)));
  Checked(dds_waitset_attach(wait_set_.handle(), endpoint.handle(),
                             reinterpret_cast<dds_attach_t>(attachment.get())),
          "attaching to a wait set");
}

void WaitSet::Detach(const Endpoint& endpoint) {
  Checked(dds_waitset_detach(wait_set_.handle(), endpoint.handle()), "detaching from a wait set");
  std::erase_if(attachments_,
                [&](const auto& attachment) { return attachment->endpoint == endpoint.handle(); });
}

bool WaitSet::Wait(std::chrono::nanoseconds timeout) {
  std::array<dds_attach_t, 32> triggered{};
  const dds_duration_t at_most = std::max<dds_duration_t>(timeout.count(), 0);
  const auto count = Checked(
      dds_waitset_wait(wait_set_.handle(), triggered.data(), triggered.size(), at_most), "waiting");
  bool has_data = false;
  for (std::int32_t i = 0; i < std::min<std::int32_t>(count, triggered.size()); ++i) {
    if (triggered[i] == 0) {
      bool woken = false;
      Checked(dds_take_guardcondition(guard_.handle(), &woken), "resetting a guard condition");
    } else {
      reinterpret_cast<Attachment*>(triggered[i])->on_data();
      has_data = true;
    }
  }
  return has_data;
}

void WaitSet::Wake() {
  Checked(dds_set_guardcondition(guard_.handle(), true), "waking a wait set");
}

}  // namespace telltale
