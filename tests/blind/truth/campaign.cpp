#include "campaign.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "effects.hpp"
#include "recording.hpp"
#include "seal.hpp"

namespace blind::truth {
namespace {

constexpr std::size_t kTrainLogs = 3;
constexpr std::size_t kReferenceLogs = 4;
constexpr std::size_t kDaysBefore = 10;  // of the hulls' own logs; then a case a day
constexpr int kNominalCases = 300;
constexpr int kOfEachPair = 5;
constexpr int kOfEachOutside = 5;  // of each size
constexpr std::array<double, 3> kSizes{0.5, 1.0, 2.0};
constexpr std::array<double, 2> kOutsideSizes{1.0, 2.0};

constexpr std::array<const char*, 3> kWeather{"wind", "current", "waves"};

using Pair = std::pair<const char*, const char*>;

constexpr std::array<Pair, 12> kDevelopmentPairs{{{"wind", "thruster_imbalance"},
                                                  {"current", "thrust_gain"},
                                                  {"heading_bias", "hull_fouling"},
                                                  {"thruster_lag", "payload"},
                                                  {"thruster_delay", "current"},
                                                  {"antenna_lever_arm", "thruster_dead_zone"},
                                                  {"waves", "thruster_imbalance"},
                                                  {"thrust_sag", "wind"},
                                                  {"crossflow_drag", "thruster_misalignment"},
                                                  {"gnss_latency", "thrust_gain"},
                                                  {"body_bias", "thruster_lag"},
                                                  {"thruster_saturation", "heading_bias"}}};

constexpr std::array<Pair, 12> kHeldOutPairs{{{"current", "thruster_imbalance"},
                                              {"wind", "hull_fouling"},
                                              {"heading_bias", "thruster_lag"},
                                              {"thruster_delay", "payload"},
                                              {"antenna_lever_arm", "thruster_imbalance"},
                                              {"waves", "thrust_gain"},
                                              {"thrust_inflow_loss", "current"},
                                              {"body_bias", "gnss_latency"},
                                              {"added_mass_coupling", "thruster_dead_zone"},
                                              {"crossflow_drag", "thruster_delay"},
                                              {"thrust_sag", "heading_bias"},
                                              {"thruster_saturation", "wind"}}};

RandomStream Yard(Set set, std::uint64_t seed) {
  return RandomStream(seed).For(set == Set::kDevelopment ? "development" : "held-out");
}

void AddSingles(std::vector<Case>& cases, RandomStream& rng) {
  for (const Effect& effect : Effects()) {
    if (!effect.in_library) continue;
    for (const double size : kSizes) {
      for (const double sign : effect.has_sign ? std::vector{-1.0, 1.0} : std::vector{1.0}) {
        cases.push_back({"single", {{effect.name, size * rng.Uniform(0.9, 1.1), sign}}, {}});
      }
    }
  }
}

void AddOutside(std::vector<Case>& cases, RandomStream& rng) {
  for (const Effect& effect : Effects()) {
    if (effect.in_library) continue;
    for (const double size : kOutsideSizes) {
      for (int repeat = 0; repeat < kOfEachOutside; ++repeat) {
        cases.push_back({"outside", {{effect.name, size * rng.Uniform(0.9, 1.1), 1.0}}, {}});
      }
    }
  }
}

void AddPairs(std::vector<Case>& cases, Set set, RandomStream& rng) {
  for (const Pair& pair : set == Set::kDevelopment ? kDevelopmentPairs : kHeldOutPairs) {
    for (int repeat = 0; repeat < kOfEachPair; ++repeat) {
      cases.push_back({"pair",
                       {{pair.first, rng.Uniform(0.9, 1.6), rng.Sign()},
                        {pair.second, rng.Uniform(0.9, 1.6), rng.Sign()}},
                       {}});
    }
  }
}

/// Wind of 3.5 to 7 m/s, a current of 0.1 to 0.4 m/s or waves of 5 to 20 N.
AppliedEffect DrawnWeather(RandomStream& rng) {
  return {kWeather[rng.Below(kWeather.size())], rng.LogUniform(0.5, 2.0), 1.0};
}

bool IsInWeather(const Case& planned) {
  return std::any_of(
      planned.effects.begin(), planned.effects.end(), [](const AppliedEffect& applied) {
        return std::find(kWeather.begin(), kWeather.end(), applied.effect) != kWeather.end();
      });
}

/// To as many cases of a kind, drawn, as put half of it in weather.
void AddWeather(std::vector<Case>& cases, const std::string& kind, RandomStream& rng) {
  std::vector<Case*> calm;
  std::size_t of_kind = 0;
  for (Case& planned : cases) {
    if (planned.kind != kind) continue;
    ++of_kind;
    if (!IsInWeather(planned)) calm.push_back(&planned);
  }
  rng.Shuffle(calm);
  for (std::size_t left = calm.size(); left > of_kind / 2; --left) {
    calm[left - 1]->weather = {DrawnWeather(rng)};
  }
}

std::string Numbered(const char* format, std::size_t number) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), format, number);
  return text.data();
}

