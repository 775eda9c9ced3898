// Do 95 % bounds of the physical form hold 95 % of the time, on hulls with forces that it has not
// and with clocks that disagree? Prints the table of docs/validation/physical-coverage.md.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "coverage/hull_recording.hpp"
#include "coverage/hulls.hpp"
#include "coverage/replicates.hpp"
#include "telltale/core/identification/drag_and_thrust.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/identification/model_comparison.hpp"
#include "telltale/core/identification/posterior_draws.hpp"
#include "telltale/core/uncertainty/prediction_band.hpp"

namespace telltale::coverage {
namespace {

using enum FossenParameter;

struct HullScenario {
  std::string name;
  Hull hull = OfTheForm();
  Sea sea = {};
  Clocks clocks = {};
  double duration_s = 600.0;
  std::size_t recordings = 1;
};

std::vector<HullScenario> Scenarios() {
  std::vector<HullScenario> all;
  const auto add = [&all](std::string name, const auto& change) {
    HullScenario& scenario = all.emplace_back(HullScenario{std::move(name)});
    change(scenario);
  };
  add("form", [](HullScenario&) {});
  add("otter", [](HullScenario& s) { s.hull = Otter(); });
  add("cybership", [](HullScenario& s) {
    s.hull = CyberShip();
    s.sea.gust_sigma = {0.01, 0.01, 0.01};
    s.sea.current_m_s = 0.03;
  });
  add("wam-v", [](HullScenario& s) { s.hull = WamV(); });
  add("catamaran", [](HullScenario& s) { s.hull = Catamaran(); });
  add("three-minutes", [](HullScenario& s) { s.duration_s = 180.0; });
  add("three-recordings", [](HullScenario& s) {
    s.duration_s = 200.0;
    s.recordings = 3;
  });
  add("calm", [](HullScenario& s) { s.sea.gust_sigma *= 0.2; });
  add("strong-gusts", [](HullScenario& s) { s.sea.gust_sigma *= 3.0; });
  add("waves", [](HullScenario& s) { s.sea.wave_sigma = 0.15; });
  add("current", [](HullScenario& s) {
    s.sea.current_m_s = 0.3;
    s.sea.current_variation = 0.1;
  });
  add("coloured-fixes", [](HullScenario& s) { s.sea.fix_drift_m = 0.5; });
  add("commands-sampled", [](HullScenario& s) { s.clocks.sampled = true; });
  add("commands-of-50-hz", [](HullScenario& s) { s.clocks.sampled = s.clocks.steered = true; });
  add("offsets", [](HullScenario& s) {
    s.clocks.command_delay_s = -0.1;
    s.clocks.least_fix_delay_s = s.clocks.greatest_fix_delay_s = 0.1;
  });
  add("jitter", [](HullScenario& s) { s.clocks.jitter_s = 0.02; });
  add("fixes-on-arrival", [](HullScenario& s) {
    s.clocks.least_fix_delay_s = 0.05;
    s.clocks.greatest_fix_delay_s = 0.25;
  });
  add("commands-at-2-hz", [](HullScenario& s) {
    s.clocks.command_period_s = 0.5;
    s.clocks.sampled = true;
  });
  return all;
}

Recording Record(const HullScenario& scenario, std::size_t recordings, std::uint64_t seed) {
  constexpr double kBetweenS = 100.0;
  Recording all;
  for (std::size_t i = 0; i < recordings; ++i) {
    const double start_s = 1000.0 + static_cast<double>(i) * (scenario.duration_s + kBetweenS);
    const Recording one =
        RecordHull(scenario.hull, scenario.sea, scenario.clocks, scenario.duration_s, start_s,
                   recordings == 1 ? seed : RandomEngine::Stream(seed, i)());
    all.gnss.insert(all.gnss.end(), one.gnss.begin(), one.gnss.end());
    all.heading.insert(all.heading.end(), one.heading.begin(), one.heading.end());
    all.thrusters.insert(all.thrusters.end(), one.thrusters.begin(), one.thrusters.end());
    if (recordings > 1) all.starts_s.push_back(start_s - 1.0);
  }
  return all;
}

std::optional<Identification> Identified(const HullScenario& scenario, const Recording& recording,
                                         std::size_t threads) {
  IdentifyOptions options;
  options.regression.structure = Structure::kFossen;
  options.threads = threads;
  options.advise = false;
  auto identification = Identify(recording, VehicleOf(scenario.hull), options);
  if (!identification || !identification->physical) return std::nullopt;
  return *std::move(identification);
}

FossenVector TruthOfTheForm(const HullScenario& scenario) {
  const Hull hull = OfTheForm();
  FossenVector p;
  p << hull.m22, hull.m23, hull.m33, 6.0, 13.0, 25.0, 2.0, 1.5, 5.0, 40.0, 0.0, 0.0, 0.0, 4.0, 9.0,
      3.0, 4.0, 2.0, 12.0, 30.0, 10.0, 22.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0;
  p /= hull.m11;
  p[At(kImbalance)] = hull.imbalance;
  p[At(kForwardDeadBand)] = p[At(kReverseDeadBand)] = kDeadBandOfTheForm;
  p[At(kTimeConstant)] = hull.thrust_time_constant_s;
  p[At(kCommandDelay)] = scenario.clocks.command_delay_s;
  p[At(kFixDelay)] =
      0.5 * (scenario.clocks.least_fix_delay_s + scenario.clocks.greatest_fix_delay_s);
  return p;
}

// What the parameters of the form come to on this hull with very much data: of a hull of the form
// they are known, of another they are those of many recordings together.
std::optional<FossenVector> PseudoTruth(const HullScenario& scenario, std::size_t recordings,
                                        std::size_t threads, std::uint64_t seed) {
  if (scenario.hull.name == "form" && !scenario.clocks.sampled) return TruthOfTheForm(scenario);
  const auto pooled = Identified(scenario, Record(scenario, recordings, seed), threads);
  if (!pooled) return std::nullopt;
  return pooled->physical->Estimates();
}

constexpr int kRankBins = 10;
using Ranks = Eigen::Matrix<double, kRankBins, 1>;

struct Outcome {
  FossenVector error;
  FossenVector standard_error;
  std::vector<bool> held;
  std::vector<bool> prior;
  std::vector<ForceAtPoint> forces;
  Eigen::VectorXd true_forces;  ///< at the points of `forces`
  bool joint = false;           ///< whether the comparison of models takes the truth for the model
  double in_band = 0.0;         ///< share
  Ranks ranks = Ranks::Zero();
  bool converged = false;
  double seconds = 0.0;
};

std::vector<VesselModel> ModelsOf(const PosteriorDraws& draws, const VesselModel& estimate) {
  std::vector<VesselModel> models;
  for (Eigen::Index i = 0; i < draws.theta.cols(); ++i) {
    VesselModel one = estimate;
    Eigen::Index next = 0;
    for (Eigen::VectorXd& theta : one.theta) {
      theta = draws.theta.col(i).segment(next, theta.size());
      next += theta.size();
    }
    one.thruster_time_constant_s = draws.time_constant_s[static_cast<std::size_t>(i)];
    models.push_back(one);
  }
  return models;
}

// Ranks of the true coefficients of simulation among their draws, in shares. One that is the same
// in every draw has none.
Ranks RanksOf(const VesselModel& truth, const PosteriorDraws& draws) {
  Ranks ranks = Ranks::Zero();
  Eigen::Index row = 0;
  for (const Eigen::VectorXd& theta : truth.theta) {
    for (const double true_value : theta) {
      const auto drawn = draws.theta.row(row++).array();
      if (drawn.maxCoeff() - drawn.minCoeff() < 1e-12) continue;
      const auto below = static_cast<double>((drawn < true_value).count());
      const double share = below / static_cast<double>(draws.theta.cols() + 1);
      ranks[static_cast<Eigen::Index>(share * kRankBins)] += 1.0;
    }
  }
  return ranks / ranks.sum();
}

double ShareInBand(const HullScenario& scenario, const Identification& model,
                   const std::vector<VesselModel>& models, std::uint64_t seed) {
  constexpr double kHorizonS = 10.0;
  constexpr double kStepS = 0.1;
  const HullRun run = RunHull(scenario.hull, scenario.sea, kHorizonS, kStepS, seed);
  VesselState start;
  start.nu = run.start;
  start.thrust = models.front().SteadyThrust(run.commands.front().delta);
  Disturbance disturbance;
  disturbance.sigma = model.physical->noise.acceleration_sigma;
  disturbance.time_constant_s.setConstant(model.physical->noise.acceleration_time_constant_s);
  const PredictionBand band =
      PredictBand(models, start, run.commands, disturbance, kHorizonS, kStepS, 0.95, seed);
  double inside = 0.0;
  for (const Eigen::Index k : {9, 49, 99}) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double nu = run.nu(axis, k);
      inside += nu >= band.lower(axis, k) && nu <= band.upper(axis, k) ? 1.0 / 9.0 : 0.0;
    }
  }
  return inside;
}

