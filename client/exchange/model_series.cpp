#include "telltale/client/exchange/model_series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include <nlohmann/json.hpp>

#include "telltale/client/exchange/mcap_writer.hpp"
#include "telltale/client/exchange/shortest_number.hpp"
#include "telltale/core/base/degrees.hpp"
#include "telltale/core/data/north_east_frame.hpp"

namespace telltale {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr std::array kMotionFields = {"north_m", "east_m", "heading_deg",
                                      "u_mps",   "v_mps",  "r_radps"};
constexpr std::array kResidualFields = {"residual_u_mps", "residual_v_mps", "residual_r_radps"};

std::array<double, 6> MotionOf(const PreparedRow& row) {
  return {row.eta.x_m, row.eta.y_m, Wrap360(row.eta.psi_rad * kDegreesPerRadian),
          row.nu.u,    row.nu.v,    row.nu.r};
}

/// What is known of one row beside its measurement.
struct PredictedRow {
  std::optional<PreparedRow> free_run;
  double run_start_s = 0.0;
  std::optional<Nu> residual;
};

/// By row of the dataset. A run's first row is a measurement and nothing predicted, unless another
/// run ends there.
std::vector<PredictedRow> ByRow(const ModelSeries& series) {
  std::vector<PredictedRow> rows(series.dataset.rows.size());
  for (const FreeRun& run : series.free_runs) {
    for (std::size_t k = 1; k < run.predicted.size(); ++k) {
      rows[run.first_row + k].free_run = run.predicted[k];
      rows[run.first_row + k].run_start_s = series.dataset.rows[run.first_row].time_s;
    }
  }
  for (const FreeRun& step : series.one_step) {
    const Nu& measured = series.dataset.rows[step.first_row + 1].nu;
    const Nu& predicted = step.predicted[1].nu;
    rows[step.first_row + 1].residual = {measured.u - predicted.u, measured.v - predicted.v,
                                         measured.r - predicted.r};
  }
  return rows;
}

std::string NumberCell(double value) {
  return std::isfinite(value) ? ',' + ShortestNumber(value) : std::string(",");
}

// ---- coefficients -------------------------------------------------------------------------------

std::vector<Coefficient> AllOf(const Identification& model) {
  std::vector<Coefficient> all = model.coefficients;
  if (model.physical) {
    all.insert(all.end(), model.physical->parameters.begin(), model.physical->parameters.end());
  }
  return all;
}

std::string EquationText(const Coefficient& coefficient) {
  return coefficient.equation == Equation::kUnknown ? std::string()
                                                    : std::string(Name(coefficient.equation));
}

OrderedJson JsonOf(const Coefficient& coefficient) {
  OrderedJson json;
  if (coefficient.equation != Equation::kUnknown) json["equation"] = EquationText(coefficient);
  if (!coefficient.regressor.empty()) json["regressor"] = coefficient.regressor;
  json["symbol"] = coefficient.symbol;
  const auto put = [&](const char* name, double value) {
    if (std::isfinite(value)) json[name] = value;
  };
  put("estimate", coefficient.estimate);
  put("standard_error", coefficient.standard_error);
  put("lower", coefficient.interval.lower);
  put("upper", coefficient.interval.upper);
  json["unit"] = coefficient.unit;
  json["status"] = std::string(Name(coefficient.status));
  return json;
}

// ---- channels of MCAP ---------------------------------------------------------------------------

std::string NumbersSchema(const std::vector<std::string>& fields) {
  OrderedJson properties;
  for (const std::string& field : fields) properties[field] = {{"type", "number"}};
  return OrderedJson{{"type", "object"}, {"properties", properties}}.dump();
}

std::string CoefficientsSchema() {
  OrderedJson properties;
  for (const char* field : {"equation", "regressor", "symbol", "unit", "status"}) {
    properties[field] = {{"type", "string"}};
  }
  for (const char* field : {"estimate", "standard_error", "lower", "upper"}) {
    properties[field] = {{"type", "number"}};
  }
  const OrderedJson item = {{"type", "object"}, {"properties", properties}};
  return OrderedJson{{"type", "object"},
                     {"properties",
                      {{"vehicle_id", {{"type", "string"}}},
                       {"interval_level", {{"type", "number"}}},
                       {"coefficients", {{"type", "array"}, {"items", item}}}}}}
      .dump();
}

/// Of Foxglove's schema LocationFix.
std::string LocationSchema() {
  const OrderedJson number = {{"type", "number"}};
  const OrderedJson whole = {{"type", "integer"}};
  return OrderedJson{
      {"type", "object"},
      {"properties",
       {{"timestamp", {{"type", "object"}, {"properties", {{"sec", whole}, {"nsec", whole}}}}},
        {"frame_id", {{"type", "string"}}},
        {"latitude", number},
        {"longitude", number},
        {"altitude", number},
        {"position_covariance", {{"type", "array"}, {"items", number}}},
        {"position_covariance_type", whole}}}}
      .dump();
}

/// MCAP counts from 1970: a clock that begins before is shifted to begin there.
class NanosecondClock {
 public:
  explicit NanosecondClock(double start_s) : shift_s_(std::max(0.0, -start_s)) {}
  std::int64_t Of(double time_s) const { return std::llround((time_s + shift_s_) * 1e9); }

