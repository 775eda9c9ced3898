#include "telltale/idl/codec/json/metrics.hpp"

#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/proto_values.hpp"

namespace telltale {
namespace {

void Write(const OneStepScore& score, proto::OneStepScore& message) {
  message.set_r2(score.r2);
  message.set_mae(score.mae);
  message.set_persistence_r2(score.constant_velocity_r2);
}

void Write(const FreeRunScore& score, proto::FreeRunScore& message) {
  message.set_rmse(score.rmse);
  message.set_mae(score.mae);
  message.set_r2(score.r2);
  message.set_persistence_rmse(score.constant_velocity_rmse);
  message.set_noise_floor(score.noise_floor);
}

OneStepScore ScoreOf(const proto::OneStepScore& message) {
  return {message.r2(), message.mae(), message.persistence_r2()};
}

FreeRunScore ScoreOf(const proto::FreeRunScore& message) {
  return {message.rmse(), message.mae(), message.r2(), message.persistence_rmse(),
          message.noise_floor()};
}

}  // namespace

proto::Metrics::FreeRun ToProto(const FreeRunScores& scores) {
  proto::Metrics::FreeRun message;
  message.set_horizon_s(scores.horizon_s);
  Write(scores.velocity[0], *message.mutable_surge());
  Write(scores.velocity[1], *message.mutable_sway());
  Write(scores.velocity[2], *message.mutable_yaw());
  message.set_position_rmse_m(scores.position_rmse_m);
  message.set_windows(Saturated(scores.windows));
  return message;
}

FreeRunScores ScoresOf(const proto::Metrics::FreeRun& message) {
  return {message.horizon_s(),
          {ScoreOf(message.surge()), ScoreOf(message.sway()), ScoreOf(message.yaw())},
          message.position_rmse_m(),
          message.windows()};
}

proto::Metrics ToProto(const Metrics& metrics) {
  proto::Metrics message;
  Write(metrics.one_step[0], *message.mutable_one_step()->mutable_surge());
  Write(metrics.one_step[1], *message.mutable_one_step()->mutable_sway());
  Write(metrics.one_step[2], *message.mutable_one_step()->mutable_yaw());
  for (const FreeRunScores& scores : metrics.free_run) *message.add_free_run() = ToProto(scores);
  return message;
}

Metrics MetricsOf(const proto::Metrics& message) {
  Metrics metrics;
  metrics.one_step = {ScoreOf(message.one_step().surge()), ScoreOf(message.one_step().sway()),
                      ScoreOf(message.one_step().yaw())};
  for (const auto& scores : message.free_run()) metrics.free_run.push_back(ScoresOf(scores));
  return metrics;
}

std::string PrintMetricsJson(const Metrics& metrics) {
  return PrintJsonMessage(ToProto(metrics));
}

Decoded<Metrics> ParseMetricsJson(std::string_view text, const std::string& file) {
  proto::Metrics message;
  if (const auto fault = ParseJsonMessage(text, file, message)) return tl::unexpected(*fault);
  return MetricsOf(message);
}

}  // namespace telltale