bool HoldsJointly(const Identification& model, const FossenVector& truth) {
  Identification boat = model;
  boat.physical->covariance.setZero();
  boat.provenance.clusters = 0;
  for (std::size_t i = 0; i < kFossenParameters; ++i) {
    boat.physical->parameters[i].estimate = truth[static_cast<Eigen::Index>(i)];
  }
  const auto test = TestForChange(model, boat);
  return test && test->p_value >= 0.05;
}

std::optional<Outcome> RunReplicate(const HullScenario& scenario, const FossenVector& truth,
                                    std::uint64_t seed) {
  const Recording recording = Record(scenario, scenario.recordings, seed);
  const auto from = std::chrono::steady_clock::now();
  const auto model = Identified(scenario, recording, 1);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - from;
  if (!model) return std::nullopt;
  Outcome outcome;
  outcome.seconds = took.count();
  outcome.error = model->physical->Estimates() - truth;
  for (std::size_t i = 0; i < kFossenParameters; ++i) {
    const Coefficient& parameter = model->physical->parameters[i];
    const double true_value = truth[static_cast<Eigen::Index>(i)];
    outcome.standard_error[static_cast<Eigen::Index>(i)] = parameter.standard_error;
    outcome.held.push_back(parameter.interval.lower <= true_value &&
                           true_value <= parameter.interval.upper);
    outcome.prior.push_back(parameter.status == CoefficientStatus::kPrior);
  }
  outcome.joint = HoldsJointly(*model, truth);
  outcome.forces = DragAndThrustOf(*model->physical);
  outcome.true_forces = ForcesAt(outcome.forces, truth, scenario.hull.propeller_separation_m);
  constexpr std::size_t kDraws = 400;
  if (const auto draws = DrawFromPosterior(*model, kDraws, seed + 1)) {
    const double separation_m = scenario.hull.propeller_separation_m;
    const auto models = ModelsOf(*draws, VesselModelOf(model->physical->Estimates(), separation_m));
    outcome.in_band = ShareInBand(scenario, *model, models, seed + 1);
    outcome.ranks = RanksOf(VesselModelOf(truth, separation_m), *draws);
  }
  outcome.converged =
      std::ranges::none_of(model->refusals, [](const Refusal& r) { return r.subject == "model"; });
  return outcome;
}

