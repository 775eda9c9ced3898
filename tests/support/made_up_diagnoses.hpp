#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "telltale/core/diagnosis/diagnosis.hpp"

namespace telltale {

// ---- made up, for what carries or shows diagnoses rather than computes them ---------------------

inline Gap MadeUpGap(double horizon_s, std::size_t windows) {
  const double n = horizon_s / 7.0;
  Gap gap;
  gap.horizon_s = horizon_s;
  gap.windows = windows;
  gap.all = {4.0 + n, 1.75 + n / 3.0, 1.0 + n / 64.0, 1.25 + n / 32.0};
  gap.channels = {GapSize{1.5 + n, 1.25, 1.0, 1.125}, GapSize{2.5 + n, 1.5, 1.0625, 1.1875},
                  GapSize{6.5 + n, 1.625, 0.9375, 1.21875}};
  gap.excess_explained = ExcessExplained{0.81, {0.95, 0.74, 0.87}};
  gap.channel_excess_explained = {ExcessExplained{-0.25, {0.95, -0.5, 0.125}}, std::nullopt,
                                  ExcessExplained{0.875, {0.95, 0.75, 0.9375}}};
  return gap;
}

/// A window in which the boat turns to starboard while the model goes nearly straight on.
inline WindowPicture MadeUpWindow(std::size_t i) {
  const double n = static_cast<double>(i);
  WindowPicture window;
  window.time_s = 1700000000.0 + 5.0 * n;
  window.before = 1.0 + std::abs(3.5 * std::sin(0.37 * n)) + (i > 40 ? 2.0 : 0.0);
  window.after = 0.75 + std::abs(0.5 * std::sin(0.53 * n));
  window.psi_rad = 0.19 * n;
  window.speed_m_s = 0.7 + 0.6 * std::sin(0.23 * n);
  window.region = kPropellerRegions[i % 11 < 6 ? 0 : i % 3];
  window.error_before = {0.5 * std::sin(n), -0.25, 0.125};
  window.error_after = {0.0625 * std::sin(n), -0.03125, 0.015625};
  for (int k = 0; k <= 20; ++k) {
    const double s = 0.25 * k;
    const double heading = window.psi_rad;
    const auto along = [&](double turn) {
      const double psi = heading + turn * s / 5.0;
      return Eigen::Vector2d(s * std::cos(psi), s * std::sin(psi));
    };
    window.measured.push_back(along(0.6));
    window.predicted_before.push_back(along(0.1));
    window.predicted_after.push_back(along(0.55));
  }
  return window;
}

inline FreeRunScores MadeUpScores(double horizon_s, double factor) {
  FreeRunScores scores;
  scores.horizon_s = horizon_s;
  for (std::size_t i = 0; i < 3; ++i) {
    const double n = factor * (1.0 + static_cast<double>(i)) / 32.0;
    scores.velocity[i] = {n, n / 2.0, 1.0 - n, 3.0 * n, 0.0078125};
  }
  scores.position_rmse_m = factor / 3.0;
  scores.windows = 24;
  return scores;
}

/// Every part is there and every number is another; two effects act together.
inline Diagnosis MadeUpDiagnosis() {
  Diagnosis made;
  made.vehicle_id = "made-up.1";
  made.verdict = Verdict::kPartlyExplained;
  made.sentence =
      "Port thruster 22 ± 3 % weaker than the model and thrust 0.15 s late: 81 % [74, 87] of the "
      "gap; the rest is unknown and sits in heading, FR.";
  made.floor_basis = FloorBasis::kReferenceLogs;
  made.reference_logs = 3;
  made.start_s = 1700000000.0;
  made.end_s = 1700000400.5;
  made.gaps = {MadeUpGap(1.0, 395), MadeUpGap(5.0, 78), MadeUpGap(10.0, 0)};
  made.where = {
      {Equation::kYaw, PropellerRegion::kFF, "0.5 to 1.0 m/s", 0.4375, 0.002, GapKind::kSlope, 3.25,
       31},
      {Equation::kYaw, PropellerRegion::kFR, "", 0.21875, 0.0125, GapKind::kBias, -1.5, 9},
      {Equation::kSurge, std::nullopt, "after a step", 0.125, 0.03125, GapKind::kTiming, 0.5, 17},
      {Equation::kSway, PropellerRegion::kRF, "heading N", 0.0625, 0.046875, GapKind::kNoise, 0.25,
       5}};
  Cause both;
  both.effects = {{"thruster_imbalance",
                   {{"loss_port", 0.22, 0.03, "1"}, {"loss_starboard", 0.01, 0.0225, "1"}},
                   "port thruster 22 % weaker",
                   0.75},
                  {"thruster_lag", {{"tau", 0.15, 0.035, "s"}}, "thrust 0.15 s late", 0.25}};
  both.probability = 0.8125;
  both.indistinguishable = {"thruster_delay"};
  both.excess_explained = ExcessExplained{0.81, {0.95, 0.74, 0.87}};
  Cause one;
  one.effects = {both.effects[0]};
  one.effects[0].shapley_share = 0.5;
  one.probability = 0.125;
  one.excess_explained = ExcessExplained{0.59375, {0.95, 0.46875, 0.6875}};
  one.effects.push_back({"wind",
                         {{"wind_north", 3.0, 0.5, "m/s"}, {"wind_east", -4.0, 0.25, "m/s"}},
                         "5.0 m/s of wind towards NW",
                         0.5,
                         ParameterEstimate{"speed", 5.0, 0.375, "m/s"},
                         CircularInterval{5.356, 0.125, true}});
  Cause unknown;
  unknown.probability = 0.0625;
  made.causes = {both, one, unknown};
  made.unknown_odds = {{"constant", 1.0, 0.05},        {"log_unexplained_share", -1.5, -2.25},
                       {"log_misfit", 0.0, 0.0},       {"log_median_misfit", -0.25, -0.5},
                       {"predictable", 0.125, 0.4375}, {"drift", 0.0, 0.0}};
  made.delays = {{DelayedChannel::kCommands, -0.0625, 0.125, 2.5, 0.75},
                 {DelayedChannel::kFixes, 0.375, 0.0625, -16.5, std::nullopt}};
  made.present_weather = {"wind"};
  made.effects = {{"wind", Testability::kTestable, 12.5, ""},
                  {"thruster_imbalance",
                   Testability::kTestable,
                   31.25,
                   "",
                   {{"loss_port", 0.046875, "1"}, {"loss_starboard", std::nullopt, "1"}}},
                  {"added_mass_coupling", Testability::kMasked, 0.75, "YAW uv"},
                  {"waves", Testability::kNotExcited, 0.125, ""}};
  made.advice = {{"fast random steps",
                  "step each thruster every 2 s between 30 and 80 %",
                  {"thruster_lag", "thruster_delay"},
                  120.0,
                  7.25,
                  true},
                 {"coast-down",
                  "full ahead for 20 s, then nothing",
                  {"thruster_lag", "thruster_delay"},
                  60.0,
                  1.5,
                  false}};
  made.reference_influence = {
      {"monday", Verdict::kUnknownCause, {"wind", "current"}, 0.625, {4.5, 4.5, 1.25, 1.75}, 1.5},
      {"tuesday", Verdict::kNoMaterialGap, {}, 0.0, {2.5, 2.5, 1.5, 3.25}},
      {"friday", Verdict::kUnknown, {}, 0.0, {}}};
  made.nominal_days_limit = 2.75;
  MissingForce missing;
  missing.mass_kg = 15.0;
  missing.mean = {{{-2.5, 0.5}, {0.25, 0.125}, {0.0625, 0.03125}}};
  missing.constant_share = {0.5, 0.125, 0.0};
  missing.scatter = {3.5, 1.25, 0.75};
  missing.excess = {4.5, 0.5, -0.25};
  ForceProfile over;
  over.variable = ForceVariable::kHeading;
  over.share = {0.25, 0.0, 0.0625};
  over.bins = {{0.0, 36.0, {{{-4.0, 0.75}, {0.5, 0.25}, {0.125, 0.0625}}}, 120},
               {36.0, 72.0, {{{1.5, 0.5}, {-0.5, 0.25}, {-0.25, 0.125}}}, 95}};
  missing.over = {over};
  missing.sentence = "a surge force that is -4.0 ± 0.8 N on headings of 0 to 36 deg";
  made.missing_force = missing;
  made.onset = Onset{1700000205.0, 1700000195.0, 1700000220.0};
  made.rest = "heading, FR";
  made.improvement = Improvement{{MadeUpScores(1.0, 2.0), MadeUpScores(5.0, 4.0)},
                                 {MadeUpScores(1.0, 1.0), MadeUpScores(5.0, 1.5)}};
  for (std::size_t i = 0; i < 80; ++i) made.pictures.push_back(MadeUpWindow(i));
  made.notes = {"the wind was not measured", "one reference recording is shorter than this one"};
  made.seed = std::numeric_limits<std::uint64_t>::max();
  made.software_version = "0.2.0";
  return made;
}

/// A nominal boat on a short recording: as little as a diagnosis can hold.
inline Diagnosis MadeUpNominalDiagnosis() {
  Diagnosis made;
  made.vehicle_id = "made-up.1";
  made.verdict = Verdict::kNoMaterialGap;
  made.sentence = "No material gap: the model predicts this recording as well as a nominal one.";
  made.floor_basis = FloorBasis::kSensorNoise;
  made.end_s = 75.0;
  Gap gap = MadeUpGap(5.0, 15);
  gap.all = {1.0625, 1.0625, 1.0, 1.25};
  gap.channels = {gap.all, gap.all, gap.all};
  gap.excess_explained.reset();
  gap.channel_excess_explained = {};
  made.gaps = {gap};
  return made;
}

// ---- every number, bit for bit ------------------------------------------------------------------

inline void ExpectSame(const std::optional<ExcessExplained>& a,
                       const std::optional<ExcessExplained>& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (!a) return;
  EXPECT_EQ(a->share, b->share);
  EXPECT_EQ(a->interval.level, b->interval.level);
  EXPECT_EQ(a->interval.lower, b->interval.lower);
  EXPECT_EQ(a->interval.upper, b->interval.upper);
}

inline void ExpectSame(const GapSize& a, const GapSize& b) {
  EXPECT_EQ(a.before, b.before);
  EXPECT_EQ(a.after, b.after);
  EXPECT_EQ(a.noise_floor, b.noise_floor);
  EXPECT_EQ(a.floor_limit, b.floor_limit);
}

inline void ExpectSame(const Gap& a, const Gap& b) {
  EXPECT_EQ(a.horizon_s, b.horizon_s);
  EXPECT_EQ(a.windows, b.windows);
  ExpectSame(a.all, b.all);
  ExpectSame(a.excess_explained, b.excess_explained);
  for (std::size_t i = 0; i < 3; ++i) {
    ExpectSame(a.channels[i], b.channels[i]);
    ExpectSame(a.channel_excess_explained[i], b.channel_excess_explained[i]);
  }
}

inline void ExpectSame(const GapCell& a, const GapCell& b) {
  EXPECT_EQ(a.channel, b.channel);
  EXPECT_EQ(a.region, b.region);
  EXPECT_EQ(a.bin, b.bin);
  EXPECT_EQ(a.excess_share, b.excess_share);
  EXPECT_EQ(a.p_value, b.p_value);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.mean, b.mean);
  EXPECT_EQ(a.windows, b.windows);
}

