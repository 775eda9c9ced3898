#include "telltale/core/diagnosis/diagnose.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "telltale/core/diagnosis/augmented_identification.hpp"
#include "telltale/core/diagnosis/gap.hpp"
#include "telltale/core/diagnosis/held_out.hpp"
#include "telltale/core/diagnosis/onset.hpp"
#include "telltale/core/diagnosis/ranking.hpp"
#include "telltale/core/diagnosis/remainder.hpp"
#include "telltale/core/diagnosis/search.hpp"
#include "telltale/core/diagnosis/sentence.hpp"
#include "telltale/core/diagnosis/separation.hpp"
#include "telltale/core/diagnosis/testability.hpp"
#include "telltale/core/diagnosis/where.hpp"
#include "telltale/core/diagnosis/wiring.hpp"
#include "telltale/core/range.hpp"
#include "telltale/core/simulation/dataset_twin.hpp"

namespace telltale {
namespace {

constexpr std::string_view kSubject = "options";
constexpr std::array kHorizonsS = {1.0, 5.0, 10.0};
constexpr double kMainHorizonS = 5.0;
constexpr std::size_t kTwins = 4;
constexpr std::size_t kFewestWindows = 12;
constexpr double kAtRest = 0.05;  // m/s and rad/s: whatever goes slower than this has not sailed

std::vector<const Effect*> LibraryWithout(const std::vector<std::string>& names) {
  std::vector<const Effect*> library;
  for (const Effect* effect : EffectLibrary()) {
    if (std::find(names.begin(), names.end(), effect->Name()) == names.end()) {
      library.push_back(effect);
    }
  }
  return library;
}

std::optional<Refusal> Undiagnosable(const PreparedDataset& recording) {
  double sailed_s = 0.0;
  for (const RowRange& stretch : recording.stretches) {
    sailed_s += static_cast<double>(stretch.size()) * recording.sampling_period_s;
  }
  if (sailed_s < kShortestDiagnosedS) {
    return Refusal{"recording", "it is " + std::to_string(std::lround(sailed_s)) + " s long",
                   "record at least " + std::to_string(std::lround(kShortestDiagnosedS)) + " s"};
  }
  const Nu fastest = FastestOf(recording);
  if (std::max({fastest.u, fastest.v, fastest.r}) < kAtRest) {
    return Refusal{"recording", "the boat is at rest throughout", "sail while recording"};
  }
  return std::nullopt;
}

/// What sensor noise alone would leave of the recording, sailed by the model itself.
std::vector<PreparedDataset> Twins(const PreparedDataset& recording, const VesselModel& model,
                                   std::uint64_t seed) {
  std::vector<PreparedDataset> twins;
  for (std::size_t i = 0; i < kTwins; ++i) {
    TwinOptions options;
    options.seed = seed + i;
    if (auto twin = SailAgain(recording, model, options)) twins.push_back(*std::move(twin));
  }
  return twins;
}

GapSize SizeOf(const Eigen::VectorXd& before, const Eigen::VectorXd& after, const Floor& floor,
               int channel) {
  GapSize size;
  size.before = std::sqrt(before.mean());
  size.after = std::sqrt(std::max(after.mean(), 0.0));
  size.noise_floor = std::sqrt(floor.Squared(channel));
  size.floor_limit = std::sqrt(floor.SquaredLimit(channel));
  return size;
}

class Diagnosing {
 public:
  Diagnosing(const PreparedDataset& recording, const std::vector<PreparedDataset>& references,
             const Identification& identification, const UncertainModel& model,
             const DiagnoseOptions& options, const Progress& progress)
      : recording_(recording),
        references_(references),
        identification_(identification),
        model_(model),
        options_(options),
        progress_(progress),
        library_(LibraryWithout(options.without)),
        slots_(SlotsOf(library_)) {}

