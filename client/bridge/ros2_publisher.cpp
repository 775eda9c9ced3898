#include "telltale/client/bridge/ros2_publisher.hpp"

#include <chrono>
#include <utility>

#include "telltale/client/bridge/ros2_names.hpp"
#include "telltale/idl/codec/json/published.hpp"

namespace telltale {
namespace {

constexpr double kDaemonSilentS = 10.0;
constexpr const char* kDiagnosticsTopic = "rt/diagnostics";

std::string ModelTopicOf(const std::string& vehicle_id) {
  return "rt/telltale/" + RosNameOf(vehicle_id) + "/model";
}

}  // namespace

Ros2Publisher::Ros2Publisher(const Participant& ros, const Participant& bus, Report report)
    : ros_(ros),
      report_(std::move(report)),
      diagnostics_(ros, kDiagnosticsTopic, RosStatusQos()),
      wait_set_(bus),
      model_subscription_(
          bus, wait_set_, [this](const PublishedModel& model) { Publish(model); },
          [this](const CodecError& error) { report_("a model is rejected: " + error.Message()); }),
      quality_subscription_(
          bus, wait_set_,
          [this](const Quality& quality) {
            if (quality.vehicle_id != kUnattributed) boats_[quality.vehicle_id] = {quality, now_s_};
          },
          [this](const CodecError& error) {
            report_("a quality is rejected: " + error.Message());
          }) {}

void Ros2Publisher::EachSecond(double now_s) {
  now_s_ = now_s;
  while (wait_set_.Wait(std::chrono::nanoseconds(0))) {
  }
  if (boats_.empty()) return;
  diagnostics_.Write(EncodeRosDiagnostics(Boats(), now_s));
}

void Ros2Publisher::Publish(const PublishedModel& model) {
  const std::string& id = model.identification.vehicle_id;
  const auto [writer, is_new] = models_.try_emplace(id, ros_, ModelTopicOf(id), RosLatchedQos());
  if (is_new) report_("models of " + id + " go to " + ModelTopicOf(id).substr(2));
  if (!writer->second.Write(EncodeRosString(PrintModelJson(model)))) {
    report_("a model of " + id + " is not taken by a stalled subscriber");
  }
}

std::vector<Quality> Ros2Publisher::Boats() const {
  std::vector<Quality> boats;
  for (const auto& [id, boat] : boats_) {
    boats.push_back(boat.quality);
    if (now_s_ - boat.heard_s <= kDaemonSilentS) continue;
    Quality& silent = boats.back();
    silent.verdict = QualityVerdict::kStale;
    silent.reasons.insert(silent.reasons.begin(),
                          {"DAEMON_SILENT", QualityVerdict::kStale,
                           "the daemon says nothing for " +
                               std::to_string(static_cast<int>(now_s_ - boat.heard_s)) + " s"});
  }
  return boats;
}

}  // namespace telltale