/// Over the replicates of a scenario: means, shares in percent, and the parameters one by one.
struct Tally {
  FossenVector held = FossenVector::Zero();
  FossenVector prior = FossenVector::Zero();  ///< by how often the prior decides
  FossenVector bias = FossenVector::Zero();
  FossenVector spread = FossenVector::Zero();
  FossenVector predicted = FossenVector::Zero();  ///< standard error, root mean square
  double joint = 0.0;
  double band = 0.0;
  Ranks ranks = Ranks::Zero();
  double converged = 0.0;  ///< number
  double seconds = 0.0;
};

Tally Count(const std::vector<Outcome>& outcomes) {
  const auto n = static_cast<double>(outcomes.size());
  Tally tally;
  FossenVector squares = FossenVector::Zero();
  for (const Outcome& outcome : outcomes) {
    for (std::size_t i = 0; i < kFossenParameters; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      tally.held[at] += outcome.held[i] ? 100.0 / n : 0.0;
      tally.prior[at] += outcome.prior[i] ? 100.0 / n : 0.0;
    }
    tally.bias += outcome.error / n;
    squares += outcome.error.cwiseAbs2() / n;
    tally.predicted += outcome.standard_error.cwiseAbs2() / n;
    tally.joint += outcome.joint ? 100.0 / n : 0.0;
    tally.band += 100.0 * outcome.in_band / n;
    tally.ranks += 100.0 * outcome.ranks / n;
    tally.converged += outcome.converged ? 1.0 : 0.0;
    tally.seconds += outcome.seconds / n;
  }
  tally.spread = (squares - tally.bias.cwiseAbs2()).cwiseMax(1e-30).cwiseSqrt();
  tally.predicted = tally.predicted.cwiseSqrt();
  return tally;
}

// A parameter that always stops at the end of its range has no spread, hence not the mean.
double Median(FossenVector values) {
  std::ranges::sort(values);
  return values[kFossenParameters / 2];
}

std::string SymbolOf(Eigen::Index parameter) {
  return std::string(FossenParameterNames()[static_cast<std::size_t>(parameter)].symbol);
}

void PrintRow(const std::string& name, const Tally& tally, std::size_t identified,
              std::size_t replicates) {
  Eigen::Index lowest = 0;
  tally.held.minCoeff(&lowest);
  std::printf(
      "| %s | %.0f/%zu/%zu | %.1f | %.1f (%s) | %td | %.2f | %.2f | %.1f | %.1f | %.1f | %.1f |\n",
      name.c_str(), tally.converged, identified, replicates, tally.held.mean(), tally.held[lowest],
      SymbolOf(lowest).c_str(), (tally.held.array() < 92.0).count(),
      Median(tally.bias.cwiseAbs().cwiseQuotient(tally.spread)),
      Median(tally.predicted.cwiseQuotient(tally.spread)), tally.prior.sum() / 100.0, tally.joint,
      tally.band, tally.seconds);
  std::fflush(stdout);
}

