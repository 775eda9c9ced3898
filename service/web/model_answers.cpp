#include "telltale/service/web/model_answers.hpp"

#include <string>

#include "telltale/core/identification/model_comparison.hpp"
#include "telltale/idl/codec/json/model_change.hpp"
#include "telltale/idl/codec/json/proto_values.hpp"

namespace telltale {
namespace {

ModelChange ChangeOf(const Identification& earlier, const Identification& later) {
  auto change = ChangeBetween(earlier, later);
  if (change) return *std::move(change);
  ModelChange none;
  none.verdict = ChangeVerdict::kInconclusive;
  none.reason = change.error().reason;
  return none;
}

std::string SentenceOf(const ModelChange& change, std::uint64_t later) {
  if (change.verdict == ChangeVerdict::kInconclusive) return AnswerOf(change);
  return AnswerOf(change) + " Revision " + std::to_string(later) + ' ' + InWords(change) +
         (change.verdict == ChangeVerdict::kChanged ? "" : ".");
}

proto::PredictedPaths::Path ToProto(const Path& path) {
  proto::PredictedPaths::Path message;
  message.mutable_time_s()->Add(path.time_s.begin(), path.time_s.end());
  message.mutable_north_m()->Add(path.north_m.begin(), path.north_m.end());
  message.mutable_east_m()->Add(path.east_m.begin(), path.east_m.end());
  return message;
}

}  // namespace

proto::Comparison Compared(const PublishedModel& earlier, const PublishedModel& later) {
  ModelChange change = ChangeOf(earlier.identification, later.identification);
  change.revision = earlier.revision;
  proto::Comparison comparison;
  comparison.set_earlier(Saturated(earlier.revision));
  comparison.set_later(Saturated(later.revision));
  comparison.set_sentence(SentenceOf(change, later.revision));
  comparison.set_windows_overlap(WindowsOverlap(earlier.identification, later.identification));
  *comparison.mutable_change() = ToProto(change);
  return comparison;
}

proto::PredictedPaths ToProto(const PredictedPaths& paths, std::uint64_t revision) {
  proto::PredictedPaths message;
  message.set_revision(Saturated(revision));
  message.set_horizon_s(paths.horizon_s);
  *message.mutable_measured() = ToProto(paths.measured);
  for (const Path& path : paths.predicted) *message.add_predicted() = ToProto(path);
  message.set_position_rmse_m(paths.position_rmse_m);
  return message;
}

}  // namespace telltale
