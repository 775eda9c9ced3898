#include "telltale/core/identification/certify.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <vector>

#include "telltale/core/estimation/separable_columns.hpp"
#include "telltale/core/identification/tamed_model.hpp"
#include "telltale/core/identification/weak_iv_answer.hpp"
#include "telltale/core/linear_algebra/covariance.hpp"
#include "telltale/core/linear_algebra/decompositions.hpp"
#include "telltale/core/parallel.hpp"
#include "telltale/core/random.hpp"
#include "telltale/core/simulation/dataset_twin.hpp"
#include "telltale/core/uncertainty/laws.hpp"
#include "telltale/core/uncertainty/twin_correction.hpp"

namespace telltale {
namespace {

constexpr const char* kSubject = "certificate";
constexpr const char* kAdvice = "record for longer, with more varied manoeuvres";

/// Sailing and identification of a repeat draw from streams of their own.
enum class Draw : std::uint64_t { kVoyage, kIdentification };

std::uint64_t SeedOf(std::uint64_t seed, std::size_t repeat, Draw draw) {
  return RandomEngine::Stream(seed, 2 * repeat + static_cast<std::uint64_t>(draw))();
}

/// The data as they are sailed again: in parts of a minute, which stay near what was recorded.
Result<PreparedDataset> PrepareToSail(const Recording& recording, const Vehicle& vehicle,
                                      const Identification& identification,
                                      const IdentifyOptions& options) {
  PrepareOptions prepare = options.prepare;
  prepare.preset = Preset::kRobust;
  prepare.sampling_period_s = identification.sampling_period_s;
  return PrepareForWeakIv(recording, vehicle, prepare);
}

/// The same data seen through the weak form, whatever estimator is to be certified: it judges the
/// disturbance where that estimator does not, and knows a damped boat.
struct WeakView {
  RegressionOptions regression;
  std::array<std::vector<std::size_t>, 3> columns;
  std::optional<WeakFit> fit;
};

WeakView SeeWeakly(const PreparedDataset& dataset, const Identification& identification,
                   const IdentifyOptions& options) {
  WeakView view{options.regression, {}, std::nullopt};
  view.regression.dead_zone = identification.dead_zone;
  std::array<std::size_t, 3> next{};
  for (const Coefficient& c : identification.coefficients) {
    const std::size_t j = IndexOf(c.equation);
    if (c.status != CoefficientStatus::kNotExcited) view.columns[j].push_back(next[j]);
    ++next[j];
  }
  view.columns = Separate(dataset, view.regression, view.columns, options.weak_iv.form).kept;
  view.fit = EstimateWeakIv(dataset, view.regression, view.columns, options.weak_iv);
  if (view.fit && view.fit->scores.cols() < 2) view.fit.reset();
  return view;
}

/// Boats to take for the truth: the published one first, then what it is sailed with, then ones
/// drawn towards the damped one.
std::vector<VesselModel> Candidates(const Identification& identification, const WeakView& view) {
  const VesselModel published = TamedModel(identification, kAsPublished);
  std::vector<VesselModel> candidates = {published};
  if (!identification.sailed.empty()) candidates.push_back(*ModelOf(identification));
  if (!view.fit) return candidates;
  const VesselModel damped =
      ModelOf(*view.fit, view.fit->Damped(), identification.sampling_period_s);
  for (const double share : {0.5, 0.25, 0.0}) {
    VesselModel between = published;
    for (std::size_t j = 0; j < between.theta.size(); ++j) {
      between.theta[j] = share * published.theta[j] + (1.0 - share) * damped.theta[j];
    }
    candidates.push_back(between);
  }
  return candidates;
}

/// The boat that stands for the truth.
struct Truth {
  VesselModel model;
  bool as_published = false;

  double Of(const Identification& identification, std::size_t coefficient) const {
    const Equation equation = identification.coefficients[coefficient].equation;
    std::size_t first = coefficient;
    while (first > 0 && identification.coefficients[first - 1].equation == equation) --first;
    return model.theta[IndexOf(equation)][static_cast<Eigen::Index>(coefficient - first)];
  }
};

/// How often one coefficient's bounds held, as repeats come in.
class CoverageCount {
 public:
  /// Whether the bounds hold the truth; nothing when there are none.
  std::optional<bool> Add(const Coefficient& coefficient, double truth) {
    if (!std::isfinite(coefficient.standard_error) || coefficient.standard_error <= 0.0) {
      return std::nullopt;
    }
    const bool held = truth >= coefficient.interval.lower && truth <= coefficient.interval.upper;
    tally_.Add(held);
    off_ += (coefficient.estimate - truth) / coefficient.standard_error;
    return held;
  }

