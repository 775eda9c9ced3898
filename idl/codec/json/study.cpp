#include "telltale/idl/codec/json/study.hpp"

#include "telltale/idl/codec/json/coefficient.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/proto_values.hpp"
#include "telltale/idl/codec/json/provenance.hpp"

namespace telltale {
namespace {

void Write(const Spread& spread, proto::Spread& message) {
  message.set_mean(spread.mean);
  message.set_standard_deviation(spread.standard_deviation);
}

void Write(const PartitionScores& scores, proto::PartitionScores& message) {
  Write(scores.training_mae, *message.mutable_training_mae());
  Write(scores.training_r2, *message.mutable_training_r2());
  Write(scores.mae, *message.mutable_mae());
  Write(scores.r2, *message.mutable_r2());
  Write(scores.constant_velocity_r2, *message.mutable_constant_velocity_r2());
  if (scores.free_run_rmse) Write(*scores.free_run_rmse, *message.mutable_free_run_rmse());
  if (scores.constant_velocity_free_run_rmse) {
    Write(*scores.constant_velocity_free_run_rmse,
          *message.mutable_constant_velocity_free_run_rmse());
  }
}

void Write(const StudyEntry& entry, proto::StudyEntry& message) {
  message.set_structure(EnumCast<proto::Structure>(entry.structure));
  message.set_method(std::string(Name(entry.method)));
  message.set_training_share(entry.training_share);
  message.set_repeats(static_cast<std::uint32_t>(entry.repeats));
  Write(entry.scores[0], *message.mutable_surge());
  Write(entry.scores[1], *message.mutable_sway());
  Write(entry.scores[2], *message.mutable_yaw());
}

void WriteTable(const std::array<std::optional<Eigen::VectorXd>, 3>& table,
                proto::CoefficientTable& message) {
  const std::array columns = {message.mutable_surge(), message.mutable_sway(),
                              message.mutable_yaw()};
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (table[j]) columns[j]->Add(table[j]->begin(), table[j]->end());
  }
}

}  // namespace

proto::Study ToProto(const Study& study) {
  proto::Study message;
  for (const StudyEntry& entry : study.partitions) Write(entry, *message.add_partitions());
  for (const StudyEntry& entry : study.shares) Write(entry, *message.add_shares());
  WriteTable(study.static_table, *message.mutable_static_table());
  WriteTable(study.dynamic_table, *message.mutable_dynamic_table());
  if (study.redundant_alpha) {
    message.set_redundant_alpha(study.redundant_alpha->alpha);
    message.set_redundant_alpha_residual(study.redundant_alpha->residual);
    message.set_redundant_alphas_agree(study.redundant_alpha->agree);
  }
  if (study.time_constant) *message.mutable_time_constant_s() = ToProto(*study.time_constant);
  for (const Refusal& refusal : study.refusals) *message.add_refusals() = ToProto(refusal);
  return message;
}

std::string PrintStudyJson(const Study& study) {
  return PrintJsonMessage(ToProto(study));
}

}  // namespace telltale