inline void ExpectSame(const ParameterEstimate& a, const ParameterEstimate& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.estimate, b.estimate);
  EXPECT_EQ(a.standard_error, b.standard_error);
  EXPECT_EQ(a.unit, b.unit);
}

inline void ExpectSame(const CausalEffect& a, const CausalEffect& b) {
  EXPECT_EQ(a.effect, b.effect);
  EXPECT_EQ(a.sentence, b.sentence);
  EXPECT_EQ(a.shapley_share, b.shapley_share);
  ASSERT_EQ(a.parameters.size(), b.parameters.size());
  for (std::size_t i = 0; i < a.parameters.size(); ++i) {
    ExpectSame(a.parameters[i], b.parameters[i]);
  }
  ASSERT_EQ(a.size.has_value(), b.size.has_value());
  if (a.size) ExpectSame(*a.size, *b.size);
  ASSERT_EQ(a.towards.has_value(), b.towards.has_value());
  if (!a.towards) return;
  EXPECT_DOUBLE_EQ(a.towards->centre_rad, b.towards->centre_rad);
  EXPECT_DOUBLE_EQ(a.towards->half_width_rad, b.towards->half_width_rad);
  EXPECT_EQ(a.towards->or_opposite, b.towards->or_opposite);
}

inline void ExpectSame(const Cause& a, const Cause& b) {
  ASSERT_EQ(a.effects.size(), b.effects.size());
  for (std::size_t i = 0; i < a.effects.size(); ++i) ExpectSame(a.effects[i], b.effects[i]);
  EXPECT_EQ(a.probability, b.probability);
  EXPECT_EQ(a.indistinguishable, b.indistinguishable);
  ExpectSame(a.excess_explained, b.excess_explained);
}

