#include "telltale/core/diagnosis/diagnose.hpp"
#include "telltale/core/base/version.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "telltale/core/base/range.hpp"
#include "telltale/core/diagnosis/hypotheses/augmented_identification.hpp"
#include "telltale/core/diagnosis/hypotheses/cross_validation.hpp"
#include "telltale/core/diagnosis/hypotheses/hypothesis_search.hpp"
#include "telltale/core/diagnosis/hypotheses/lack_of_fit.hpp"
#include "telltale/core/diagnosis/hypotheses/onset.hpp"
#include "telltale/core/diagnosis/hypotheses/ranking.hpp"
#include "telltale/core/diagnosis/hypotheses/testability.hpp"
#include "telltale/core/diagnosis/report/separation_advice.hpp"
#include "telltale/core/diagnosis/report/summary_sentence.hpp"
#include "telltale/core/diagnosis/residuals/gap.hpp"
#include "telltale/core/diagnosis/residuals/localisation.hpp"
#include "telltale/core/diagnosis/residuals/wiring_check.hpp"
#include "telltale/core/simulation/synthetic_dataset.hpp"

namespace telltale {
namespace {

constexpr std::string_view kSubject = "options";
constexpr std::array kHorizonsS = {1.0, 5.0, 10.0};
constexpr double kMainHorizonS = 5.0;
constexpr std::size_t kSyntheticReferences = 4;
constexpr std::size_t kMinimumWindows = 12;
constexpr double kMinimumSpeed =
    0.05;  // m/s and rad/s: whatever goes slower than this has not sailed

std::vector<const Effect*> LibraryWithout(const std::vector<std::string>& names) {
  std::vector<const Effect*> library;
  for (const Effect* effect : EffectLibrary()) {
    if (std::find(names.begin(), names.end(), effect->Name()) == names.end()) {
      library.push_back(effect);
    }
  }
  return library;
}

std::optional<Refusal> CheckRecording(const PreparedDataset& recording) {
  double recorded_s = 0.0;
  for (const RowRange& segment : recording.segments) {
    recorded_s += static_cast<double>(segment.size()) * recording.sampling_period_s;
  }
  if (recorded_s < kMinimumDiagnosedS) {
    return Refusal{"recording", "it is " + std::to_string(std::lround(recorded_s)) + " s long",
                   "record at least " + std::to_string(std::lround(kMinimumDiagnosedS)) + " s"};
  }
  const Nu fastest = FastestOf(recording);
  if (std::max({fastest.u, fastest.v, fastest.r}) < kMinimumSpeed) {
    return Refusal{"recording", "the boat is at rest throughout", "sail while recording"};
  }
  return std::nullopt;
}

/// What sensor noise alone would leave of the recording, sailed by the model itself.
std::vector<PreparedDataset> SyntheticReferences(const PreparedDataset& recording,
                                                 const VesselModel& model, std::uint64_t seed) {
  std::vector<PreparedDataset> synthetic_references;
  for (std::size_t i = 0; i < kSyntheticReferences; ++i) {
    SyntheticDatasetOptions options;
    options.seed = seed + i;
    if (auto synthetic = SimulateDataset(recording, model, options))
      synthetic_references.push_back(*std::move(synthetic));
  }
  return synthetic_references;
}

GapSize SizeOf(const Eigen::VectorXd& before, const Eigen::VectorXd& after, const NoiseFloor& floor,
               int channel) {
  GapSize size;
  size.before = std::sqrt(before.mean());
  size.after = std::sqrt(std::max(after.mean(), 0.0));
  size.noise_floor = std::sqrt(floor.Squared(channel));
  size.floor_limit = std::sqrt(floor.SquaredLimit(channel));
  return size;
}

class DiagnosisRun {
 public:
  DiagnosisRun(const PreparedDataset& recording, const std::vector<PreparedDataset>& references,
               const Identification& identification, const UncertainModel& model,
               const DiagnoseOptions& options, const Progress& progress)
      : recording_(recording),
        references_(references),
        identification_(identification),
        model_(model),
        options_(options),
        progress_(progress),
        library_(LibraryWithout(options.without)),
        parameter_refs_(EffectParameterRefsOf(library_)) {}