  Result<DiagnosedModel> Run() {
    Tell("free runs", 0.0);
    if (auto refusal = FreeRunEverywhere()) return tl::unexpected<Refusal>(*std::move(refusal));
    Tell("healthy boat", 0.1);
    const Healthy healthy = LearnHealthy(healthy_at_[main_], model_, slots_, options_.threads);
    boat_ = healthy.boat;
    for (const std::vector<FreeRuns>& runs : healthy_at_) floors_.push_back(FloorOf(runs, boat_));
    for (const FreeRuns& runs : runs_) errors_.push_back(runs.Errors(boat_));
    Tell("sensitivities", 0.35);
    const Sensitivity sensitivity =
        SensitivityOf(runs_[main_], healthy.boat, model_, slots_, options_.threads);
    const Judge judge(healthy, sensitivity, EveryWindow(sensitivity), options_.refit);
    const Swings swings(library_, runs_[main_], healthy.boat, sensitivity.errors, options_.threads);
    const Evidence evidence{runs_[main_], healthy, sensitivity, judge, slots_, swings};
    const Explanations explanations =
        Search(evidence, library_, options_.most_effects, options_.threads,
               [&](double share) { Tell("effects", 0.4 + 0.4 * share); });
    return Conclude(evidence, explanations);
  }

 private:
  void Tell(std::string_view stage, double share) const {
    if (progress_) progress_(stage, share);
  }

  /// At every horizon that leaves windows in all recordings.
  std::optional<Refusal> FreeRunEverywhere() {
    for (const double horizon_s : kHorizonsS) {
      FreeRuns runs(recording_, model_.model, horizon_s);
      std::vector<FreeRuns> healthy;
      for (const PreparedDataset& reference : references_) {
        FreeRuns of_reference(reference, model_.model, horizon_s);
        if (of_reference.Windows() > 0) healthy.push_back(std::move(of_reference));
      }
      const bool main = horizon_s == kMainHorizonS;
      if (main && runs.Windows() < kFewestWindows) {
        return Refusal{"recording",
                       "only " + std::to_string(runs.Windows()) + " windows of five seconds",
                       "record a minute or more without gaps"};
      }
      if (main && healthy.empty()) {
        return Refusal{"reference", "no window of five seconds without gaps",
                       "name reference logs of a minute or more"};
      }
      if (runs.Windows() == 0 || healthy.empty()) continue;
      if (main) {
        main_ = runs_.size();
      }
      healthy_at_.push_back(std::move(healthy));
      runs_.push_back(std::move(runs));
    }
    return std::nullopt;
  }

  DiagnosedModel Conclude(const Evidence& evidence, const Explanations& explanations) {
    const EffectFit& best = BestOf(explanations);
    const FoldFits folds = FitOnFolds(best, evidence);
    const HeldOutErrors held = ErrorsHeldOut(folds, runs_[main_], boat_);
    const std::optional<Closure> closure = ClosureAt(main_, held, kAllChannels);
    const Remainder remainder = RemainderOf(best, held, evidence);
    const Gate gate = GateAtMainHorizon(best, remainder);
    const Ranking ranking = Rank(explanations, evidence.judge, remainder);
    DiagnosedModel diagnosed;
    Diagnosis& diagnosis = diagnosed.diagnosis;
    diagnosis.verdict = VerdictOf(gate, ranking, closure);
    const bool likely = IsLikely(gate, ranking);
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      std::optional<HeldOutErrors> after;
      if (likely) after = i == main_ ? held : ErrorsHeldOut(folds, runs_[i], boat_);
      diagnosis.gaps.push_back(GapAt(i, after));
    }
    diagnosis.effects = TestabilityOf(evidence, model_, library_);
    if (gate == Gate::kMaterial) {
      Tell("where", 0.85);
      diagnosis.where = Localise(recording_, references_, boat_, options_.seed);
      diagnosis.rest = RestOf(diagnosis, best);
      ListCauses(ranking, folds, closure, evidence, diagnosis);
      if (options_.advise) Advise(ranking, evidence.healthy, diagnosis);
    }
    if (gate == Gate::kUndecided) {
      diagnosis.notes.emplace_back(
          "No effect of the library explains enough of it, and weather or what the references "
          "leave open of the boat may account for it: record longer, or name more references.");
    }
    if (likely) {
      diagnosis.onset = OnsetOf(best, evidence);
      const AugmentedModel boat = Reidentified(best, evidence, model_);
      diagnosed.augmented = Augmented(identification_, boat, best, evidence, model_);
      diagnosis.improvement = ImprovementBy(boat);
    }
    Draw(likely ? std::optional(held) : std::nullopt, folds.front(), diagnosis);
    Describe(diagnosis);
    Tell("done", 1.0);
    return diagnosed;
  }

