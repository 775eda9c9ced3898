// How often the daemon's drift test is wrong about boats with which nothing is wrong, and how soon
// it finds what is. Prints the tables of docs/validation/monitoring.md. Telemetry goes through the
// daemon's window and its monitor.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>
#include <boost/math/distributions/chi_squared.hpp>

#include "drift/boat_in_weather.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/validation/promotion.hpp"
#include "telltale/service/ingest/vehicle_window.hpp"
#include "telltale/service/models/free_run_error.hpp"
#include "telltale/service/monitoring/model_monitor.hpp"

namespace telltale::drift {
namespace {

constexpr double kIdentifiedS = 1200.0;  // the daemon's window
constexpr double kHourS = 3600.0;
constexpr int kTransitEvery = 4;  // hours
constexpr int kFaultsEvery = 6;   // hours
constexpr double kFaultS = 900.0;
constexpr double kGoalS = 600.0;
constexpr double kMonthDays = 30.0;
constexpr double kThrusterLagS = 0.3;  // of every other boat, which its static model does not have

struct NamedFault {
  const char* name;
  const char* of_what;  ///< it is a change, as the monitor names it
  Fault fault;
};

const std::vector<NamedFault>& Faults() {
  static const std::vector<NamedFault> faults = {
      {"port thruster 15 % weaker", "port thruster", {.port_thrust = 0.85}},
      {"drag 30 % more", "drag", {.drag = 1.3}},
      {"compass 4 degrees high", "compass", {.compass_deg = 4.0}},
      {"compass 4 degrees low", "compass", {.compass_deg = -4.0}},
      {"port thruster 40 % weaker", "port thruster", {.port_thrust = 0.6}},
      {"port thruster lost", "port thruster", {.port_thrust = 0.0}},
      {"every drag three times", "drag", {.drag = 3.0}},
      {"compass 30 degrees high", "compass", {.compass_deg = 30.0}}};
  return faults;
}

struct Discovery {
  double after_s = HUGE_VAL;  ///< from a fault to its drift; infinite where none comes
  bool is_tested = false;     ///< by what the monitor says, when the time for it is up
};

/// A boat, its window and its monitor in the daemon.
class MonitoredBoat {
 public:
  MonitoredBoat(std::uint64_t seed, double evaluation_s)
      : boat_(seed, seed % 2 == 0 ? kThrusterLagS : 0.0), evaluation_s_(evaluation_s) {
    Take(boat_.Record(kIdentifiedS, Work::kVaried));
    const Recording behind = window_->Snapshot();
    IdentifyOptions options;
    options.bootstrap_replicates = 0;
    options.advise = false;
    options.threads = 1;
    const auto identified = Identify(behind, VehicleInWeather(), options);
    model_.model.identification = *identified;
    model_.model.revision = 1;
    model_.model.promotion = AssessPromotion(behind, VehicleInWeather(), *identified, options);
    model_.reference_error = MeasureFreeRunError(behind, VehicleInWeather(), *identified);
    Evaluate();
  }

  /// The same boat, window and monitor, which go their own way from now on.
  MonitoredBoat(const MonitoredBoat& other)
      : boat_(other.boat_), model_(other.model_), monitor_(other.monitor_), evaluation_s_(5.0) {
    window_->Restore(other.window_->Snapshot());
  }

  /// Whether the daemon publishes its model with verdict OK.
  bool IsSound() const { return model_.model.promotion.verdict == PromotionVerdict::kOk; }
  bool Drifts() const { return monitor_.DriftOnset().has_value(); }

  /// How many drifts begin within so much time of a boat as it is.
  std::size_t Alarms(double duration_s, Work work) {
    std::size_t alarms = 0;
    bool drifted = Drifts();
    Follow(boat_.Record(duration_s, work), [&](double) {
      const bool drifts = Drifts();
      if (drifts && !drifted) {
        ++alarms;
        std::fprintf(stderr, "  false: %s\n", monitor_.DriftEvidence().c_str());
      }
      drifted = drifts;
      return true;
    });
    return alarms;
  }

  /// What becomes of a fault.
  Discovery Discover(const NamedFault& named) {
    Discovery discovery;
    Follow(boat_.Record(kFaultS, Work::kVaried, named.fault), [&](double since_s) {
      if (since_s <= kGoalS) discovery.is_tested = IsTested(named.of_what);
      if (!Drifts()) return true;
      discovery.after_s = since_s;
      return false;
    });
    return discovery;
  }

 private:
  bool IsTested(const std::string& of_what) const {
    const std::string untested = monitor_.DriftUntested();
    return untested.find(of_what) == std::string::npos && !untested.starts_with("every change");
  }

  /// Telemetry arrives; after each evaluation `go_on` gets the seconds since it began.
  template <class GoOn>
  void Follow(const Recording& recording, GoOn go_on) {
    const double begun_s = recording.gnss.front().time_s;
    std::size_t fix = 0;
    std::size_t heading = 0;
    std::size_t command = 0;
    for (double to_s = begun_s + evaluation_s_; fix < recording.gnss.size();
         to_s += evaluation_s_) {
      AddUntil(to_s, recording.gnss, fix);
      AddUntil(to_s, recording.heading, heading);
      AddUntil(to_s, recording.thrusters, command);
      Evaluate();
      if (!go_on(to_s - begun_s)) return;
    }
  }