  Result<DiagnosedModel> Run() {
    ReportProgress("free runs", 0.0);
    if (auto refusal = BuildFreeRuns()) return tl::unexpected<Refusal>(*std::move(refusal));
    ReportProgress("nominal boat", 0.1);
    const NominalBaseline nominal =
        LearnNominalBaseline(reference_runs_[main_], model_, parameter_refs_, options_.threads);
    boat_ = nominal.boat;
    for (const std::vector<FreeRuns>& runs : reference_runs_)
      floors_.push_back(NoiseFloorOf(runs, boat_));
    for (const FreeRuns& runs : runs_) errors_.push_back(runs.Errors(boat_));
    ReportProgress("sensitivities", 0.35);
    const Sensitivity sensitivity =
        SensitivityOf(runs_[main_], nominal.boat, model_, parameter_refs_, options_.threads);
    const ResidualMetric metric(nominal, sensitivity, EveryWindow(sensitivity), options_.refit);
    const FrequencyResponse frequency_response(library_, runs_[main_], nominal.boat,
                                               sensitivity.errors, options_.threads);
    const DiagnosisProblem problem{runs_[main_], nominal,         sensitivity,
                                   metric,       parameter_refs_, frequency_response};
    const Hypotheses hypotheses =
        Search(problem, library_, options_.most_effects, options_.threads,
               [&](double share) { ReportProgress("effects", 0.4 + 0.4 * share); });
    return Conclude(problem, hypotheses);
  }

 private:
  void ReportProgress(std::string_view stage, double share) const {
    if (progress_) progress_(stage, share);
  }

  /// At every horizon that leaves windows in all recordings.
  std::optional<Refusal> BuildFreeRuns() {
    for (const double horizon_s : kHorizonsS) {
      FreeRuns runs(recording_, model_.model, horizon_s);
      std::vector<FreeRuns> nominal;
      for (const PreparedDataset& reference : references_) {
        FreeRuns of_reference(reference, model_.model, horizon_s);
        if (of_reference.Windows() > 0) nominal.push_back(std::move(of_reference));
      }
      const bool main = horizon_s == kMainHorizonS;
      if (main && runs.Windows() < kMinimumWindows) {
        return Refusal{"recording",
                       "only " + std::to_string(runs.Windows()) + " windows of five seconds",
                       "record a minute or more without gaps"};
      }
      if (main && nominal.empty()) {
        return Refusal{"reference", "no window of five seconds without gaps",
                       "name reference logs of a minute or more"};
      }
      if (runs.Windows() == 0 || nominal.empty()) continue;
      if (main) {
        main_ = runs_.size();
      }
      reference_runs_.push_back(std::move(nominal));
      runs_.push_back(std::move(runs));
    }
    return std::nullopt;
  }