inline void ExpectSame(const EffectTestability& a, const EffectTestability& b) {
  EXPECT_EQ(a.effect, b.effect);
  EXPECT_EQ(a.testability, b.testability);
  EXPECT_EQ(a.detectability, b.detectability);
  EXPECT_EQ(a.masked_by, b.masked_by);
  ASSERT_EQ(a.detectable_sizes.size(), b.detectable_sizes.size());
  for (std::size_t i = 0; i < a.detectable_sizes.size(); ++i) {
    EXPECT_EQ(a.detectable_sizes[i].parameter, b.detectable_sizes[i].parameter);
    EXPECT_EQ(a.detectable_sizes[i].size, b.detectable_sizes[i].size);
    EXPECT_EQ(a.detectable_sizes[i].unit, b.detectable_sizes[i].unit);
  }
}

inline void ExpectSame(const ReferenceInfluence& a, const ReferenceInfluence& b) {
  EXPECT_EQ(a.reference, b.reference);
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_EQ(a.effects, b.effects);
  EXPECT_EQ(a.probability, b.probability);
  ExpectSame(a.gap, b.gap);
  EXPECT_EQ(a.own_gap, b.own_gap);
}

inline void ExpectSame(const ForceMean& a, const ForceMean& b) {
  EXPECT_EQ(a.mean, b.mean);
  EXPECT_EQ(a.half_width, b.half_width);
}

