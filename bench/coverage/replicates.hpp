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

/// A boat, what surrounds it and what it does.
struct Scenario {
  std::string name;
  Boat boat = ReferenceBoat();
  SimulatedEnvironment environment;
  Mission mission;

  bool Lags() const { return boat.thruster_time_constant_s > 0.0; }
};

/// Pushed by so much of the usual disturbance.
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

/// Which scenarios are repeated, how often and from which seed; the options of every program here.
struct Campaign {
  std::vector<std::string> selected;
  std::size_t replicates = 0;
  std::size_t first = 0;  ///< repeats before it are another campaign's
  std::size_t threads = std::max(1U, std::thread::hardware_concurrency());
  std::uint64_t seed = 1;

  template <class Scenarios>
  void AddOptionsTo(CLI::App& app, const Scenarios& scenarios) {
    std::vector<std::string> names;
    for (const auto& scenario : scenarios) names.push_back(scenario.name);
    app.add_option("--scenario", selected, "only these (default: all)")
        ->check(CLI::IsMember(names));
    app.add_option("--replicates", replicates, "seeded repeats of each scenario")
        ->capture_default_str();
    app.add_option("--first", first, "where to go on after so many repeats of this seed");
    app.add_option("--threads", threads, "never change the result")->capture_default_str();
    app.add_option("--seed", seed, "of the repeats' own seeds")->capture_default_str();
  }

  bool IsSelected(const std::string& name) const {
    return selected.empty() || std::find(selected.begin(), selected.end(), name) != selected.end();
  }

  /// What attempt(seed of the repeat) gives, by repeat; attempts run beside each other. Campaigns
  /// of one seed that go on where the other ended are one campaign in two parts.
  template <class Attempt>
  auto RunReplicates(const Attempt& attempt) const {
    std::vector<decltype(attempt(seed))> all(replicates);
    ForEachIndex(replicates, threads,
                 [&](std::size_t i) { all[i] = attempt(RandomEngine::Stream(seed, first + i)()); });
    return all;
  }
};

/// Those that there are.
template <class Value>
std::vector<Value> Completed(std::vector<std::optional<Value>> all) {
  std::vector<Value> answered;
  for (auto& value : all) {
    if (value) answered.push_back(*std::move(value));
  }
  return answered;
}

/// Of one figure over the repeats.
template <class Value>
double MeanOf(const std::vector<Value>& replicates, double Value::*figure) {
  double sum = 0.0;
  for (const Value& replicate : replicates) sum += replicate.*figure;
  return sum / static_cast<double>(replicates.size());
}

}  // namespace telltale::coverage