  DiagnosedModel Conclude(const DiagnosisProblem& problem, const Hypotheses& hypotheses) {
    const EffectFit& best = BestHypothesis(hypotheses);
    const FoldFits folds = FitOnFolds(best, problem);
    const CrossValidatedErrors cross_validated = CrossValidatedErrorsOf(folds, runs_[main_], boat_);
    const std::optional<ExcessExplained> excess_explained =
        ExcessExplainedAt(main_, cross_validated, kAllChannels);
    const LackOfFit lack_of_fit = AssessLackOfFit(best, cross_validated, problem);
    const GapAssessment assessment = AssessMainGap(best, lack_of_fit);
    const Ranking ranking = Rank(hypotheses, problem.metric, lack_of_fit);
    DiagnosedModel diagnosed;
    Diagnosis& diagnosis = diagnosed.diagnosis;
    diagnosis.verdict = VerdictOf(assessment, ranking, excess_explained);
    const bool likely = IsLikely(assessment, ranking);
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      std::optional<CrossValidatedErrors> after;
      if (likely)
        after = i == main_ ? cross_validated : CrossValidatedErrorsOf(folds, runs_[i], boat_);
      diagnosis.gaps.push_back(GapAt(i, after));
    }
    diagnosis.effects = TestabilityOf(problem, model_, library_);
    if (assessment == GapAssessment::kMaterial) {
      ReportProgress("where", 0.85);
      diagnosis.where = Localise(recording_, references_, boat_, options_.seed);
      diagnosis.rest = UnexplainedLocation(diagnosis, best);
      ListCauses(ranking, folds, excess_explained, problem, diagnosis);
      if (options_.advise) Advise(ranking, problem.nominal, diagnosis);
    }
    if (assessment == GapAssessment::kUndecided) {
      diagnosis.notes.emplace_back(
          "No effect of the library explains enough of it, and weather or what the references "
          "leave open of the boat may account for it: record longer, or name more references.");
    }
    if (likely) {
      diagnosis.onset = OnsetOf(best, problem);
      const AugmentedModel boat = Reidentified(best, problem, model_);
      diagnosed.augmented = Augmented(identification_, boat, best, problem, model_);
      diagnosis.improvement = ImprovementBy(boat);
    }
    FillPictures(likely ? std::optional(cross_validated) : std::nullopt, folds.front(), diagnosis);
    Describe(diagnosis);
    ReportProgress("done", 1.0);
    return diagnosed;
  }

  GapAssessment AssessMainGap(const EffectFit& best, const LackOfFit& lack_of_fit) const {
    const NoiseFloor& floor = floors_[main_];
    const Eigen::VectorXd gaps = SquaredGaps(errors_[main_], floor.scale, kAllChannels);
    return AssessGap(gaps.mean(), UpperBound(gaps, BlocksOf(runs_[main_]), options_.seed),
                     floor.SquaredLimit(kAllChannels), best.score, lack_of_fit);
  }

  static const EffectFit& BestHypothesis(const Hypotheses& hypotheses) {
    const EffectFit& single = hypotheses.singles.front();
    if (hypotheses.combined.empty()) return single;
    return hypotheses.combined.front().score < single.score ? hypotheses.combined.front() : single;
  }

  Gap GapAt(std::size_t horizon, const std::optional<CrossValidatedErrors>& after) const {
    const FreeRuns& runs = runs_[horizon];
    const NoiseFloor& floor = floors_[horizon];
    Gap gap;
    gap.horizon_s = runs.HorizonS();
    gap.windows = runs.Windows();
    for (int channel = 0; channel <= kAllChannels; ++channel) {
      const Eigen::VectorXd before = SquaredGaps(errors_[horizon], floor.scale, channel);
      const Eigen::VectorXd then =
          after ? CrossValidatedSquaredGaps(*after, runs, floor, channel) : before;
      const GapSize size = SizeOf(before, then, floor, channel);
      std::optional<ExcessExplained> excess_explained;
      if (after) excess_explained = ExcessExplainedAt(horizon, *after, channel);
      if (channel == kAllChannels) {
        gap.all = size;
        gap.excess_explained = excess_explained;
      } else {
        gap.channels[static_cast<std::size_t>(channel)] = size;
        gap.channel_excess_explained[static_cast<std::size_t>(channel)] = excess_explained;
      }
    }
    return gap;
  }

  std::optional<ExcessExplained> ExcessExplainedAt(std::size_t horizon,
                                                   const CrossValidatedErrors& after,
                                                   int channel) const {
    const FreeRuns& runs = runs_[horizon];
    const NoiseFloor& floor = floors_[horizon];
    return ExcessExplainedBy(SquaredGaps(errors_[horizon], floor.scale, channel),
                             CrossValidatedSquaredGaps(after, runs, floor, channel), BlocksOf(runs),
                             floor, channel, options_.seed);
  }

