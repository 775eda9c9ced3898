#include "telltale/service/diagnosis/published_diagnoses.hpp"

#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/idl/codec/wire/diagnosis.hpp"

namespace telltale {

PublishedDiagnoses::PublishedDiagnoses(const Participant& participant, DiagnosisStore store)
    : store_(std::move(store)), writer_(participant) {}

void PublishedDiagnoses::BeginPublishing(const Fleet& fleet) {
  publishing_ = true;
  for (const auto& [vehicle_id, window] : fleet.windows()) Serve(vehicle_id);
}

void PublishedDiagnoses::Learn(const PublishedDiagnosis& diagnosis) {
  const std::lock_guard lock(mutex_);
  store_.Save(diagnosis);
}

bool PublishedDiagnoses::LearnEarlier(const PublishedDiagnosis& diagnosis) {
  const std::lock_guard lock(mutex_);
  return store_.SaveEarlier(diagnosis);
}

void PublishedDiagnoses::Serve(const std::string& vehicle_id) {
  if (!publishing_) return;
  const std::lock_guard lock(mutex_);
  if (const auto last = store_.Last(vehicle_id)) Announce(*last);
}

void PublishedDiagnoses::Publish(const PublishedDiagnosis& diagnosis) {
  const std::lock_guard lock(mutex_);
  store_.Save(diagnosis);
  Announce(diagnosis);
}

std::vector<PublishedDiagnosis> PublishedDiagnoses::History(std::string_view vehicle_id) const {
  const std::lock_guard lock(mutex_);
  return store_.History(vehicle_id);
}

std::vector<PublishedDiagnosis> PublishedDiagnoses::Earlier(std::string_view vehicle_id,
                                                            double before_unix_s,
                                                            std::size_t limit) const {
  std::vector<PublishedDiagnosis> diagnoses = History(vehicle_id);
  if (before_unix_s > 0.0) {
    std::erase_if(diagnoses, [&](const PublishedDiagnosis& diagnosis) {
      return diagnosis.published_unix_s >= before_unix_s;
    });
  }
  if (diagnoses.size() > limit) {
    diagnoses.erase(diagnoses.begin() + static_cast<std::ptrdiff_t>(limit), diagnoses.end());
  }
  return diagnoses;
}

void PublishedDiagnoses::Announce(const PublishedDiagnosis& diagnosis) {
  const std::string& vehicle_id = diagnosis.diagnosis.vehicle_id;
  spdlog::info("diagnosis of {}: {}", vehicle_id, diagnosis.diagnosis.sentence);
  try {
    if (!writer_.Write(Encode(diagnosis))) {
      spdlog::warn("a stalled client blocks the diagnosis of {}", vehicle_id);
    }
  } catch (const BusError& error) {
    spdlog::error("the diagnosis of {} is saved but not published: {}", vehicle_id, error.what());
  }
}

}  // namespace telltale
