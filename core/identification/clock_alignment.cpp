#include "telltale/core/identification/clock_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/identification/equation_estimates.hpp"
#include "telltale/core/identification/weak_iv_estimate.hpp"

namespace telltale {
namespace {

constexpr double kLeastRemovedS = 0.025;  // shorter ones are linear in all that the fit sees
constexpr double kEvident = 5.0;          // standard errors, which few clusters make too small
constexpr double kSettledS = 0.002;
constexpr double kTwoSided95 = 1.96;
constexpr int kMostRounds = 5;

/// The delays that a fit of these data shows; nothing where they cannot be fitted.
std::optional<DelayEstimates> DelaysOf(const PreparedDataset& dataset,
                                       const IdentifyOptions& options) {
  const EquationEstimates excited =
      AssessExcitation(dataset, options.regression, options.excitation);
  if (!excited.Any()) return std::nullopt;
  const auto fit =
      EstimateWeakIv(dataset, options.regression, ExcitedColumns(excited), options.weak_iv);
  return fit ? fit->delays : std::nullopt;
}

bool IsEvident(double delay_s, double standard_error_s) {
  return std::abs(delay_s) > std::max(kLeastRemovedS, kEvident * standard_error_s);
}

/// What is to be removed of one delay: what is left adds to what is removed already, or is evident.
double Removed(double already_s, double left_s, double standard_error_s) {
  const bool adds = already_s != 0.0 || IsEvident(left_s, standard_error_s);
  return adds ? already_s + left_s : 0.0;
}

bool Differ(const ClockDelays& one, const ClockDelays& other) {
  return std::abs(one.commands_s - other.commands_s) > kSettledS ||
         std::abs(one.fixes_s - other.fixes_s) > kSettledS;
}

std::string Milliseconds(double seconds) {
  return std::to_string(std::lround(std::abs(seconds) * 1e3));
}

std::string DelayInWords(double delay_s, double standard_error_s, const char* what,
                         const char* late, const char* early) {
  return std::string(what) + ' ' + Milliseconds(delay_s) + " +- " +
         Milliseconds(kTwoSided95 * standard_error_s) + " ms " + (delay_s > 0.0 ? late : early);
}

/// Output error reads what lies behind the rows, and so does the choice between it and the weak
/// form.
Readings ReadingsFor(const std::optional<Estimator>& estimator) {
  return !estimator || *estimator == Estimator::kOutputError ? Readings::kKept : Readings::kLeftOut;
}

}  // namespace

Recording WithoutDelays(Recording recording, const ClockDelays& delays) {
  for (ThrusterSample& sample : recording.thrusters) sample.time_s += delays.commands_s;
  for (GnssFix& fix : recording.gnss) fix.time_s -= delays.fixes_s;
  const double earliest_s = std::min({0.0, delays.commands_s, -delays.fixes_s});
  for (double& start_s : recording.starts_s) start_s += earliest_s;
  return recording;
}

Result<AlignedDataset> PrepareWithClocksAligned(const Recording& recording, const Vehicle& vehicle,
                                                const IdentifyOptions& options) {
  const Readings readings = ReadingsFor(options.estimator);
  auto dataset = PrepareForWeakIv(recording, vehicle, options.prepare, readings);
  if (!dataset) return tl::unexpected(dataset.error());
  AlignedDataset aligned{*std::move(dataset), {}, {}};
  if (!options.weak_iv.delays) return aligned;
  for (int round = 0; round < kMostRounds; ++round) {
    const auto left = DelaysOf(aligned.dataset, options);
    if (!left) break;
    const Eigen::Vector2d errors = left->covariance.diagonal().cwiseSqrt();
    const ClockDelays all = {Removed(aligned.removed.commands_s, left->delays_s[0], errors[0]),
                             Removed(aligned.removed.fixes_s, left->delays_s[1], errors[1])};
    aligned.standard_errors = {errors[0], errors[1]};
    if (!Differ(all, aligned.removed)) break;
    auto again =
        PrepareForWeakIv(WithoutDelays(recording, all), vehicle, options.prepare, readings);
    if (!again) break;
    aligned = {*std::move(again), all, aligned.standard_errors};
  }
  aligned.dataset.sensors.command_spread_s = 2.0 * std::max(0.0, -aligned.removed.commands_s);
  return aligned;
}

Refusal WarnOfDelays(const AlignedDataset& aligned, bool bounds_carry_them) {
  const auto& [dataset, removed, errors] = aligned;
  std::string reason = "by the clock of the headings ";
  if (removed.commands_s != 0.0) {
    reason += DelayInWords(removed.commands_s, errors.commands_s, "commands act",
                           "after their stamps", "before their stamps");
  }
  if (removed.fixes_s != 0.0) {
    if (removed.commands_s != 0.0) reason += " and ";
    reason += DelayInWords(removed.fixes_s, errors.fixes_s, "fixes are stamped", "late", "early");
  }
  reason += "; the model is of the data without these delays";
  if (bounds_carry_them) {
    return {"clocks", std::move(reason), "stamp all channels by one clock where they are measured"};
  }
  return {"clocks", reason + ", and its bounds take them for known: they hold too seldom",
          "ask for the estimator weak-iv, whose bounds carry them"};
}

}  // namespace telltale