  void ListCauses(const Ranking& ranking, const FoldFits& best_folds,
                  const std::optional<ExcessExplained>& best_excess_explained,
                  const DiagnosisProblem& problem, Diagnosis& diagnosis) const {
    constexpr std::size_t kListed = 5;
    constexpr double kMinimumListedProbability = 0.001;
    for (const RankedHypothesis& ranked : ranking.fits) {
      const bool first = diagnosis.causes.empty();
      if (diagnosis.causes.size() == kListed ||
          (!first && ranked.probability < kMinimumListedProbability))
        break;
      Cause& cause = diagnosis.causes.emplace_back();
      cause.probability = ranked.probability;
      cause.indistinguishable = ranked.Indistinguishable();
      cause.effects = EffectsOf(ranked.fit);
      if (first) {
        if (cause.effects.size() > 1) AssignShapleyShares(best_folds, cause.effects);
        cause.excess_explained = best_excess_explained;
        continue;
      }
      const FoldFits folds = FitOnFolds(ranked.fit, problem);
      cause.excess_explained = ExcessExplainedAt(
          main_, CrossValidatedErrorsOf(folds, runs_[main_], boat_), kAllChannels);
    }
    Cause unknown;
    unknown.probability = ranking.unknown + ranking.no_effect;
    diagnosis.causes.push_back(unknown);
    std::stable_sort(diagnosis.causes.begin(), diagnosis.causes.end(),
                     [](const Cause& a, const Cause& b) { return a.probability > b.probability; });
  }

  /// Where what stays unexplained sits.
  std::string UnexplainedLocation(const Diagnosis& diagnosis, const EffectFit& best) const {
    if (diagnosis.verdict == Verdict::kExplained) return "";
    std::vector<GapCell> cells = diagnosis.where;
    if (diagnosis.verdict == Verdict::kPartlyExplained) {
      cells = Localise(recording_, references_, boat_.With(best.effects), options_.seed);
    }
    for (const GapCell& cell : cells) {
      if (!cell.region && cell.bin.empty()) continue;
      std::string place(telltale::Name(cell.channel));
      if (cell.region) place.append(", ").append(telltale::Name(*cell.region));
      if (!cell.bin.empty()) place.append(", ").append(cell.bin);
      return place;
    }
    return "";
  }

  void Advise(const Ranking& ranking, const NominalBaseline& nominal, Diagnosis& diagnosis) const {
    const RankedHypothesis& first = ranking.fits.front();
    if (first.equivalent.empty()) return;
    diagnosis.advice =
        AdviseSeparatingManoeuvres(first, nominal, recording_.sampling_period_s, recording_.hull);
    const bool decisive = !diagnosis.advice.empty() && diagnosis.advice.front().decisive;
    if (!decisive) {
      diagnosis.notes.push_back("No manoeuvre of the catalogue is sure to separate what is tied. " +
                                AdviseSensor(first));
    }
  }

  static std::vector<CausalEffect> EffectsOf(const EffectFit& fit) {
    std::vector<CausalEffect> effects;
    Eigen::Index i = 0;
    for (const auto& [effect, values] : fit.effects) {
      CausalEffect& causal = effects.emplace_back();
      causal.effect = effect->Name();
      causal.sentence = effect->Describe(values);
      for (std::size_t j = 0; j < values.size(); ++j, ++i) {
        const EffectParameter& parameter = effect->Parameters()[j];
        causal.parameters.push_back({std::string(parameter.name), values[j],
                                     std::sqrt(std::max(fit.covariance(i, i), 0.0)),
                                     std::string(parameter.unit)});
      }
    }
    return effects;
  }