inline void ExpectSame(const ForceBin& a, const ForceBin& b) {
  EXPECT_EQ(a.low, b.low);
  EXPECT_EQ(a.high, b.high);
  EXPECT_EQ(a.rows, b.rows);
  for (std::size_t i = 0; i < 3; ++i) ExpectSame(a.force[i], b.force[i]);
}

inline void ExpectSame(const ForceProfile& a, const ForceProfile& b) {
  EXPECT_EQ(a.variable, b.variable);
  EXPECT_EQ(a.share, b.share);
  ASSERT_EQ(a.bins.size(), b.bins.size());
  for (std::size_t i = 0; i < a.bins.size(); ++i) ExpectSame(a.bins[i], b.bins[i]);
}

inline void ExpectSame(const MissingForce& a, const MissingForce& b) {
  EXPECT_EQ(a.mass_kg, b.mass_kg);
  EXPECT_EQ(a.sentence, b.sentence);
  EXPECT_EQ(a.constant_share, b.constant_share);
  EXPECT_EQ(a.scatter, b.scatter);
  EXPECT_EQ(a.excess, b.excess);
  for (std::size_t i = 0; i < 3; ++i) ExpectSame(a.mean[i], b.mean[i]);
  ASSERT_EQ(a.over.size(), b.over.size());
  for (std::size_t i = 0; i < a.over.size(); ++i) ExpectSame(a.over[i], b.over[i]);
}

