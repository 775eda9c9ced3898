// Does a 95 % bound hold 95 % of the time? Prints the table of docs/validation/coverage.md.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "coverage/replicates.hpp"
#include "telltale/core/base/gauss_markov.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/estimation/regression/excitation.hpp"
#include "telltale/core/estimation/regression/lagged_regression.hpp"
#include "telltale/core/estimation/regression/one_step.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/identification/clock_alignment.hpp"
#include "telltale/core/uncertainty/bootstrap.hpp"
#include "telltale/core/uncertainty/bootstrap_correction.hpp"
#include "telltale/core/uncertainty/clustered_fit.hpp"
#include "telltale/core/uncertainty/distributions.hpp"
#include "telltale/core/uncertainty/prediction_band.hpp"

namespace telltale::coverage {
namespace {

/// With the noise and disturbance that parametric replicates assume, relative to the truth.
struct CoverageScenario : Scenario {
  double assumed_noise = 1.0;
  double assumed_time = 1.0;
};

std::vector<CoverageScenario> Scenarios() {
  std::vector<CoverageScenario> all(17);
  all[0].name = "rtk";
  all[1].name = "plain-gnss";
  all[1].environment.position_noise_m = 0.10;
  all[1].environment.heading_noise_deg = 0.5;
  all[2].name = "coloured-gnss";
  all[2].environment.position_drift_m = 0.2;
  all[2].environment.position_drift_time_s = 20.0;
  all[3].name = "ten-segments";
  all[3].mission.segments = 10;
  all[4].name = "noise-30-percent-wrong";
  all[4].assumed_noise = 1.3;
  all[5].name = "disturbance-time-wrong";
  all[5].assumed_time = 0.5;
  all[6].name = "thruster-lag";
  all[6].boat.thruster_time_constant_s = 0.4;
  all[7].name = "weak-excitation";
  all[7].mission.command_share = 0.5;
  all[8].name = "propeller-outside-class";
  all[8].boat.thrust_bend = 0.3;
  all[9].name = "three-segments";
  all[9].mission.segments = 3;
  all[10].name = "calm";
  all[10].environment = Disturbed(0.1);
  all[11].name = "still";
  all[11].environment = Disturbed(0.0);
  all[12].name = "commands-sampled";
  all[12].environment.clocks.sampled = true;
  all[13].name = "offsets";
  all[13].environment.clocks.command_delay_s = -0.1;
  all[13].environment.clocks.least_fix_delay_s = 0.1;
  all[13].environment.clocks.greatest_fix_delay_s = 0.1;
  all[14].name = "jitter";
  all[14].environment.clocks.jitter_s = 0.02;
  all[15].name = "fixes-on-arrival";
  all[15].environment.clocks.least_fix_delay_s = 0.05;
  all[15].environment.clocks.greatest_fix_delay_s = 0.25;
  all[16].name = "commands-at-2-hz";
  all[16].environment.clocks.command_period_s = 0.5;
  all[16].environment.clocks.sampled = true;
  return all;
}

std::vector<std::string> NamesOf(const Scenario& scenario) {
  std::vector<std::string> names;
  if (scenario.Lags()) names.emplace_back("tau");
  for (const Equation equation : kEquations) {
    for (const Regressor& regressor : Regressors(equation, Parameterization::kPropeller)) {
      names.push_back(std::string(Name(equation)) + ' ' + std::string(regressor.name));
    }
  }
  return names;
}

/// The outcome of one replicate by one method: which true values its bounds contain.
struct CoverageOutcome {
  std::vector<bool> coefficient;
  Eigen::VectorXd error;
  bool joint = false;
  std::size_t in_band = 0;
  std::size_t of_band = 0;
};

struct ReplicateResult {
  std::optional<CoverageOutcome> weak;
  std::optional<CoverageOutcome> one_step;
};

template <class Value>
Value Answered(Result<Value> answer) {
  if (!answer) throw std::runtime_error(answer.error().reason);
  return *std::move(answer);
}

CoverageOutcome CompareWithTruth(const Eigen::VectorXd& theta, const Eigen::VectorXd& half_width,
                                 const Eigen::VectorXd& truth) {
  CoverageOutcome outcome{{}, theta - truth};
  for (Eigen::Index j = 0; j < truth.size(); ++j) {
    outcome.coefficient.push_back(std::abs(outcome.error[j]) <= half_width[j]);
  }
  return outcome;
}

/// Free runs of 10 s from a known state: does the band hold the boat's velocities at 1, 5, 10 s?
void CheckPredictionBand(const Scenario& scenario, const WeakFit& fit,
                         const BootstrapCorrection& corrected, std::uint64_t seed,
                         CoverageOutcome& outcome) {
  constexpr std::size_t kDraws = 400;
  constexpr double kStepS = 0.1;
  const TrueRun run =
      SimulateTrueRun(scenario.boat, scenario.environment, scenario.mission, 10.0, kStepS, seed);
  const Eigen::MatrixXd root = corrected.covariance.llt().matrixL();
  WhiteSource white(seed, 1000);
  std::vector<VesselModel> models;
  for (std::size_t i = 0; i < kDraws; ++i) {
    Eigen::VectorXd z(root.rows());
    for (double& value : z) value = white();
    models.push_back(ModelOf(fit, corrected.theta + root * z, 0.2));
  }
  std::vector<TimedCommand> commands;
  for (std::size_t i = 0; i < run.commands.size(); ++i) {
    commands.push_back({run.command_times_s[i], {run.commands[i][0], run.commands[i][1]}});
  }
  VesselState start;
  start.nu = {run.start[0], run.start[1], run.start[2]};
  start.thrust = models.front().SteadyThrust(commands.front().delta);
  const PredictionBand band =
      PredictBand(models, start, commands, corrected.disturbance, 10.0, kStepS, 0.95, seed);
  for (const Eigen::Index k : {9, 49, 99}) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double nu = run.nu[static_cast<std::size_t>(k)][static_cast<std::size_t>(axis)];
      outcome.in_band += nu >= band.lower(axis, k) && nu <= band.upper(axis, k) ? 1 : 0;
      ++outcome.of_band;
    }
  }
}

