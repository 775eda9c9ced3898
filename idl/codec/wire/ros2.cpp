#include "telltale/idl/codec/wire/ros2.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "telltale/core/base/format_number.hpp"
#include "telltale/idl/codec/wire/put.hpp"

namespace telltale {
namespace {

using Values = std::vector<std::pair<std::string, std::string>>;

std::uint8_t LevelOf(QualityVerdict verdict) {
  switch (verdict) {
    case QualityVerdict::kOk: return 0;
    case QualityVerdict::kWarn: return 1;
    case QualityVerdict::kError: return 2;
    case QualityVerdict::kStale:
    case QualityVerdict::kUnknown: break;
  }
  return 3;
}

std::string Percent(double share) {
  return FormatNumber(100.0 * share, 1);
}

Values ValuesOf(const Quality& boat) {
  Values values;
  for (const QualityReason& reason : boat.reasons) values.emplace_back(reason.code, reason.text);
  values.insert(values.end(), {{"positions, Hz", FormatNumber(boat.gnss_rate_hz, 1)},
                               {"headings, Hz", FormatNumber(boat.heading_rate_hz, 1)},
                               {"commands, Hz", FormatNumber(boat.thrusters_rate_hz, 1)},
                               {"window, s", FormatNumber(boat.window_s, 0)},
                               {"lost, %", Percent(boat.loss_share)},
                               {"rejected, %", Percent(boat.reject_share)}});
  if (boat.model_revision) {
    values.emplace_back("model revision", std::to_string(*boat.model_revision));
    values.emplace_back("model age, s", FormatNumber(boat.model_age_s, 0));
    values.emplace_back("error, times the normal error", FormatNumber(boat.prediction_error, 2));
  }
  if (!boat.proposal.empty()) values.emplace_back("proposal", boat.proposal);
  if (!boat.diagnosis_sentence.empty()) values.emplace_back("diagnosis", boat.diagnosis_sentence);
  return values;
}

void PutStatus(diagnostic_msgs_msg_dds__DiagnosticStatus_& status, const Quality& boat) {
  status.level = LevelOf(boat.verdict);
  wire::Put(status.name, "telltale: " + boat.vehicle_id);
  wire::Put(status.message, boat.reasons.empty() ? Name(boat.verdict) : boat.reasons.front().text);
  wire::Put(status.hardware_id, boat.vehicle_id);
  wire::PutSequence(status.values, ValuesOf(boat), [](auto& value, const auto& pair) {
    wire::Put(value.key, pair.first);
    wire::Put(value.value, pair.second);
  });
}

}  // namespace

WireSample<std_msgs_msg_dds__String_> EncodeRosString(std::string_view text) {
  WireSample<std_msgs_msg_dds__String_> message;
  wire::Put(message->data, text);
  return message;
}

WireSample<diagnostic_msgs_msg_dds__DiagnosticArray_> EncodeRosDiagnostics(
    const std::vector<Quality>& boats, double time_unix_s) {
  WireSample<diagnostic_msgs_msg_dds__DiagnosticArray_> message;
  const double seconds = std::floor(time_unix_s);
  message->header.stamp.sec = static_cast<std::int32_t>(seconds);
  message->header.stamp.nanosec = static_cast<std::uint32_t>((time_unix_s - seconds) * 1e9);
  wire::Put(message->header.frame_id, "");
  wire::PutSequence(message->status, boats, PutStatus);
  return message;
}

}  // namespace telltale
