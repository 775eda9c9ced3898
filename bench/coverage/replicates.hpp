#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Core>

#include "coverage/independent_simulator.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/base/random.hpp"

namespace telltale::coverage {

/// A boat, its environment and its mission.
struct Scenario {
  std::string name;
  Boat boat = ReferenceBoat();
  SimulatedEnvironment environment;
  Mission mission;

  bool Lags() const { return boat.thruster_time_constant_s > 0.0; }
};

/// The usual disturbance, scaled.
inline SimulatedEnvironment Disturbed(double share) {
  SimulatedEnvironment environment;
  for (double& sigma : environment.disturbance_sigma) sigma *= share;
  return environment;
}

/// The stacked unknowns of an estimate: the time constant first, if the boat has one.
inline Eigen::VectorXd TruthOf(const Scenario& scenario) {
  std::vector<double> truth = CoefficientsOf(scenario.boat);
  if (scenario.Lags()) truth.insert(truth.begin(), scenario.boat.thruster_time_constant_s);
  return Eigen::Map<Eigen::VectorXd>(truth.data(), static_cast<Eigen::Index>(truth.size()));
}

inline Recording Simulate(const Scenario& scenario, std::uint64_t seed) {
  return Simulate(scenario.boat, scenario.environment, scenario.mission, seed);
}

/// The options of every program here: which scenarios, how many replicates, which seed.
struct Campaign {
  std::vector<std::string> selected;
  std::size_t replicates = 0;
  std::size_t first = 0;  ///< replicates before it belong to another campaign
  std::size_t threads = std::max(1U, std::thread::hardware_concurrency());
  std::uint64_t seed = 1;

  template <class Scenarios>
  void AddOptionsTo(CLI::App& app, const Scenarios& scenarios) {
    std::vector<std::string> names;
    for (const auto& scenario : scenarios) names.push_back(scenario.name);
    app.add_option("--scenario", selected, "only these (default: all)")
        ->check(CLI::IsMember(names));
    app.add_option("--replicates", replicates, "synthetic recordings of each scenario")
        ->capture_default_str();
    app.add_option("--first", first, "continue after this many replicates of the seed");
    app.add_option("--threads", threads, "threads; the result does not depend on them")
        ->capture_default_str();
    app.add_option("--seed", seed, "seed of the replicates' own seeds")->capture_default_str();
  }

  bool IsSelected(const std::string& name) const {
    return selected.empty() || std::find(selected.begin(), selected.end(), name) != selected.end();
  }

  /// The results of attempt(seed of the replicate), by replicate; attempts run in parallel. A
  /// campaign with --first continues one of the same seed exactly.
  template <class Attempt>
  auto RunReplicates(const Attempt& attempt) const {
    std::vector<decltype(attempt(seed))> all(replicates);
    ForEachIndex(replicates, threads,
                 [&](std::size_t i) { all[i] = attempt(RandomEngine::Stream(seed, first + i)()); });
    return all;
  }
};

/// The values that are set.
template <class Value>
std::vector<Value> Completed(std::vector<std::optional<Value>> all) {
  std::vector<Value> answered;
  for (auto& value : all) {
    if (value) answered.push_back(*std::move(value));
  }
  return answered;
}

/// The mean of one figure over the replicates.
template <class Value>
double MeanOf(const std::vector<Value>& replicates, double Value::*figure) {
  double sum = 0.0;
  for (const Value& replicate : replicates) sum += replicate.*figure;
  return sum / static_cast<double>(replicates.size());
}

}  // namespace telltale::coverage