std::optional<CoverageOutcome> RunWeakIv(const CoverageScenario& scenario,
                                         const Recording& recording,
                                         std::size_t parametric_replicates, std::uint64_t seed) {
  IdentifyOptions identify;
  RegressionOptions& regression = identify.regression;
  if (scenario.Lags()) regression.structure = Structure::kFirstOrderDynamic;
  const WeakIvOptions& options = identify.weak_iv;
  const PreparedDataset dataset =
      Answered(PrepareWithClocksAligned(recording, VehicleOf(), identify)).dataset;
  const auto columns = AllColumns(Parameterization::kPropeller);
  const auto fit = EstimateWeakIv(dataset, regression, columns, options);
  if (!fit) return std::nullopt;
  const auto corrected = CorrectByParametricBootstrap(
      dataset, regression, *fit, columns, options,
      {parametric_replicates, seed, 1, scenario.assumed_noise, scenario.assumed_time});
  if (!corrected) return std::nullopt;
  const Eigen::VectorXd truth = TruthOf(scenario);
  const double t = StudentQuantile(corrected->degrees_of_freedom, 0.975);
  const Eigen::VectorXd standard_errors = corrected->covariance.diagonal().cwiseSqrt();
  CoverageOutcome outcome = CompareWithTruth(
      corrected->theta, t * corrected->interval_factors.cwiseProduct(standard_errors), truth);
  const double distance = outcome.error.dot(corrected->covariance.ldlt().solve(outcome.error));
  outcome.joint =
      distance <= SquaredRadius(corrected->joint, static_cast<std::size_t>(truth.size()), 0.95);
  CheckPredictionBand(scenario, *fit, *corrected, seed + 1, outcome);
  return outcome;
}