inline void ExpectSame(const SeparationAdvice& a, const SeparationAdvice& b) {
  EXPECT_EQ(a.manoeuvre, b.manoeuvre);
  EXPECT_EQ(a.how, b.how);
  EXPECT_EQ(a.separates, b.separates);
  EXPECT_EQ(a.duration_s, b.duration_s);
  EXPECT_EQ(a.expected_nats, b.expected_nats);
  EXPECT_EQ(a.decisive, b.decisive);
}

inline void ExpectSame(const FreeRunScores& a, const FreeRunScores& b) {
  EXPECT_EQ(a.horizon_s, b.horizon_s);
  EXPECT_EQ(a.position_rmse_m, b.position_rmse_m);
  EXPECT_EQ(a.windows, b.windows);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(a.velocity[i].rmse, b.velocity[i].rmse);
}

/// But for the paths.
inline void ExpectSame(const WindowPicture& a, const WindowPicture& b) {
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.before, b.before);
  EXPECT_EQ(a.after, b.after);
  EXPECT_EQ(a.psi_rad, b.psi_rad);
  EXPECT_EQ(a.speed_m_s, b.speed_m_s);
  EXPECT_EQ(a.region, b.region);
  EXPECT_EQ(a.error_before, b.error_before);
  EXPECT_EQ(a.error_after, b.error_after);
}

inline void ExpectSame(const DelayDifference& a, const DelayDifference& b) {
  EXPECT_EQ(a.channel, b.channel);
  EXPECT_EQ(a.difference_s, b.difference_s);
  EXPECT_EQ(a.standard_deviation_s, b.standard_deviation_s);
  EXPECT_EQ(a.score, b.score);
  EXPECT_EQ(a.detectable_s, b.detectable_s);
}

inline void ExpectSame(const OddsTerm& a, const OddsTerm& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.log_odds, b.log_odds);
}

template <class Item>
void ExpectSame(const std::vector<Item>& a, const std::vector<Item>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ExpectSame(a[i], b[i]);
}

inline void ExpectSame(const Diagnosis& a, const Diagnosis& b) {
  EXPECT_EQ(a.vehicle_id, b.vehicle_id);
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_EQ(a.sentence, b.sentence);
  EXPECT_EQ(a.floor_basis, b.floor_basis);
  EXPECT_EQ(a.reference_logs, b.reference_logs);
  EXPECT_EQ(a.start_s, b.start_s);
  EXPECT_EQ(a.end_s, b.end_s);
  ExpectSame(a.gaps, b.gaps);
  ExpectSame(a.where, b.where);
  ExpectSame(a.causes, b.causes);
  ExpectSame(a.unknown_odds, b.unknown_odds);
  ExpectSame(a.delays, b.delays);
  ExpectSame(a.effects, b.effects);
  ExpectSame(a.advice, b.advice);
  ExpectSame(a.reference_influence, b.reference_influence);
  EXPECT_EQ(a.nominal_days_limit, b.nominal_days_limit);
  EXPECT_EQ(a.present_weather, b.present_weather);
  ASSERT_EQ(a.onset.has_value(), b.onset.has_value());
  if (a.onset) {
    EXPECT_EQ(a.onset->time_s, b.onset->time_s);
    EXPECT_EQ(a.onset->earliest_s, b.onset->earliest_s);
    EXPECT_EQ(a.onset->latest_s, b.onset->latest_s);
  }
  EXPECT_EQ(a.rest, b.rest);
  ASSERT_EQ(a.missing_force.has_value(), b.missing_force.has_value());
  if (a.missing_force) ExpectSame(*a.missing_force, *b.missing_force);
  ASSERT_EQ(a.improvement.has_value(), b.improvement.has_value());
  if (a.improvement) {
    ExpectSame(a.improvement->before, b.improvement->before);
    ExpectSame(a.improvement->after, b.improvement->after);
  }
  ExpectSame(a.pictures, b.pictures);
  EXPECT_EQ(a.notes, b.notes);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.software_version, b.software_version);
}

}  // namespace telltale