  /// Shapley values: what each effect closes on average over the orders in which they may be added.
  void AssignShapleyShares(const FoldFits& folds, std::vector<CausalEffect>& effects) const {
    const FreeRuns& runs = runs_[main_];
    const std::size_t n = effects.size();
    std::vector<double> closed(std::size_t{1} << n);
    const auto squared = [&](std::size_t subset) {
      FoldFits some = folds;
      for (EffectFit& fit : some) {
        std::vector<ModelledEffect> kept;
        for (std::size_t i = 0; i < n; ++i) {
          if ((subset >> i) & 1) kept.push_back(fit.effects[i]);
        }
        fit.effects = kept;
      }
      const CrossValidatedErrors cross_validated = CrossValidatedErrorsOf(some, runs, boat_);
      return CrossValidatedSquaredGaps(cross_validated, runs, floors_[main_], kAllChannels).mean();
    };
    const double none = squared(0);
    for (std::size_t subset = 0; subset < closed.size(); ++subset) {
      closed[subset] = none - squared(subset);
    }
    const double all = closed.back();
    const std::array<std::vector<double>, 4> kWeights = {
        std::vector<double>{}, {1.0}, {0.5, 0.5}, {1.0 / 3.0, 1.0 / 6.0, 1.0 / 3.0}};
    for (std::size_t i = 0; i < n; ++i) {
      double share = 0.0;
      for (std::size_t subset = 0; subset < closed.size(); ++subset) {
        if ((subset >> i) & 1) continue;
        const auto before = static_cast<std::size_t>(__builtin_popcountll(subset));
        share += kWeights[n][before] * (closed[subset | (std::size_t{1} << i)] - closed[subset]);
      }
      effects[i].shapley_share = all != 0.0 ? share / all : 0.0;
    }
  }

  std::optional<Improvement> ImprovementBy(const AugmentedModel& boat) const {
    const auto before = telltale::Validate(recording_, model_.model, {});
    const auto after = telltale::Validate(recording_, boat, {});
    if (!before || !after) return std::nullopt;
    return Improvement{before->free_run, after->free_run};
  }

  void FillPictures(const std::optional<CrossValidatedErrors>& cross_validated,
                    const EffectFit& fit, Diagnosis& diagnosis) const {
    const FreeRuns& runs = runs_[main_];
    const NoiseFloor& floor = floors_[main_];
    const Eigen::MatrixXd& errors = errors_[main_];
    const Eigen::VectorXd before = SquaredGaps(errors, floor.scale, kAllChannels);
    Eigen::VectorXd after = before;
    Eigen::MatrixXd errors_after = errors;
    AugmentedModel with = boat_;
    if (cross_validated) {
      after = CrossValidatedSquaredGaps(*cross_validated, runs, floor, kAllChannels);
      errors_after = cross_validated->errors;
      with = boat_.With(fit.effects);
    }
    const auto tracks_before = runs.Tracks(boat_);
    const auto tracks_after = runs.Tracks(with);
    for (std::size_t w = 0; w < runs.Windows(); ++w) {
      const auto i = static_cast<Eigen::Index>(w);
      const FreeRuns::Circumstances went = runs.Of(w);
      WindowPicture& picture = diagnosis.pictures.emplace_back();
      picture.time_s = went.time_s;
      picture.before = std::sqrt(before[i]);
      picture.after = std::sqrt(std::max(after[i], 0.0));
      picture.error_before = errors.col(i).tail<3>();
      picture.error_after = errors_after.col(i).tail<3>();
      picture.predicted_before = tracks_before[w];
      picture.predicted_after = tracks_after[w];
      for (std::size_t k = 0; k <= went.rows; ++k) {
        const PreparedRow& row = recording_.rows[went.first_row + k];
        picture.measured.emplace_back(row.eta.x_m, row.eta.y_m);
        picture.psi_rad += row.eta.psi_rad / static_cast<double>(went.rows + 1);
        picture.speed_m_s += std::hypot(row.nu.u, row.nu.v) / static_cast<double>(went.rows + 1);
      }
      picture.region = recording_.rows[went.first_row + went.rows / 2].region;
    }
  }

