#include "telltale/service/monitoring/live_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "telltale/core/data/preparation.hpp"
#include "telltale/core/data/recording_parts.hpp"
#include "telltale/service/models/free_run_error.hpp"

namespace telltale {
namespace {

constexpr double kUpdatePeriodS = 5.0;
// Rows before the new ones: the filter needs rows on both sides, and segments a minimum length.
constexpr double kLeadS = 15.0;
constexpr double kLongestUpdateS = 1200.0;

bool IsNewer(double time_s, double than_s, double period_s) {
  return time_s > than_s + 0.5 * period_s;
}

}  // namespace

bool LiveEstimator::IsDue(double end_s) const {
  return end_s >= seen_to_s_ + kUpdatePeriodS || end_s < seen_to_s_;
}

double LiveEstimator::NeedsS(double end_s) const {
  const bool begins = !bounds_ || end_s < seen_to_s_;
  return begins ? kLongestUpdateS : std::min(end_s - fed_to_s_ + kLeadS, kLongestUpdateS);
}

void LiveEstimator::Update(const Recording& recording, const Vehicle& vehicle) {
  const double end_s = EndTime(recording);
  if (end_s < seen_to_s_) *this = LiveEstimator();
  const double needed_s = NeedsS(end_s);
  seen_to_s_ = end_s;
  PrepareOptions options;
  options.sampling_period_s = sampling_period_s_;
  const auto dataset = Prepare(Latest(recording, needed_s), vehicle, options);
  if (!dataset) return;
  if (!bounds_) {
    sampling_period_s_ = dataset->sampling_period_s;
    bounds_.emplace(RegressionOptions(), *sampling_period_s_, SlidingOptions());
    fed_to_s_ = dataset->StartTime() - *sampling_period_s_;
  }
  AddSettledRows(*dataset);
}

void LiveEstimator::AddSettledRows(const PreparedDataset& dataset) {
  // The filter and the interpolation of the last rows depend on samples that may still arrive.
  const std::size_t unsettled = dataset.options.smoothing_half_width + 3;
  const std::size_t settled = dataset.rows.size() - std::min(unsettled, dataset.rows.size());
  for (std::size_t k = 0; k < settled; ++k) {
    const PreparedRow& row = dataset.rows[k];
    if (!IsNewer(row.time_s, fed_to_s_, dataset.sampling_period_s)) continue;
    bounds_->Add(row);
    fed_to_s_ = row.time_s;
    ++rows_;
  }
}

std::vector<IndicativeCoefficient> LiveEstimator::Estimates() const {
  std::vector<IndicativeCoefficient> all;
  if (!bounds_) return all;
  for (const Equation equation : kEquations) {
    const auto estimate = bounds_->Estimate(equation);
    if (!estimate) continue;
    const auto regressors = Regressors(equation, Parameterization::kPropeller);
    for (std::size_t i = 0; i < regressors.size(); ++i) {
      const auto place = static_cast<Eigen::Index>(i);
      if (!estimate->estimable[i] || !std::isfinite(estimate->standard_error[place])) continue;
      all.push_back({equation, std::string(regressors[i].name), std::string(regressors[i].symbol),
                     estimate->theta[place], estimate->standard_error[place],
                     std::string(regressors[i].unit)});
    }
  }
  return all;
}

}  // namespace telltale