  Gate GateAtMainHorizon(const EffectFit& best, const Remainder& remainder) const {
    const Floor& floor = floors_[main_];
    const Eigen::VectorXd gaps = SquaredGaps(errors_[main_], floor.scale, kAllChannels);
    return GateOf(gaps.mean(), UpperBound(gaps, BlocksOf(runs_[main_]), options_.seed),
                  floor.SquaredLimit(kAllChannels), best.score, remainder);
  }

  static const EffectFit& BestOf(const Explanations& explanations) {
    const EffectFit& single = explanations.singles.front();
    if (explanations.together.empty()) return single;
    return explanations.together.front().score < single.score ? explanations.together.front()
                                                              : single;
  }

  Gap GapAt(std::size_t horizon, const std::optional<HeldOutErrors>& after) const {
    const FreeRuns& runs = runs_[horizon];
    const Floor& floor = floors_[horizon];
    Gap gap;
    gap.horizon_s = runs.HorizonS();
    gap.windows = runs.Windows();
    for (int channel = 0; channel <= kAllChannels; ++channel) {
      const Eigen::VectorXd before = SquaredGaps(errors_[horizon], floor.scale, channel);
      const Eigen::VectorXd then =
          after ? SquaredGapsHeldOut(*after, runs, floor, channel) : before;
      const GapSize size = SizeOf(before, then, floor, channel);
      std::optional<Closure> closure;
      if (after) closure = ClosureAt(horizon, *after, channel);
      if (channel == kAllChannels) {
        gap.all = size;
        gap.closure = closure;
      } else {
        gap.channels[static_cast<std::size_t>(channel)] = size;
        gap.channel_closures[static_cast<std::size_t>(channel)] = closure;
      }
    }
    return gap;
  }

  std::optional<Closure> ClosureAt(std::size_t horizon, const HeldOutErrors& after,
                                   int channel) const {
    const FreeRuns& runs = runs_[horizon];
    const Floor& floor = floors_[horizon];
    return ClosureOf(SquaredGaps(errors_[horizon], floor.scale, channel),
                     SquaredGapsHeldOut(after, runs, floor, channel), BlocksOf(runs), floor,
                     channel, options_.seed);
  }

  void ListCauses(const Ranking& ranking, const FoldFits& best_folds,
                  const std::optional<Closure>& best_closure, const Evidence& evidence,
                  Diagnosis& diagnosis) const {
    constexpr std::size_t kListed = 5;
    constexpr double kWorthListing = 0.001;
    for (const RankedFit& ranked : ranking.fits) {
      const bool first = diagnosis.causes.empty();
      if (diagnosis.causes.size() == kListed || (!first && ranked.probability < kWorthListing))
        break;
      Cause& cause = diagnosis.causes.emplace_back();
      cause.probability = ranked.probability;
      cause.indistinguishable = ranked.Indistinguishable();
      cause.effects = EffectsOf(ranked.fit);
      if (first) {
        if (cause.effects.size() > 1) ShareOut(best_folds, cause.effects);
        cause.closure = best_closure;
        continue;
      }
      const FoldFits folds = FitOnFolds(ranked.fit, evidence);
      cause.closure = ClosureAt(main_, ErrorsHeldOut(folds, runs_[main_], boat_), kAllChannels);
    }
    Cause unknown;
    unknown.probability = ranking.unknown + ranking.nothing;
    diagnosis.causes.push_back(unknown);
    std::stable_sort(diagnosis.causes.begin(), diagnosis.causes.end(),
                     [](const Cause& a, const Cause& b) { return a.probability > b.probability; });
  }