void PrintParameters(const std::string& name, const FossenVector& truth, const Tally& tally) {
  std::printf(
      "\n| %s | truth | bias | spread | predicted | prior %% | held %% "
      "|\n|---|---|---|---|---|---|---|\n",
      name.c_str());
  for (Eigen::Index i = 0; i < truth.size(); ++i) {
    std::printf("| %s | %.4g | %.2g | %.2g | %.2g | %.0f | %.1f |\n", SymbolOf(i).c_str(), truth[i],
                tally.bias[i], tally.spread[i], tally.predicted[i], tally.prior[i], tally.held[i]);
  }
  std::fflush(stdout);
}

// Drag and thrust that the parameters add up to: half-widths over the estimate, and how often they
// hold.
void PrintForces(const std::string& name, const std::vector<Outcome>& outcomes) {
  std::printf("\n| %s | at | half-width %% | held %% |\n|---|---|---|---|\n", name.c_str());
  const auto n = static_cast<double>(outcomes.size());
  for (std::size_t i = 0; i < outcomes.front().forces.size(); ++i) {
    double at = 0.0;
    double held = 0.0;
    double half_width = 0.0;
    for (const Outcome& outcome : outcomes) {
      const ForceAtPoint& force = outcome.forces[i];
      const double true_force = outcome.true_forces[static_cast<Eigen::Index>(i)];
      const auto& [level, lower, upper] = force.interval;
      at += force.at / n;
      held += lower <= true_force && true_force <= upper ? 100.0 / n : 0.0;
      half_width += 50.0 * (upper - lower) / force.estimate / n;
    }
    const ForceAtPoint& first = outcomes.front().forces[i];
    std::printf("| %s | %.2g %s | %.0f | %.1f |\n", first.name.c_str(), at,
                first.at_unit == "1" ? "of full command" : first.at_unit.c_str(), half_width, held);
  }
  std::fflush(stdout);
}

// Even tenths where the draws are calibrated.
void PrintRanks(const std::string& name, const Ranks& ranks) {
  std::printf("\n| %s, ranks, tenth |", name.c_str());
  for (int i = 1; i <= kRankBins; ++i) std::printf(" %d |", i);
  std::printf("\n|---|---|---|---|---|---|---|---|---|---|---|\n| %% |");
  for (const double share : ranks) std::printf(" %.1f |", share);
  std::printf("\n");
  std::fflush(stdout);
}

int Main(int argc, char** argv) {
  Campaign campaign;
  campaign.replicates = 400;
  std::size_t pooled = 30;
  bool parameters = false;
  bool ranks = false;
  CLI::App app("How often 95 % bounds of the physical form hold, by scenario");
  campaign.AddOptionsTo(app, Scenarios());
  app.add_option("--pooled", pooled, "recordings behind the pseudo-true values")
      ->capture_default_str();
  app.add_flag("--parameters", parameters,
               "also one table of parameters a scenario, and one of drag and thrust");
  app.add_flag("--ranks", ranks, "also the ranks of the true values among draws of the posterior");
  CLI11_PARSE(app, argc, argv);
  std::printf(
      "| scenario | converged/identified/all | mean %% | lowest %% | below 92 | bias/spread | "
      "predicted/spread | PRIOR | joint %% | band %% | s |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const HullScenario& scenario : Scenarios()) {
    if (!campaign.IsSelected(scenario.name)) continue;
    const auto truth = PseudoTruth(scenario, pooled, campaign.threads, campaign.seed + 1000);
    if (!truth) {
      std::printf("| %s | no pseudo-true values |\n", scenario.name.c_str());
      continue;
    }
    const auto outcomes = Completed(campaign.RunReplicates(
        [&](std::uint64_t seed) { return RunReplicate(scenario, *truth, seed); }));
    if (outcomes.empty()) continue;
    const Tally tally = Count(outcomes);
    PrintRow(scenario.name, tally, outcomes.size(), campaign.replicates);
    if (ranks) PrintRanks(scenario.name, tally.ranks);
    if (!parameters) continue;
    PrintParameters(scenario.name, *truth, tally);
    PrintForces(scenario.name, outcomes);
  }
  return 0;
}

}  // namespace
}  // namespace telltale::coverage

int main(int argc, char** argv) {
  return telltale::coverage::Main(argc, argv);
}