  void Describe(Diagnosis& diagnosis) const {
    diagnosis.start_s = recording_.StartTime();
    diagnosis.end_s = recording_.EndTime();
    diagnosis.seed = options_.seed;
    diagnosis.software_version = Version();
  }

  const PreparedDataset& recording_;
  const std::vector<PreparedDataset>& references_;
  const Identification& identification_;
  const UncertainModel& model_;
  const DiagnoseOptions& options_;
  const Progress& progress_;
  std::vector<const Effect*> library_;
  std::vector<EffectParameterRef> parameter_refs_;
  std::vector<FreeRuns> runs_;                         ///< of the recording, by horizon
  std::size_t main_ = 0;                               ///< which of them is of kMainHorizonS
  std::vector<std::vector<FreeRuns>> reference_runs_;  ///< of the references, by horizon
  AugmentedModel boat_;                                ///< the model as nominal days recalibrate it
  std::vector<NoiseFloor> floors_;
  std::vector<Eigen::MatrixXd> errors_;  ///< of the boat on the recording, by horizon
};

}  // namespace

std::optional<Refusal> DiagnoseOptions::Validate() const {
  auto refusal = OutOfRange(kSubject, "most_effects", static_cast<double>(most_effects), 1.0, 3.0);
  if (refusal) return refusal;
  refusal = OutOfRange(kSubject, "threads", static_cast<double>(threads), 1.0, 256.0);
  if (refusal) return refusal;
  for (const std::string& name : without) {
    if (FindEffect(name) != nullptr) continue;
    std::string known;
    for (const Effect* effect : EffectLibrary()) {
      known.append(known.empty() ? "" : ", ").append(effect->Name());
    }
    return Refusal{"without", "there is no effect \"" + name + "\"", "name one of " + known};
  }
  return std::nullopt;
}

Result<DiagnosedModel> Diagnose(const PreparedDataset& recording,
                                const std::vector<PreparedDataset>& references,
                                const Identification& model, const std::string& vehicle_id,
                                const DiagnoseOptions& options, const Progress& progress) {
  if (auto refusal = options.Validate()) return tl::unexpected<Refusal>(*std::move(refusal));
  const auto uncertain = UncertainModelOf(model);
  if (!uncertain) return tl::unexpected<Refusal>(uncertain.error());
  if (!model.vehicle_id.empty() && !vehicle_id.empty() && model.vehicle_id != vehicle_id) {
    return Refuse("model", "it is of " + model.vehicle_id + ", the recording of " + vehicle_id,
                  "name a model of the same boat");
  }
  if (auto refusal = CheckRecording(recording)) return tl::unexpected<Refusal>(*std::move(refusal));
  if (auto refusal = SuspectedWiringFault(recording, uncertain->model)) {
    return tl::unexpected<Refusal>(*std::move(refusal));
  }
  const std::vector<PreparedDataset> synthetic_references =
      references.empty() ? SyntheticReferences(recording, uncertain->model, options.seed)
                         : std::vector<PreparedDataset>{};
  if (references.empty() && synthetic_references.empty()) {
    return Refuse("model", "it runs away when it sails this recording",
                  "identify the boat again, or name reference logs");
  }
  DiagnosisRun diagnosis_run(recording, references.empty() ? synthetic_references : references,
                             model, *uncertain, options, progress);
  auto diagnosed = diagnosis_run.Run();
  if (!diagnosed) return diagnosed;
  Diagnosis& diagnosis = diagnosed->diagnosis;
  diagnosis.vehicle_id = vehicle_id;
  diagnosis.floor_basis =
      references.empty() ? FloorBasis::kSensorNoise : FloorBasis::kReferenceLogs;
  diagnosis.reference_logs = references.size();
  if (!references.empty() && references.size() < 3) {
    diagnosis.notes.emplace_back(
        "Fewer than three reference logs: how much nominal days differ "
        "is mostly assumed.");
  }
  diagnosis.sentence = SummarySentence(diagnosis);
  return diagnosed;
}

}  // namespace telltale
