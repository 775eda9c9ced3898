#include "telltale/core/identification/estimator_selection.hpp"

#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/identification/output_error_estimate.hpp"
#include "telltale/core/identification/weak_iv_estimate.hpp"
#include "telltale/core/uncertainty/residual_variance_ratio.hpp"

namespace telltale {
namespace {

/// Mean squares of sensor noise alone differ by less from one replicate to the next.
constexpr double kLargestVarianceRatio = 2.0;

template <class... Parts>
std::string Sentence(const Parts&... parts) {
  std::ostringstream words;
  words.precision(3);
  (words << ... << parts);
  return words.str();
}

/// The estimates of output error if its bounds hold, else the reason why they do not.
tl::expected<BoundedEstimates, std::string> TryOutputError(
    const PreparedDataset& dataset, const RegressionOptions& regression,
    const IdentifyOptions& options, const Progress& progress,
    const std::optional<PreliminaryWeakFit>& preliminary) {
  const auto doubt = [](std::string why) { return tl::unexpected(std::move(why)); };
  if (!preliminary) return doubt("only they estimate a constant disturbance for each recording");
  const auto& weak = preliminary->fit;
  if (!weak)
    return doubt("there is no preliminary weak-form fit from which to estimate the disturbance");
  const auto variance_ratio =
      ResidualVarianceRatio(dataset, regression, *weak, options.weak_iv.form, options.seed);
  if (!variance_ratio)
    return doubt("the preliminary weak-form fit diverges, so that no disturbance can be estimated");
  if (*variance_ratio > kLargestVarianceRatio) {
    return doubt(Sentence("a disturbance shows, its residuals being ", *variance_ratio,
                          " times what the sensors leave (above ", kLargestVarianceRatio, ')'));
  }
  if (progress) progress("fitting output error", 0.35);
  auto fitted = FitOutputError(dataset, regression, preliminary->equation_estimates,
                               ModelOf(*weak, weak->Regularised(), dataset.sampling_period_s));
  if (!fitted) return doubt("output error gives no answer (" + fitted.error().reason + ')');
  if (!fitted->fit.converged) return doubt("output error does not converge");
  if (!fitted->fit.separability.directions.empty()) {
    return doubt("output error finds inseparable coefficients");
  }
  if (!fitted->IsWellSpecified()) {
    return doubt(
        Sentence("output error leaves more than the sensors' noise (misspecification "
                 "ratio ",
                 fitted->misspecification, ", above ", kLargestAcceptedMisspecification, ')'));
  }
  const double ratio = fitted->misspecification;
  BoundedEstimates bounded = BoundsOf(*std::move(fitted), dataset, regression, options);
  bounded.provenance.estimator_choice = Sentence(
      "output error, since no disturbance shows beside the sensors' noise "
      "(misspecification ratio ",
      ratio, ", at most ", kLargestAcceptedMisspecification, ')');
  return bounded;
}

}  // namespace

Result<BoundedEstimates> BoundWithSelectedEstimator(const PreparedDataset& dataset,
                                                    const RegressionOptions& regression,
                                                    const IdentifyOptions& options,
                                                    const Progress& progress) {
  std::optional<PreliminaryWeakFit> preliminary;
  if (regression.recording_bias == RecordingBiasModel::kShared)
    preliminary = FitPreliminaryWeakForm(dataset, regression, options);
  auto accepted = TryOutputError(dataset, regression, options, progress, preliminary);
  if (accepted) return *std::move(accepted);
  auto bounded = BoundWeakIv(dataset, regression, options, progress, std::move(preliminary));
  if (!bounded) return bounded;
  bounded->provenance.estimator_choice =
      "weak-form instrumental variables, since " + accepted.error();
  return bounded;
}

}  // namespace telltale
