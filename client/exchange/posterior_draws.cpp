#include "telltale/client/exchange/posterior_draws.hpp"

#include "telltale/client/exchange/shortest_number.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/proto/exchange.pb.h"

namespace telltale {
namespace {

void AddNotesOfPhysicalForm(proto::Draws& message) {
  message.add_notes(
      "The coefficients, continuous-time SI, of draws of the parameters within their physical "
      "range, as wide as parameterCovariance; the thruster time constant is one of them. "
      "They rest on the same basis as its bounds (provenance.boundsBasis).");
}

void AddNotes(const PosteriorDraws& draws, proto::Draws& message) {
  message.add_notes(
      "Joint normal draws of the coefficients, continuous-time SI, about the values for simulation "
      "with the model's covariance. They are as wide as its bounds and rest on the same basis "
      "(provenance.boundsBasis).");
  if (!draws.not_drawn.empty()) {
    message.add_notes(
        "What notDrawn names has no finite variance and is the same in every draw: the data do not "
        "determine it.");
  }
  if (draws.clipped > 0.0) {
    message.add_notes(
        "The covariance had negative eigenvalues, which were set to zero: some directions do not "
        "vary.");
  }
  if (!draws.time_constant_s.empty()) {
    message.add_notes(
        "The thruster time constant is drawn together with the coefficients, log-normally so that "
        "it stays positive.");
  }
}

}  // namespace

std::string ColumnName(const Coefficient& coefficient) {
  if (coefficient.equation == Equation::kUnknown) return coefficient.symbol;
  return std::string(Name(coefficient.equation)) + ' ' + coefficient.regressor;
}

std::string PrintDrawsJson(const Identification& identification, const PosteriorDraws& draws,
                           std::uint64_t seed) {
  proto::Draws message;
  message.set_vehicle_id(identification.vehicle_id);
  message.set_seed(seed);
  for (const Coefficient& coefficient : identification.coefficients) {
    message.add_columns(ColumnName(coefficient));
  }
  for (Eigen::Index i = 0; i < draws.theta.cols(); ++i) {
    proto::Draw& draw = *message.add_draws();
    for (const double value : draws.theta.col(i)) draw.add_coefficients(value);
    if (draws.time_constant_s.empty()) continue;
    draw.set_thruster_time_constant_s(draws.time_constant_s[static_cast<std::size_t>(i)]);
  }
  for (const std::string& name : draws.not_drawn) message.add_not_drawn(name);
  message.set_clipped(draws.clipped);
  if (identification.physical) {
    AddNotesOfPhysicalForm(message);
  } else {
    AddNotes(draws, message);
  }
  return PrintJsonMessage(message);
}

std::string PrintDrawsCsv(const Identification& identification, const PosteriorDraws& draws) {
  const bool lagging = !draws.time_constant_s.empty();
  std::string text;
  for (const Coefficient& coefficient : identification.coefficients) {
    text.append(text.empty() ? "" : ",").append(ColumnName(coefficient));
  }
  text += lagging ? ",thruster_time_constant_s\n" : "\n";
  for (Eigen::Index i = 0; i < draws.theta.cols(); ++i) {
    for (Eigen::Index j = 0; j < draws.theta.rows(); ++j) {
      text.append(j == 0 ? "" : ",").append(ShortestNumber(draws.theta(j, i)));
    }
    if (lagging) text += ',' + ShortestNumber(draws.time_constant_s[static_cast<std::size_t>(i)]);
    text += '\n';
  }
  return text;
}

}  // namespace telltale
