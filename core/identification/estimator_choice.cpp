#include "telltale/core/identification/estimator_choice.hpp"

#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "telltale/core/estimation/weak_iv.hpp"
#include "telltale/core/identification/output_error_answer.hpp"
#include "telltale/core/identification/weak_iv_answer.hpp"
#include "telltale/core/uncertainty/residual_excess.hpp"

namespace telltale {
namespace {

/// Mean squares of sensor noise alone differ by less from one repeat to the next.
constexpr double kPlainExcess = 2.0;

template <class... Parts>
std::string Sentence(const Parts&... parts) {
  std::ostringstream words;
  words.precision(3);
  (words << ... << parts);
  return words.str();
}

/// Output error's answers if its bounds can be trusted, else why not.
tl::expected<BoundedAnswers, std::string> TrustOutputError(const PreparedDataset& dataset,
                                                           const RegressionOptions& regression,
                                                           const IdentifyOptions& options,
                                                           const Progress& progress,
                                                           const std::optional<WeakLook>& look) {
  const auto doubt = [](std::string why) { return tl::unexpected(std::move(why)); };
  if (!look) return doubt("only they seek a steady disturbance for each recording");
  const auto& weak = look->fit;
  if (!weak) return doubt("there is no first estimate from which to judge the disturbance");
  const auto excess =
      ResidualExcess(dataset, regression, *weak, options.weak_iv.form, options.seed);
  if (!excess) return doubt("the first estimate runs away, so that no disturbance can be judged");
  if (*excess > kPlainExcess) {
    return doubt(Sentence("a disturbance shows, its residuals being ", *excess,
                          " times what the sensors leave (above ", kPlainExcess, ')'));
  }
  if (progress) progress("fitting output error", 0.35);
  auto fitted = FitOutputError(dataset, regression, look->answers,
                               ModelOf(*weak, weak->Damped(), dataset.sampling_period_s));
  if (!fitted) return doubt("output error gives no answer (" + fitted.error().reason + ')');
  if (!fitted->fit.converged) return doubt("output error does not converge");
  if (!fitted->fit.separability.directions.empty()) {
    return doubt("output error cannot tell all coefficients apart");
  }
  if (!fitted->Believable()) {
    return doubt(
        Sentence("output error leaves more than the sensors' noise (misspecification "
                 "ratio ",
                 fitted->misspecification, ", above ", kBelievedMisspecification, ')'));
  }
  const double ratio = fitted->misspecification;
  BoundedAnswers bounded = BoundsOf(*std::move(fitted), dataset, regression, options);
  bounded.provenance.estimator_choice = Sentence(
      "output error, since no disturbance shows beside the sensors' noise "
      "(misspecification ratio ",
      ratio, ", at most ", kBelievedMisspecification, ')');
  return bounded;
}

}  // namespace

Result<BoundedAnswers> BoundByDisturbance(const PreparedDataset& dataset,
                                          const RegressionOptions& regression,
                                          const IdentifyOptions& options,
                                          const Progress& progress) {
  std::optional<WeakLook> look;
  if (regression.offsets == Offsets::kShared) look = LookWeakly(dataset, regression, options);
  auto trusted = TrustOutputError(dataset, regression, options, progress, look);
  if (trusted) return *std::move(trusted);
  auto bounded = BoundWeakIv(dataset, regression, options, progress, look);
  if (!bounded) return bounded;
  bounded->provenance.estimator_choice =
      "weak-form instrumental variables, since " + trusted.error();
  return bounded;
}

}  // namespace telltale