  void Take(const Recording& recording) {
    Follow(recording, [](double) { return true; });
  }

  template <class Sample>
  void AddUntil(double to_s, const std::vector<Sample>& samples, std::size_t& next) {
    for (; next < samples.size() && samples[next].time_s < to_s; ++next) {
      window_->Add(++sequence_number_, samples[next]);
    }
  }

  void Evaluate() { monitor_.Evaluate(*window_, window_->State().end_s, model_); }

  BoatInWeather boat_;
  std::unique_ptr<VehicleWindow> window_ =
      std::make_unique<VehicleWindow>(VehicleInWeather(), WindowLimits());
  std::uint64_t sequence_number_ = 0;
  StoredModel model_;
  ModelMonitor monitor_;
  double evaluation_s_;
};

struct Outcome {
  bool is_sound = false;
  std::size_t alarms = 0;
  double days = 0.0;
  std::map<std::string, std::vector<Discovery>> discoveries;  ///< by fault
};

/// A boat over so many hours. At times it is copied, and something happens to the copy.
Outcome Observe(std::uint64_t seed, int hours, double evaluation_s) {
  MonitoredBoat boat(seed, evaluation_s);
  Outcome outcome;
  outcome.is_sound = boat.IsSound();
  if (!outcome.is_sound) return outcome;
  for (int hour = 0; hour < hours; ++hour) {
    const bool transit = hour % kTransitEvery == kTransitEvery - 1;
    outcome.alarms += boat.Alarms(kHourS, transit ? Work::kTransit : Work::kVaried);
    outcome.days += kHourS / 86400.0;
    if (hour % kFaultsEvery != 1 || boat.Drifts()) continue;
    for (const NamedFault& fault : Faults()) {
      outcome.discoveries[fault.name].push_back(MonitoredBoat(boat).Discover(fault));
    }
  }
  return outcome;
}

/// What the expected number stays below with 95 %, given that so many were seen.
double PoissonLimit(std::size_t seen) {
  const boost::math::chi_squared distribution(2.0 * static_cast<double>(seen + 1));
  return 0.5 * boost::math::quantile(distribution, 0.95);
}

double Quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void PrintDiscoveries(const char* fault, const std::vector<Discovery>& discoveries) {
  if (discoveries.empty()) return;
  const auto is_found = [](const Discovery& one) { return one.after_s <= kGoalS; };
  const auto is_missed = [&](const Discovery& one) { return !is_found(one) && one.is_tested; };
  std::vector<double> delays_s;
  for (const Discovery& one : discoveries) delays_s.push_back(one.after_s);
  std::printf(
      "%s: %ld of %zu found within %.0f s, %ld missed though tested; after %.0f s (median), "
      "%.0f s (90 %%)\n",
      fault, static_cast<long>(std::ranges::count_if(discoveries, is_found)), discoveries.size(),
      kGoalS, static_cast<long>(std::ranges::count_if(discoveries, is_missed)),
      Quantile(delays_s, 0.5), Quantile(delays_s, 0.9));
}

void Print(const std::vector<Outcome>& outcomes) {
  std::size_t alarms = 0;
  double days = 0.0;
  std::map<std::string, std::vector<Discovery>> discoveries;
  for (const Outcome& outcome : outcomes) {
    alarms += outcome.alarms;
    days += outcome.days;
    for (const auto& [name, more] : outcome.discoveries) {
      discoveries[name].insert(discoveries[name].end(), more.begin(), more.end());
    }
  }
  const double months = days / kMonthDays;
  const auto sound =
      static_cast<std::size_t>(std::ranges::count(outcomes, true, &Outcome::is_sound));
  std::printf("%zu of %zu models have verdict OK and are followed\n", sound, outcomes.size());
  std::printf(
      "nominal: %zu boats, %.2f boat-months, %zu false alarms: %.2f a boat and month, 95 %%: below "
      "%.2f\n",
      sound, months, alarms, static_cast<double>(alarms) / months, PoissonLimit(alarms) / months);
  for (const NamedFault& fault : Faults()) PrintDiscoveries(fault.name, discoveries[fault.name]);
}

}  // namespace
}  // namespace telltale::drift

int main(int argc, char** argv) {
  CLI::App app("How often the drift test is wrong, and how soon it is right.");
  std::size_t boats = 30;
  int hours = 24;
  std::uint64_t seed = 1;
  std::size_t threads = 1;
  double evaluation_s = 60.0;
  app.add_option("--boats", boats, "boats, each with a model of its own")->capture_default_str();
  app.add_option("--hours", hours, "simulated hours of each")->capture_default_str();
  app.add_option("--seed", seed, "of the first boat")->capture_default_str();
  app.add_option("--threads", threads, "processors to use")->capture_default_str();
  app.add_option("--evaluation", evaluation_s, "seconds between evaluations of nominal boats")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  spdlog::set_level(spdlog::level::off);
  std::vector<telltale::drift::Outcome> outcomes(boats);
  telltale::ForEachIndex(boats, threads, [&](std::size_t i) {
    outcomes[i] = telltale::drift::Observe(seed + i, hours, evaluation_s);
    std::fprintf(stderr, "boat %zu: %zu false alarms\n", i, outcomes[i].alarms);
  });
  telltale::drift::Print(outcomes);
}