  CoefficientCoverage Coverage() const {
    return {tally_, tally_.of == 0 ? 0.0 : off_ / static_cast<double>(tally_.of)};
  }

 private:
  Tally tally_;
  double off_ = 0.0;
};

class Certification {
 public:
  Certification(const PreparedDataset& dataset, const Identification& identification,
                const IdentifyOptions& options, const Progress& progress)
      : dataset_(dataset),
        identification_(identification),
        options_(options),
        progress_(progress),
        fractions_(options.certificate_twins, 0.0) {}

  Result<CoverageCertificate> Run(const Disturbance& disturbance,
                                  const std::vector<VesselModel>& candidates) {
    disturbance_ = disturbance;
    const auto truth = FindTruth(candidates);
    if (!truth) {
      return Refuse(kSubject, "the identified boat runs away under the recorded commands", kAdvice);
    }
    std::vector<std::optional<Identification>> repeats(options_.certificate_twins);
    ForEachIndex(repeats.size(), options_.threads, [&](std::size_t i) {
      repeats[i] = IdentifyRepeat(*truth, i);
      Tell(i, 1.0);
    });
    std::erase(repeats, std::nullopt);
    if (repeats.empty()) {
      return Refuse(kSubject, "not one simulated repeat of this data set could be identified",
                    kAdvice);
    }
    return Count(*truth, repeats);
  }

 private:
  TwinOptions VoyageOf(std::size_t repeat) const {
    TwinOptions voyage;
    voyage.disturbance = disturbance_;
    voyage.seed = SeedOf(options_.seed, repeat, Draw::kVoyage);
    for (const Equation equation : kEquations) {
      voyage.as_measured[IndexOf(equation)] = !identification_.Has(equation);
    }
    return voyage;
  }

  /// The first that can be sailed; the first of all is the published one.
  std::optional<Truth> FindTruth(const std::vector<VesselModel>& candidates) const {
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (CanBeSailed(candidates[i])) return Truth{candidates[i], i == 0};
    }
    return std::nullopt;
  }

  /// In at least half of a few voyages: the disturbance alone may carry a boat away.
  bool CanBeSailed(const VesselModel& model) const {
    constexpr std::size_t kTrials = 8;
    std::size_t sailed = 0;
    for (std::size_t i = 0; i < kTrials; ++i) {
      if (RecordAgain(dataset_, model, VoyageOf(i))) ++sailed;
    }
    return 2 * sailed >= kTrials;
  }

  std::optional<Identification> IdentifyRepeat(const Truth& truth, std::size_t repeat) {
    const auto twin = RecordAgain(dataset_, truth.model, VoyageOf(repeat));
    if (!twin) return std::nullopt;
    IdentifyOptions options = options_;
    options.prepare.sampling_period_s = dataset_.sampling_period_s;
    options.certificate_twins = 0;
    options.advise = false;
    options.threads = 1;
    options.seed = SeedOf(options_.seed, repeat, Draw::kIdentification);
    auto again = Identify(twin->recording, twin->vehicle, options,
                          [&](std::string_view, double fraction) { Tell(repeat, fraction); });
    if (!again) return std::nullopt;
    return *std::move(again);
  }

  void Tell(std::size_t repeat, double fraction) {
    if (!progress_) return;
    const std::lock_guard lock(telling_);
    told_ += std::max(0.0, fraction - fractions_[repeat]);
    fractions_[repeat] = std::max(fraction, fractions_[repeat]);
    progress_("certifying the bounds on simulated repeats",
              std::min(1.0, told_ / static_cast<double>(fractions_.size())));
  }

  CoverageCertificate Count(const Truth& truth,
                            const std::vector<std::optional<Identification>>& repeats) const {
    CoverageCertificate certificate;
    certificate.asked = options_.certificate_twins;
    certificate.answered = repeats.size();
    certificate.seed = options_.seed;
    certificate.level = options_.interval_level;
    certificate.about_published_model = truth.as_published;
    std::vector<CoverageCount> counts(identification_.coefficients.size());
    CoverageCount lag;
    std::vector<Tally> by_repeat(repeats.size());
    for (std::size_t i = 0; i < repeats.size(); ++i) {
      const Identification& repeat = *repeats[i];
      for (std::size_t j = 0; j < counts.size(); ++j) {
        const Coefficient* again = Find(repeat, identification_.coefficients[j]);
        if (again == nullptr) continue;
        const auto held = counts[j].Add(*again, truth.Of(identification_, j));
        if (held) by_repeat[i].Add(*held);
      }
      if (repeat.thruster_time_constant && identification_.thruster_time_constant) {
        lag.Add(*repeat.thruster_time_constant, identification_.thruster_time_constant->estimate);
      }
      if (const auto held = EllipsoidHolds(truth, repeat)) certificate.joint.Add(*held);
    }
    for (const CoverageCount& count : counts) certificate.coefficients.push_back(count.Coverage());
    if (identification_.thruster_time_constant) {
      certificate.thruster_time_constant = lag.Coverage();
    }
    WriteMean(by_repeat, certificate);
    return certificate;
  }