/// One-step least squares: an equation each, or all of them with the time constant first. Nothing
/// when an equation is not excited.
std::optional<std::vector<ClusteredFit>> FitOneStep(const Scenario& scenario,
                                                    const PreparedDataset& dataset) {
  RegressionOptions options;
  if (scenario.Lags()) options.structure = Structure::kFirstOrderDynamic;
  const LaggedProblem problem = BuildLagged(dataset, options);
  std::array<std::optional<Excitation>, 3> excitations;
  std::vector<ClusteredFit> fits;
  for (std::size_t j = 0; j < excitations.size(); ++j) {
    const EquationProblem& equation = problem.at_once.equations[j];
    const auto excitation = Assess(equation, {});
    if (!excitation) return std::nullopt;
    excitations[j] = *excitation;
    if (!scenario.Lags()) fits.push_back(FitOf(equation, EstimateOneStep(*excitation)));
  }
  if (scenario.Lags()) fits.push_back(FitOf(EstimateLagged(problem, excitations)));
  return fits;
}

/// The paper's recipe, with a bootstrap over segments.
std::optional<CoverageOutcome> RunOneStep(const Scenario& scenario, const Recording& recording,
                                          std::uint64_t seed) {
  const auto fits = FitOneStep(scenario, Answered(Prepare(recording, VehicleOf(), {})));
  if (!fits) return std::nullopt;
  const BootstrapReplicates replicates = Bootstrap(*fits, {400, seed, 1});
  Eigen::VectorXd theta(TruthOf(scenario).size());
  Eigen::Index next = 0;
  for (const ClusteredFit& fit : *fits) {
    if (next + fit.theta.size() > theta.size()) return std::nullopt;
    theta.segment(next, fit.theta.size()) = fit.theta;
    next += fit.theta.size();
  }
  if (next != theta.size()) return std::nullopt;
  return CompareWithTruth(theta, 1.96 * Covariance(replicates).diagonal().cwiseSqrt(),
                          TruthOf(scenario));
}

std::vector<ReplicateResult> Run(const CoverageScenario& scenario, const Campaign& campaign,
                                 std::size_t parametric_replicates) {
  std::mutex progress_mutex;
  std::size_t done = 0;
  auto all = campaign.RunReplicates([&](std::uint64_t seed) {
    const Recording recording = Simulate(scenario, seed);
    ReplicateResult replicate{RunWeakIv(scenario, recording, parametric_replicates, seed),
                              RunOneStep(scenario, recording, seed)};
    const std::lock_guard lock(progress_mutex);
    std::fprintf(stderr, "\r%s %zu of %zu ", scenario.name.c_str(), ++done, campaign.replicates);
    return replicate;
  });
  std::fprintf(stderr, "\r\033[K");
  return all;
}

struct Tally {
  std::size_t answered = 0;
  double mean = 0.0;
  double lowest = 100.0;
  double highest = 0.0;
  std::string lowest_name;
  std::size_t outside = 0;  ///< coefficients not in 92..98 %
  double bias_share = 0.0;  ///< mean |bias| over spread
  double joint = 0.0;
  double band = 0.0;
};

Tally Count(const std::vector<ReplicateResult>& replicates,
            std::optional<CoverageOutcome> ReplicateResult::*method,
            const std::vector<std::string>& names) {
  Tally tally;
  std::vector<double> held(names.size());
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(names.size()));
  Eigen::VectorXd squares = sum;
  double in_band = 0.0;
  double of_band = 0.0;
  for (const ReplicateResult& replicate : replicates) {
    const auto& outcome = replicate.*method;
    if (!outcome) continue;
    ++tally.answered;
    for (std::size_t j = 0; j < names.size(); ++j) held[j] += outcome->coefficient[j] ? 1.0 : 0.0;
    sum += outcome->error;
    squares += outcome->error.cwiseAbs2();
    tally.joint += outcome->joint ? 1.0 : 0.0;
    in_band += static_cast<double>(outcome->in_band);
    of_band += static_cast<double>(outcome->of_band);
  }
  if (tally.answered == 0) return tally;
  const auto n = static_cast<double>(tally.answered);
  for (std::size_t j = 0; j < names.size(); ++j) {
    const double percent = 100.0 * held[j] / n;
    tally.mean += percent / static_cast<double>(names.size());
    if (percent < tally.lowest) {
      tally.lowest = percent;
      tally.lowest_name = names[j];
    }
    tally.highest = std::max(tally.highest, percent);
    tally.outside += percent < 92.0 || percent > 98.0 ? 1 : 0;
  }
  const Eigen::VectorXd mean = sum / n;
  const Eigen::VectorXd sd = (squares / n - mean.cwiseAbs2()).cwiseMax(1e-30).cwiseSqrt();
  tally.bias_share = mean.cwiseAbs().cwiseQuotient(sd).mean();
  tally.joint *= 100.0 / n;
  tally.band = of_band > 0.0 ? 100.0 * in_band / of_band : 0.0;
  return tally;
}