std::string InQuotes(const std::string& text) {
  return '"' + text + '"';
}

std::string Number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

std::string EffectLabel(const AppliedEffect& applied, const std::vector<Parameter>& parameters) {
  std::string label = "{\"effect\":" + InQuotes(applied.effect) +
                      ",\"size\":" + Number(applied.size) + ",\"sign\":" + Number(applied.sign) +
                      ",\"parameters\":[";
  for (std::size_t at = 0; at < parameters.size(); ++at) {
    label += (at == 0 ? "" : ",");
    label += "{\"name\":" + InQuotes(parameters[at].name) +
             ",\"value\":" + Number(parameters[at].value) +
             ",\"unit\":" + InQuotes(parameters[at].unit) + "}";
  }
  return label + "]}";
}

/// Turns the effects on and returns their labels, a list.
std::string Applied(const std::vector<AppliedEffect>& effects, Scenario& scenario,
                    const char* purpose, const RandomStream& rng) {
  std::string labels;
  for (std::size_t at = 0; at < effects.size(); ++at) {
    const AppliedEffect& applied = effects[at];
    RandomStream draws = rng.For(purpose, at);
    const auto parameters =
        EffectNamed(applied.effect).apply(scenario, applied.size, applied.sign, draws);
    labels += (at == 0 ? "" : ",") + EffectLabel(applied, parameters);
  }
  return "[" + labels + "]";
}

/// The day's scenario with and without the case's effects, and its label.
std::pair<SimulatedRun, std::string> Prepared(const Case& asked, const Hull& hull, double onset_s,
                                              double duration_s, const RandomStream& rng) {
  const Scenario nominal{.hull = hull, .weather = LightDay(rng.For("weather")), .faults = {}};
  SimulatedRun run{nominal, nominal, onset_s, duration_s};
  std::string label = "{\"kind\":" + InQuotes(asked.kind) + ",\"hull\":" + InQuotes(hull.name) +
                      ",\"onset_s\":" + Number(onset_s);
  label += ",\"effects\":" + Applied(asked.effects, run.after, "effect", rng);
  label += ",\"weather\":" + Applied(asked.weather, run.after, "weather beside", rng);
  return {run, label + "}"};
}

void Record(const SimulatedRun& run, Set set, std::size_t day, const RandomStream& rng,
            const std::filesystem::path& folder) {
  Mission mission = DrawnMission(set, run.duration_s, rng.For("mission"));
  const Track track = Simulate(run, std::move(mission), rng.For("voyage"));
  WriteRecording(track, run, day, rng.For("sensors"), folder);
}

void WriteNominal(const CampaignOptions& options, const Hull& hull, std::size_t day,
                  const RandomStream& rng, const std::filesystem::path& folder) {
  const auto [run, label] = Prepared({"nominal", {}, {}}, hull, 0.0, options.duration_s, rng);
  Record(run, options.set, day, rng, folder);
}

}  // namespace

std::vector<Case> PlannedCases(Set set, std::uint64_t seed, std::size_t repeats) {
  RandomStream rng = Yard(set, seed).For("plan");
  const std::size_t hulls = Fleet(set, seed).size();
  std::vector<Case> cases;
  for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
    for (int nominal = 0; nominal < kNominalCases; ++nominal) cases.push_back({"nominal", {}, {}});
    AddSingles(cases, rng);
    AddPairs(cases, set, rng);
    AddOutside(cases, rng);
  }
  for (const char* kind : {"nominal", "single", "pair", "outside"}) AddWeather(cases, kind, rng);
  // Hulls are dealt out within the kinds, so that each hull meets about as many of each.
  std::size_t hull = rng.Below(hulls);
  for (std::size_t at = 0; at < cases.size(); ++at) {
    if (at % hulls == 0) hull = rng.Below(hulls);
    cases[at].hull = (hull + at) % hulls;
    cases[at].day = at;
  }
  rng.Shuffle(cases);
  return cases;
}