  static const Coefficient* Find(const Identification& repeat, const Coefficient& wanted) {
    const auto found = std::find_if(
        repeat.coefficients.begin(), repeat.coefficients.end(), [&](const Coefficient& c) {
          return c.equation == wanted.equation && c.regressor == wanted.regressor;
        });
    return found == repeat.coefficients.end() ? nullptr : &*found;
  }

  /// Whether the ellipsoid that the repeat publishes at the level of its bounds holds the truth; if
  /// it makes no joint statement, the one that its covariance would draw were it known. Nothing
  /// when it bounds fewer coefficients than the identification does.
  std::optional<bool> EllipsoidHolds(const Truth& truth, const Identification& repeat) const {
    std::vector<Eigen::Index> places;
    std::vector<double> off;
    for (std::size_t j = 0; j < identification_.coefficients.size(); ++j) {
      if (!std::isfinite(identification_.coefficients[j].standard_error)) continue;
      const Coefficient* again = Find(repeat, identification_.coefficients[j]);
      if (again == nullptr || !std::isfinite(again->standard_error)) return std::nullopt;
      places.push_back(again - repeat.coefficients.data());
      off.push_back((again->estimate - truth.Of(identification_, j)) / again->standard_error);
    }
    if (places.empty()) return std::nullopt;
    const Eigen::MatrixXd covariance = repeat.covariance(places, places);
    const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd correlation = Scaled(covariance, scale);
    const Eigen::LLT<Eigen::MatrixXd> llt(correlation);
    if (llt.info() != Eigen::Success) return std::nullopt;
    const Eigen::VectorXd z =
        Eigen::Map<const Eigen::VectorXd>(off.data(), static_cast<Eigen::Index>(off.size()));
    const double squared_radius =
        repeat.joint ? SquaredRadius(*repeat.joint, off.size(), options_.interval_level)
                     : ChiSquaredQuantile(static_cast<double>(off.size()), options_.interval_level);
    return z.dot(llt.solve(z)) <= squared_radius;
  }

  static void WriteMean(const std::vector<Tally>& by_repeat, CoverageCertificate& certificate) {
    double sum = 0.0;
    double squares = 0.0;
    double n = 0.0;
    for (const Tally& tally : by_repeat) {
      if (tally.of == 0) continue;
      sum += tally.Share();
      squares += tally.Share() * tally.Share();
      n += 1.0;
    }
    if (n == 0.0) return;
    certificate.mean_coverage = sum / n;
    if (n < 2.0) return;
    const double variance = (squares - sum * sum / n) / (n - 1.0);
    certificate.mean_coverage_error = std::sqrt(std::max(0.0, variance) / n);
  }

  const PreparedDataset& dataset_;
  const Identification& identification_;
  const IdentifyOptions& options_;
  const Progress& progress_;
  Disturbance disturbance_;
  std::mutex telling_;
  std::vector<double> fractions_;
  double told_ = 0.0;
};

}  // namespace

Result<CoverageCertificate> Certify(const Recording& recording, const Vehicle& vehicle,
                                    const Identification& identification,
                                    const IdentifyOptions& options, const Progress& progress) {
  const auto dataset = PrepareToSail(recording, vehicle, identification, options);
  if (!dataset) return tl::unexpected(dataset.error());
  const WeakView view = SeeWeakly(*dataset, identification, options);
  auto disturbance = identification.disturbance;
  if (!disturbance && view.fit) {
    disturbance = JudgeDisturbance(*dataset, view.regression, *view.fit, view.columns,
                                   options.weak_iv, options.seed);
  }
  if (!disturbance) {
    return Refuse(kSubject, "what disturbs the boat cannot be judged from these data", kAdvice);
  }
  return Certification(*dataset, identification, options, progress)
      .Run(*disturbance, Candidates(identification, view));
}

}  // namespace telltale