/// For a cell of a Markdown table, in which a bar ends the cell.
std::string InCell(std::string name) {
  for (std::size_t at = 0; (at = name.find('|', at)) != std::string::npos; at += 2) {
    name.insert(at, "\\");
  }
  return name;
}

void PrintRow(const Scenario& scenario, const std::vector<ReplicateResult>& replicates,
              double seconds) {
  const auto names = NamesOf(scenario);
  const Tally weak = Count(replicates, &ReplicateResult::weak, names);
  const Tally paper = Count(replicates, &ReplicateResult::one_step, names);
  std::printf("| %s | %zu/%zu | %.1f | %.1f (%s) | %.1f | %zu of %zu | %.2f | %.1f | %.1f | ",
              scenario.name.c_str(), weak.answered, replicates.size(), weak.mean, weak.lowest,
              InCell(weak.lowest_name).c_str(), weak.highest, weak.outside, names.size(),
              weak.bias_share, weak.joint, weak.band);
  if (paper.answered > 0) {
    std::printf("%.1f | %.1f", paper.mean, paper.bias_share);
  } else {
    std::printf("- | -");
  }
  std::printf(" | %.0f |\n", seconds);
  std::fflush(stdout);
}

void PrintCoefficients(const Scenario& scenario, const std::vector<ReplicateResult>& replicates) {
  const auto names = NamesOf(scenario);
  const Eigen::VectorXd truth = TruthOf(scenario);
  std::printf("\n| %s | truth | bias | spread | held %% |\n|---|---|---|---|---|\n",
              scenario.name.c_str());
  for (std::size_t j = 0; j < names.size(); ++j) {
    double n = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    double held = 0.0;
    for (const ReplicateResult& replicate : replicates) {
      if (!replicate.weak) continue;
      const double error = replicate.weak->error[static_cast<Eigen::Index>(j)];
      n += 1.0;
      sum += error;
      squares += error * error;
      held += replicate.weak->coefficient[j] ? 1.0 : 0.0;
    }
    std::printf("| %s | %.4g | %.2g | %.2g | %.1f |\n", InCell(names[j]).c_str(),
                truth[static_cast<Eigen::Index>(j)], sum / n,
                std::sqrt(std::max(0.0, squares / n - sum * sum / n / n)), 100.0 * held / n);
  }
}

int Main(int argc, char** argv) {
  Campaign campaign;
  campaign.replicates = 400;
  std::size_t parametric_replicates = 40;
  bool coefficients = false;
  CLI::App app("How often bounds of nominally 95 % hold the truth, by scenario");
  campaign.AddOptionsTo(app, Scenarios());
  app.add_option("--parametric-replicates", parametric_replicates, "behind each bias correction")
      ->capture_default_str();
  app.add_flag("--coefficients", coefficients, "also one table of coefficients a scenario");
  CLI11_PARSE(app, argc, argv);

  std::printf(
      "| scenario | answered | mean %% | lowest %% | highest %% | outside 92..98 | bias/spread | "
      "joint %% | band %% | one-step mean %% | one-step bias/spread | s |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const CoverageScenario& scenario : Scenarios()) {
    if (!campaign.IsSelected(scenario.name)) continue;
    const auto start = std::chrono::steady_clock::now();
    const auto all = Run(scenario, campaign, parametric_replicates);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    PrintRow(scenario, all, took.count());
    if (coefficients) PrintCoefficients(scenario, all);
  }
  return 0;
}

}  // namespace
}  // namespace telltale::coverage

int main(int argc, char** argv) {
  return telltale::coverage::Main(argc, argv);
}
