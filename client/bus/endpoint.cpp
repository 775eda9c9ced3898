#include "telltale/client/bus/endpoint.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "telltale/client/bus/bus_error.hpp"
#include "telltale/client/bus/wait_set.hpp"

namespace telltale {
namespace {

/// Lets wait sets see connections come and go on an endpoint, for as long as it lives.
class MatchStatusEnabled {
 public:
  explicit MatchStatusEnabled(const Endpoint& endpoint) : handle_(endpoint.handle()) {
    Checked(dds_get_status_mask(handle_, &before_), "reading a status mask");
    Checked(dds_set_status_mask(handle_, before_ | endpoint.match_status()),
            "setting a status mask");
  }
  MatchStatusEnabled(MatchStatusEnabled&& other) noexcept
      : handle_(std::exchange(other.handle_, 0)), before_(other.before_) {}
  MatchStatusEnabled& operator=(MatchStatusEnabled&&) = delete;
  ~MatchStatusEnabled() {
    if (handle_ > 0) dds_set_status_mask(handle_, before_);
  }

 private:
  dds_entity_t handle_;
  std::uint32_t before_ = 0;
};

}  // namespace

Endpoint::Endpoint(const Participant& participant, Kind kind, const dds_topic_descriptor_t& type,
                   const char* topic, const dds_qos_t* qos)
    : Endpoint(participant, kind, MakeTopic(participant, type, topic), topic, qos) {}

Endpoint::Endpoint(const Participant& participant, Kind kind, Entity topic, const std::string& name,
                   const dds_qos_t* qos)
    : kind_(kind),
      topic_(std::move(topic)),
      end_(kind == Kind::kReader
               ? Checked(dds_create_reader(participant.handle(), topic_.handle(), qos, nullptr),
                         "creating a reader of " + name)
               : Checked(dds_create_writer(participant.handle(), topic_.handle(), qos, nullptr),
                         "creating a writer of " + name)) {}

Entity Endpoint::MakeTopic(const Participant& participant, const dds_topic_descriptor_t& type,
                           const char* topic) {
  return Entity(Checked(dds_create_topic(participant.handle(), &type, topic, nullptr, nullptr),
                        std::string("creating topic ") + topic));
}

std::uint32_t Endpoint::Matched() const {
  if (kind_ == Kind::kReader) {
    dds_subscription_matched_status_t status;
    Checked(dds_get_subscription_matched_status(handle(), &status), "asking a reader's matches");
    return status.current_count;
  }
  dds_publication_matched_status_t status;
  Checked(dds_get_publication_matched_status(handle(), &status), "asking a writer's matches");
  return status.current_count;
}

std::vector<std::string> Endpoint::PartitionsOf(WriterHandle writer) const {
  dds_builtintopic_endpoint_t* const endpoint = dds_get_matched_publication_data(handle(), writer);
  if (endpoint == nullptr) return {};
  std::uint32_t count = 0;
  char** names = nullptr;
  dds_qget_partition(endpoint->qos, &count, &names);
  std::vector<std::string> partitions(names, names + count);
  for (std::uint32_t i = 0; i < count; ++i) dds_string_free(names[i]);
  dds_free(names);
  dds_builtintopic_free_endpoint(endpoint);
  return partitions;
}

std::set<WriterHandle> Endpoint::Writers() const {
  constexpr std::size_t kThatCameMeanwhile = 16;
  std::vector<dds_instance_handle_t> writers(Matched() + kThatCameMeanwhile);
  const auto count = static_cast<std::size_t>(
      Checked(dds_get_matched_publications(handle(), writers.data(), writers.size()),
              "asking for the writers of a reader"));
  writers.resize(std::min(count, writers.size()));
  return {writers.begin(), writers.end()};
}

bool WaitForMatch(const Participant& participant,
                  const std::vector<std::reference_wrapper<const Endpoint>>& endpoints,
                  std::chrono::nanoseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  WaitSet waiting(participant);
  std::vector<MatchStatusEnabled> enabled;
  for (const Endpoint& endpoint : endpoints) {
    enabled.emplace_back(endpoint);
    waiting.Attach(endpoint, [] {});
  }
  const auto matched = [](const Endpoint& endpoint) { return endpoint.Matched() > 0; };
  while (!std::ranges::all_of(endpoints, matched)) {
    const auto left = deadline - std::chrono::steady_clock::now();
    if (left <= left.zero()) return false;
    waiting.Wait(left);
  }
  return true;
}

}  // namespace telltale
