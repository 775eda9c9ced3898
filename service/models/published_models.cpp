#include "telltale/service/models/published_models.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/client/fleet/unix_now.hpp"
#include "telltale/idl/codec/wire/model.hpp"
#include "telltale/service/models/predecessor.hpp"

namespace telltale {
namespace {

void LogChange(const PublishedModel& model) {
  const auto& change = model.identification.provenance.change;
  if (!change) return;
  const auto level =
      change->verdict == ChangeVerdict::kChanged ? spdlog::level::warn : spdlog::level::info;
  spdlog::log(level, "revision {} of {} {}", model.revision, model.identification.vehicle_id,
              InWords(*change));
}

void LogVerdict(const PublishedModel& model) {
  const Promotion& promotion = model.promotion;
  if (promotion.verdict == PromotionVerdict::kOk || promotion.reason.empty()) return;
  spdlog::warn("revision {} of {} is published with verdict {}: {}", model.revision,
               model.identification.vehicle_id, Name(promotion.verdict), promotion.reason);
}

}  // namespace

PublishedModels::PublishedModels(const Participant& participant, ModelStore store,
                                 const Fleet& fleet, const Role& role)
    : participant_(participant),
      role_(role),
      store_(std::move(store)),
      rival_reader_(participant, FromOthers(ModelQos())) {
  for (const auto& [vehicle_id, window] : fleet.windows()) Serve(vehicle_id);
}

void PublishedModels::BeginPublishing(const Qos& contract) {
  const std::lock_guard lock(mutex_);
  writer_.emplace(participant_, contract);
  publishing_ = true;
  for (const auto& [vehicle_id, stored] : latest_) Announce(stored.model);
}

void PublishedModels::Serve(const std::string& vehicle_id) {
  const std::lock_guard lock(mutex_);
  auto stored = store_.Latest(vehicle_id);
  if (!stored) return;
  Announce(stored->model);
  latest_.insert_or_assign(vehicle_id, std::move(*stored));
}

void PublishedModels::Withdraw(const std::string& vehicle_id) {
  const std::lock_guard lock(mutex_);
  const auto published = latest_.find(vehicle_id);
  if (published == latest_.end()) return;
  if (publishing_) writer_->Unregister(Encode(published->second.model));
  blocked_.erase(vehicle_id);
  latest_.erase(published);
}

PublishedModel PublishedModels::Publish(Identification identification,
                                        const std::optional<FreeRunError>& reference_error,
                                        const Promotion& promotion) {
  const std::lock_guard lock(mutex_);
  RequireRole();
  identification.provenance.change = ChangeSincePredecessor(store_, identification);
  const StoredModel stored = written_.Count(
      [&] { return store_.Save(identification, UnixNow(), reference_error, promotion); });
  latest_.insert_or_assign(identification.vehicle_id, stored);
  Announce(stored.model);
  LogVerdict(stored.model);
  LogChange(stored.model);
  return stored.model;
}

std::optional<PublishedModel> PublishedModels::Rollback(const std::string& vehicle_id,
                                                        std::uint64_t revision) {
  const std::lock_guard lock(mutex_);
  RequireRole();
  return PublishAgain(vehicle_id, revision);
}

void PublishedModels::Learn(const StoredModel& model) {
  const std::lock_guard lock(mutex_);
  const std::string& vehicle_id = model.model.identification.vehicle_id;
  const std::uint64_t revision = model.model.revision;
  const auto own = latest_.find(vehicle_id);
  const std::uint64_t newest = own == latest_.end() ? 0 : own->second.model.revision;
  if (revision < newest) return;
  if (revision == newest) {
    if (own->second.model.published_unix_s == model.model.published_unix_s) return;
    spdlog::error("two daemons have published a revision {} of {}", revision, vehicle_id);
    if (role_.Serves()) {
      PublishAgain(vehicle_id, revision);
      return;
    }
  }
  store_.Keep(model);
  latest_.insert_or_assign(vehicle_id, model);
  spdlog::info("revision {} of {} is kept as another daemon has published it", revision,
               vehicle_id);
  Announce(model.model);
}

void PublishedModels::LearnEarlier(const PublishedModel& model) {
  const std::lock_guard lock(mutex_);
  const auto own = store_.PublishedUnixS(model.identification.vehicle_id, model.revision);
  if (own == model.published_unix_s) return;
  if (own) {
    spdlog::warn("revision {} of {} gives way to that which another daemon has published",
                 model.revision, model.identification.vehicle_id);
  }
  store_.Keep({model, {}});
}

std::optional<std::uint64_t> PublishedModels::HoleAfter(std::string_view vehicle_id) const {
  const std::lock_guard lock(mutex_);
  const auto revisions = store_.Revisions(vehicle_id);
  if (revisions.empty()) return std::nullopt;
  std::uint64_t complete_to = revisions.back() - std::min(revisions.back(), kModelsPerVehicle);
  for (const std::uint64_t revision : revisions) {
    if (revision <= complete_to) continue;
    if (revision != complete_to + 1) return complete_to;
    complete_to = revision;
  }
  return std::nullopt;
}

std::vector<PublishedModel> PublishedModels::Later(std::string_view vehicle_id, std::uint64_t after,
                                                   std::size_t limit) const {
  const std::lock_guard lock(mutex_);
  std::vector<PublishedModel> later;
  store_.Newest(vehicle_id, [&](const StoredModel& stored) {
    if (stored.model.revision <= after) return true;
    later.push_back(stored.model);
    return false;
  });
  std::ranges::reverse(later);
  if (later.size() > limit)
    later.erase(later.begin() + static_cast<std::ptrdiff_t>(limit), later.end());
  return later;
}

std::optional<PublishedModel> PublishedModels::PublishAgain(const std::string& vehicle_id,
                                                            std::uint64_t revision) {
  const auto earlier = store_.Newest(vehicle_id, [revision](const StoredModel& stored) {
    return stored.model.revision == revision;
  });
  if (!earlier) return std::nullopt;
  Promotion promotion = earlier->model.promotion;
  promotion.reason = "revision " + std::to_string(revision) + " published again" +
                     (promotion.reason.empty() ? "" : "; " + promotion.reason);
  const StoredModel stored = written_.Count([&] {
    return store_.Save(earlier->model.identification, UnixNow(), earlier->reference_error,
                       promotion, revision);
  });
  latest_.insert_or_assign(vehicle_id, stored);
  spdlog::info("{}: revision {} is published again as revision {}", vehicle_id, revision,
               stored.model.revision);
  Announce(stored.model);
  return stored.model;
}

std::optional<PublishedModel> PublishedModels::NewestSound(std::string_view vehicle_id) const {
  const std::lock_guard lock(mutex_);
  auto stored = store_.Newest(vehicle_id, [](const StoredModel& model) {
    return model.model.promotion.verdict <= PromotionVerdict::kOk;
  });
  if (!stored) return std::nullopt;
  return std::move(stored->model);
}

std::vector<StoredModel> PublishedModels::History(std::string_view vehicle_id) const {
  const std::lock_guard lock(mutex_);
  return store_.History(vehicle_id);
}

std::optional<StoredModel> PublishedModels::Latest(std::string_view vehicle_id) const {
  const std::lock_guard lock(mutex_);
  const auto found = latest_.find(vehicle_id);
  if (found == latest_.end()) return std::nullopt;
  return found->second;
}

std::vector<StoredModel> PublishedModels::History(std::string_view vehicle_id, std::uint64_t before,
                                                  std::size_t limit) const {
  std::vector<StoredModel> history;
  if (limit == 0) return history;
  const std::lock_guard lock(mutex_);
  store_.Newest(vehicle_id, [&](const StoredModel& stored) {
    if (stored.model.revision < before) history.push_back(stored);
    return history.size() == limit;
  });
  return history;
}

bool PublishedModels::AwaitReceipt(std::chrono::nanoseconds timeout) {
  return !publishing_ || writer_->AwaitReceipt(timeout);
}

void PublishedModels::AssertLiveliness() {
  if (publishing_ && role_.Serves()) writer_->AssertLiveliness();
}

void PublishedModels::RequireRole() const {
  if (!role_.Serves()) throw std::runtime_error("this daemon does not serve; another may");
}

void PublishedModels::WatchForRivals() {
  const std::uint32_t others = rival_reader_.AliveWriters();
  const std::uint32_t expected = role_.Serves() ? 0 : 1;
  const std::uint32_t rivals = others > expected ? others - expected : 0;
  if (std::exchange(rivals_, rivals) == rivals) return;
  if (rivals == 0) {
    spdlog::info("this daemon alone publishes models on the domain again");
    return;
  }
  spdlog::error(
      "{} other participants publish models on this domain: another telltaled, whose revisions "
      "part from these, or a forger; stop it, or let DDS Security keep it out",
      rivals);
}

void PublishedModels::PublishBlocked() {
  const std::lock_guard lock(mutex_);
  for (const std::string& vehicle_id : std::exchange(blocked_, {})) {
    Announce(latest_.find(vehicle_id)->second.model);
  }
}

void PublishedModels::Announce(const PublishedModel& model) {
  if (!publishing_ || !role_.Serves()) return;
  const std::string& vehicle_id = model.identification.vehicle_id;
  try {
    if (writer_->Write(Encode(model))) {
      spdlog::info("published revision {} of {}", model.revision, vehicle_id);
      return;
    }
    spdlog::warn("a stalled client blocks revision {} of {}", model.revision, vehicle_id);
  } catch (const BusError& error) {
    spdlog::error("revision {} of {} is saved but not published: {}", model.revision, vehicle_id,
                  error.what());
  }
  blocked_.insert(vehicle_id);
}

}  // namespace telltale