std::vector<Case> NominalDays(Set set, std::uint64_t seed, std::size_t days) {
  constexpr std::uint64_t kAfterAllCases = 1'000'000;
  const std::size_t hulls = Fleet(set, seed).size();
  std::vector<Case> cases;
  for (std::size_t at = 0; at < days; ++at) {
    cases.push_back({"nominal", {}, {}, at % hulls, kAfterAllCases + at});
  }
  return cases;
}

void WriteCampaign(const CampaignOptions& options, const std::filesystem::path& folder,
                   const Progress& progress) {
  const RandomStream yard = Yard(options.set, options.seed);
  const std::vector<Hull> fleet = Fleet(options.set, options.seed);
  std::vector<Case> cases = options.nominal_days
                                ? NominalDays(options.set, options.seed, *options.nominal_days)
                                : PlannedCases(options.set, options.seed, options.repeats);
  if (options.most_cases && *options.most_cases < cases.size()) {
    cases.resize(*options.most_cases);
  }
  const std::size_t of_each_case = options.again ? 2 : 1;
  const std::size_t all =
      fleet.size() * (kTrainLogs + kReferenceLogs) + of_each_case * cases.size();
  std::size_t done = 0;
  for (const Hull& hull : fleet) {
    const std::filesystem::path home = folder / "hulls" / hull.name;
    WriteFile(home / "vehicle.textproto", VehicleFile(hull));
    const RandomStream days = yard.For(hull.name);
    for (std::size_t day = 1; day <= kTrainLogs; ++day) {
      progress(done++, all);
      WriteNominal(options, hull, day, days.For("train", day), home / Numbered("train-%zu", day));
    }
    for (std::size_t day = 1; day <= kReferenceLogs; ++day) {
      progress(done++, all);
      WriteNominal(options, hull, kTrainLogs + day, days.For("reference", day),
                   home / Numbered("reference-%zu", day));
    }
  }
  for (std::size_t number = 1; number <= cases.size(); ++number) {
    progress(done++, all);
    const Case& asked = cases[number - 1];
    const std::string name = Numbered("%03zu", number);
    const Hull& hull = fleet[asked.hull];
    const RandomStream rng = yard.For("case", asked.day);
    const auto [run, label] = Prepared(asked, hull, 0.0, options.duration_s, rng);
    Record(run, options.set, kDaysBefore + number, rng, folder / "cases" / name / "log");
    if (options.again) {
      progress(done++, all);
      Record(run, options.set, kDaysBefore + cases.size() + number, rng.For("again"),
             folder / "cases" / name / "again");
    }
    WriteFile(folder / "cases" / name / "hull", hull.name + "\n");
    WriteFile(folder / "labels" / (name + ".sealed"), Sealed(label, name));
  }
  progress(done, all);
}

std::string WriteSingleCase(const SingleCaseOptions& options, const std::filesystem::path& folder) {
  const std::vector<Hull> fleet = Fleet(options.set, options.seed);
  const auto hull = std::find_if(fleet.begin(), fleet.end(), [&](const Hull& candidate) {
    return options.hull.empty() || candidate.name == options.hull;
  });
  if (hull == fleet.end()) {
    std::string known;
    for (const Hull& candidate : fleet) known += " " + candidate.name;
    throw std::invalid_argument("no hull " + options.hull + " in this set; there are" + known);
  }
  const RandomStream rng = Yard(options.set, options.seed).For("single case");
  const Case asked{options.effects.empty() ? "nominal" : "single", options.effects, {}};
  const auto [run, label] = Prepared(asked, *hull, options.onset_s, options.duration_s, rng);
  Record(run, options.set, kDaysBefore, rng, folder / "log");
  WriteFile(folder / "hull", hull->name + "\n");
  WriteFile(folder / "vehicle.textproto", VehicleFile(*hull));
  WriteFile(folder / "label.sealed", Sealed(label, "single"));
  return label;
}

}  // namespace blind::truth