  /// Where what stays unexplained sits.
  std::string RestOf(const Diagnosis& diagnosis, const EffectFit& best) const {
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

  void Advise(const Ranking& ranking, const Healthy& healthy, Diagnosis& diagnosis) const {
    const RankedFit& first = ranking.fits.front();
    if (first.alike.empty()) return;
    diagnosis.advice = AdviseSeparation(first, healthy, recording_.sampling_period_s);
    const bool promised = !diagnosis.advice.empty() && diagnosis.advice.front().promised;
    if (!promised) {
      diagnosis.notes.push_back("No manoeuvre of the catalogue is sure to separate what is tied. " +
                                SensorThatSettles(first));
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
  void ShareOut(const FoldFits& folds, std::vector<CausalEffect>& effects) const {
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
      const HeldOutErrors held = ErrorsHeldOut(some, runs, boat_);
      return SquaredGapsHeldOut(held, runs, floors_[main_], kAllChannels).mean();
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

  void Draw(const std::optional<HeldOutErrors>& held, const EffectFit& fit,
            Diagnosis& diagnosis) const {
    const FreeRuns& runs = runs_[main_];
    const Floor& floor = floors_[main_];
    const Eigen::MatrixXd& errors = errors_[main_];
    const Eigen::VectorXd before = SquaredGaps(errors, floor.scale, kAllChannels);
    Eigen::VectorXd after = before;
    Eigen::MatrixXd errors_after = errors;
    AugmentedModel with = boat_;
    if (held) {
      after = SquaredGapsHeldOut(*held, runs, floor, kAllChannels);
      errors_after = held->errors;
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
    diagnosis.software_version = TELLTALE_VERSION;
  }

  const PreparedDataset& recording_;
  const std::vector<PreparedDataset>& references_;
  const Identification& identification_;
  const UncertainModel& model_;
  const DiagnoseOptions& options_;
  const Progress& progress_;
  std::vector<const Effect*> library_;
  std::vector<Slot> slots_;
  std::vector<FreeRuns> runs_;                     ///< of the recording, by horizon
  std::size_t main_ = 0;                           ///< which of them is of kMainHorizonS
  std::vector<std::vector<FreeRuns>> healthy_at_;  ///< of the references, by horizon
  AugmentedModel boat_;                            ///< the model as healthy days recalibrate it
  std::vector<Floor> floors_;
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
  if (auto refusal = Undiagnosable(recording)) return tl::unexpected<Refusal>(*std::move(refusal));
  if (auto refusal = MisWired(recording, uncertain->model)) {
    return tl::unexpected<Refusal>(*std::move(refusal));
  }
  const std::vector<PreparedDataset> twins = references.empty()
                                                 ? Twins(recording, uncertain->model, options.seed)
                                                 : std::vector<PreparedDataset>{};
  if (references.empty() && twins.empty()) {
    return Refuse("model", "it runs away when it sails this recording",
                  "identify the boat again, or name reference logs");
  }
  Diagnosing diagnosing(recording, references.empty() ? twins : references, model, *uncertain,
                        options, progress);
  auto diagnosed = diagnosing.Run();
  if (!diagnosed) return diagnosed;
  Diagnosis& diagnosis = diagnosed->diagnosis;
  diagnosis.vehicle_id = vehicle_id;
  diagnosis.floor_basis =
      references.empty() ? FloorBasis::kSensorNoise : FloorBasis::kReferenceLogs;
  diagnosis.reference_logs = references.size();
  if (!references.empty() && references.size() < 3) {
    diagnosis.notes.emplace_back(
        "Fewer than three reference logs: how much healthy days differ "
        "is mostly assumed.");
  }
  diagnosis.sentence = SentenceOf(diagnosis);
  return diagnosed;
}

}  // namespace telltale