 private:
  double shift_s_;
};

OrderedJson MotionJson(const PreparedRow& row) {
  OrderedJson json;
  const auto motion = MotionOf(row);
  for (std::size_t i = 0; i < motion.size(); ++i) json[kMotionFields[i]] = motion[i];
  return json;
}

bool IsFinite(const PreparedRow& row) {
  const auto motion = MotionOf(row);
  double sum = 0.0;
  for (const double value : motion) sum += value;
  return std::isfinite(sum);
}

OrderedJson LocationJson(const PreparedRow& row, std::int64_t time_ns,
                         const NorthEastFrame& frame) {
  const GeographicPosition position = frame.Inverse({row.eta.x_m, row.eta.y_m});
  return {{"timestamp", {{"sec", time_ns / 1000000000}, {"nsec", time_ns % 1000000000}}},
          {"frame_id", "boat"},
          {"latitude", position.latitude_deg},
          {"longitude", position.longitude_deg},
          {"altitude", 0.0},
          {"position_covariance", std::vector<double>(9, 0.0)},
          {"position_covariance_type", 0}};
}

}  // namespace

std::string PrintSeriesCsv(const ModelSeries& series) {
  std::string text = "time_s";
  for (const char* field : kMotionFields) text += std::string(",") + field;
  text += ",port,starboard";
  for (const char* field : kMotionFields) text += std::string(",free_run_") + field;
  text += ",free_run_start_s";
  for (const char* field : kResidualFields) text += std::string(",") + field;
  text += '\n';
  const auto predicted = ByRow(series);
  for (std::size_t k = 0; k < predicted.size(); ++k) {
    const PreparedRow& row = series.dataset.rows[k];
    text += ShortestNumber(row.time_s);
    for (const double value : MotionOf(row)) text += NumberCell(value);
    text += NumberCell(row.delta.port) + NumberCell(row.delta.starboard);
    if (predicted[k].free_run) {
      for (const double value : MotionOf(*predicted[k].free_run)) text += NumberCell(value);
      text += NumberCell(predicted[k].run_start_s);
    } else {
      text.append(kMotionFields.size() + 1, ',');
    }
    if (predicted[k].residual) {
      const Nu& residual = *predicted[k].residual;
      text += NumberCell(residual.u) + NumberCell(residual.v) + NumberCell(residual.r);
    } else {
      text.append(kResidualFields.size(), ',');
    }
    text += '\n';
  }
  return text;
}

std::string PrintCoefficientsCsv(const Identification& model) {
  std::string text = "equation,regressor,symbol,estimate,standard_error,lower,upper,unit,status\n";
  for (const Coefficient& c : AllOf(model)) {
    text += EquationText(c) + ',' + c.regressor + ',' + c.symbol + NumberCell(c.estimate) +
            NumberCell(c.standard_error) + NumberCell(c.interval.lower) +
            NumberCell(c.interval.upper) + ',' + c.unit + ',' + std::string(Name(c.status)) + '\n';
  }
  return text;
}

std::string PrintSeriesMcap(const ModelSeries& series) {
  McapWriter mcap;
  std::vector<std::string> motion(kMotionFields.begin(), kMotionFields.end());
  std::vector<std::string> measured_fields = motion;
  measured_fields.insert(measured_fields.end(), {"port", "starboard"});
  std::vector<std::string> free_run_fields = motion;
  free_run_fields.emplace_back("run_start_s");
  const auto coefficients =
      mcap.AddChannel("/telltale/coefficients", "telltale.Coefficients", CoefficientsSchema());
  const auto measured =
      mcap.AddChannel("/telltale/measured", "telltale.Measured", NumbersSchema(measured_fields));
  const auto free_run =
      mcap.AddChannel("/telltale/free_run", "telltale.FreeRun", NumbersSchema(free_run_fields));
  const auto residuals = mcap.AddChannel("/telltale/residuals", "telltale.Residuals",
                                         NumbersSchema({"u_mps", "v_mps", "r_radps"}));
  const auto position =
      mcap.AddChannel("/telltale/position", "foxglove.LocationFix", LocationSchema());

  OrderedJson model = {{"vehicle_id", series.model.vehicle_id}};
  model["coefficients"] = OrderedJson::array();
  for (const Coefficient& c : AllOf(series.model)) {
    model["interval_level"] = c.interval.level;
    model["coefficients"].push_back(JsonOf(c));
  }
  const NanosecondClock clock(series.dataset.StartTime());
  mcap.Add(coefficients, clock.Of(series.dataset.StartTime()), model.dump());

  const NorthEastFrame frame(series.dataset.origin);
  const auto predicted = ByRow(series);
  for (std::size_t k = 0; k < predicted.size(); ++k) {
    const PreparedRow& row = series.dataset.rows[k];
    const std::int64_t time_ns = clock.Of(row.time_s);
    OrderedJson json = MotionJson(row);
    json["port"] = row.delta.port;
    json["starboard"] = row.delta.starboard;
    mcap.Add(measured, time_ns, json.dump());
    mcap.Add(position, time_ns, LocationJson(row, time_ns, frame).dump());
    if (predicted[k].free_run && IsFinite(*predicted[k].free_run)) {
      OrderedJson run = MotionJson(*predicted[k].free_run);
      run["run_start_s"] = predicted[k].run_start_s;
      mcap.Add(free_run, time_ns, run.dump());
    }
    if (predicted[k].residual) {
      const Nu& residual = *predicted[k].residual;
      if (!std::isfinite(residual.u + residual.v + residual.r)) continue;
      mcap.Add(residuals, time_ns,
               OrderedJson{{"u_mps", residual.u}, {"v_mps", residual.v}, {"r_radps", residual.r}}
                   .dump());
    }
  }
  return mcap.Finish();
}

}  // namespace telltale
