#pragma once

#include <array>
#include <cstddef>

namespace telltale {

// Every tuned constant of the diagnosis stands here, with its unit. A line that names no other data
// set holds a value chosen on the development set of the blind check, seed 1
// (docs/validation/blind-checks.md). "Convention" marks a value that no data set chose. Tolerances
// of rounding and steps of numerical derivatives stay beside their algorithm.

/// Horizons of the free runs, shared by all stages.
struct HorizonConstants {
  std::array<double, 3> horizons_s = {1.0, 5.0, 10.0};  ///< s, convention
  double main_s = 5.0;  ///< s, the horizon that the verdict is about, convention
};

/// Free runs, docs/concepts/diagnosis.md (82), (83).
struct FreeRunConstants {
  double bins_per_window = 10.0;             ///< 1, none shorter than a sampling period
  double minimum_position_noise_m = 0.005;   ///< m, floor of the weight of a fix; convention
  double minimum_heading_noise_rad = 0.001;  ///< rad, floor of the weight of a heading; convention
};

/// The gap and its noise floor, docs/concepts/diagnosis.md (80).
struct GapConstants {
  double largest_sigmas = 100.0;      ///< 1, root mean square at which a window's error is cut
  double block_s = 30.0;              ///< s, within which errors may be correlated
  std::size_t resamples = 1000;       ///< block bootstrap, convention
  double level = 0.95;                ///< 1, of every bound, convention
  double left_out_level = 0.99;       ///< 1, of days that took no part: false alarms on 1 % of days
  double single_recording_sd = 0.25;  ///< 1, sd of ln G^2 between days given one reference
  double minimum_sd = 0.2;            ///< 1, sd of ln G^2 between days at least
};

/// The localisation of the gap, docs/concepts/diagnosis.md (93), (94).
struct LocalisationConstants {
  double cluster_s = 5.0;        ///< s, within which residuals may be correlated
  double after_step_s = 1.0;     ///< s, how long commands count as just changed
  double command_step = 0.1;     ///< 1, of full command, change that counts as a step
  std::size_t replicates = 500;  ///< of random signs, convention
  double significance = 0.05;    ///< 1, family-wise, convention
  double material_share = 0.05;  ///< 1, of the excess that a listed cell holds at least
  double density_ratio = 1.5;    ///< 1, excess per row of a nested cell over that of the wider one
  std::size_t minimum_clusters = 6;                         ///< of a cell that is tested
  std::array<double, 3> speed_edges_m_s = {0.5, 1.0, 1.5};  ///< m/s, convention
  double bias_share = 0.3;    ///< 1, of the excess that makes a cell a bias (Theil)
  double slope_share = 0.3;   ///< 1, of the excess that makes a cell a slope
  double timing_share = 0.1;  ///< 1, of bias and slope together; below it the cell is noise
};

/// The missing force, docs/concepts/diagnosis.md (122).
struct MissingForceConstants {
  std::size_t bins = 10;        ///< of each variable, convention
  double significance = 0.01;   ///< 1, of a variable, over all components and variables, convention
  double telling_share = 0.15;  ///< 1, of the mean square that a sentence names, convention
};

/// The linearisation of free runs and their response to harmonic accelerations, (84), (90).
struct LinearisationConstants {
  double negligible_size = 0.02;        ///< typical sizes, below which an effect is left out
  double harmonic_acceleration = 0.05;  ///< m/s^2, m/s^2, rad/s^2: small enough to stay linear
};

/// The check of the thrusters' wiring.
struct WiringConstants {
  double maximum_error_ratio = 0.2;  ///< 1, of squared errors, rewired to as wired
  double largest_error = 1.0;        ///< m and rad, at which an error is cut
};

/// The nominal baseline, docs/concepts/diagnosis.md (84) to (86).
struct BaselineConstants {
  double prior_effect_size = 0.1;  ///< typical sizes, prior sd of fixed and per-recording effects
  double prior_recordings = 1.0;   ///< recordings, weight of that prior
  double initial_fixed_effect_sd = 0.5;   ///< typical sizes, where the estimation of the sd starts
  double coefficient_prior_scale = 10.0;  ///< standard errors of the model, prior sd of its error
  double slope_step = 0.1;                ///< typical sizes, step of the secants
  int maximum_recalibrations = 8;         ///< Gauss-Newton steps with new slopes
  double converged_ratio = 0.97;          ///< 1, of the variance after a step to that before
  int covariance_rounds = 2;              ///< covariance and unknowns in turn, per step
  int variance_iterations = 25;           ///< unknowns and their variances in turn, per round
  std::array<double, 8> step_lengths = {1.0,  0.7,  0.5,  0.35,
                                        0.25, 0.12, 0.06, 0.03};  ///< 1, of a Gauss-Newton step
  double astray_ratio = 4.0;  ///< 1, of squared gaps, that a trusted step makes; convention
  double covariance_shrinkage = 0.15;  ///< 1, times rows per window: share of the diagonal in V
  double minimum_covariance_shrinkage = 0.01;  ///< 1
  double maximum_covariance_shrinkage = 0.3;   ///< 1
  double minimum_kappa = 0.1;                  ///< independent windows per window, at least
  double maximum_optimism = 10.0;              ///< 1, largest factor n / (n - rows - 1)
};

/// The residual metric, docs/concepts/diagnosis.md (87), (89).
struct ResidualMetricConstants {
  double observations_per_window = 0.5;  ///< effective independent observations of a window
  double free_coefficient_sd = 100.0;    ///< standard errors of the model: unbounded in effect
  double largest_sigmas = 50.0;          ///< 1, root mean square at which a window's error is cut
};

/// What a recording needs to be diagnosed, and what stands in for references.
struct RecordingConstants {
  double minimum_duration_s = 60.0;      ///< s, in all segments together, convention
  std::size_t minimum_windows = 12;      ///< of the main horizon, convention
  double minimum_speed = 0.05;           ///< m/s and rad/s, of a boat that is under way, convention
  std::size_t synthetic_references = 4;  ///< simulated where there are no reference logs
  std::size_t few_references = 3;        ///< below these a note says so, convention
};

/// The fit of effects, docs/concepts/diagnosis.md (88), (89).
struct EffectFitConstants {
  double prior_width = 2.0;  ///< typical sizes, prior sd of a parameter; of a shape parameter: 1
  double beyond_threshold = 2.5;  ///< typical sizes, a start beyond a threshold; convention
  double whole_sd = 0.1;          ///< 1, of the share of an effect that is there or not; convention
  int maximum_iterations = 12;    ///< Levenberg-Marquardt
  double converged_gain = 0.01;   ///< of -2 ln of the posterior, below which a step is the last
  double minimum_remaining_share = 1e-3;  ///< 1, of the square that the score test leaves at least
};

/// What varies within a recording, docs/concepts/diagnosis.md (97).
struct VariationConstants {
  double fastest_radians = 5.0;   ///< rad within a time constant, from which on a drift is fast
  int most_half_turns = 24;       ///< of a drift over a recording; what is faster is fast
  int half_turns_of_a_spell = 5;  ///< within a window, of the fastest course that counts
  double least_mean = 0.15;       ///< 1, over the scatter of what acts for 2 % of the time
  double most_mean = 1.0;         ///< 1, likewise for half of the time; beyond it, it lasts
  double least_scatter = 1e-4;    ///< 1, of the variance that an intermittent effect stands for
};

/// The search for hypotheses.
struct SearchConstants {
  std::size_t effects_fitted_in_full = 14;  ///< of those that the score test ranks first
  std::size_t seed_hypotheses = 2;          ///< single effects to which a second one is added
  std::size_t candidates_per_seed = 5;      ///< second and third effects fitted for each
  double least_promise = 2.0;               ///< -2 ln likelihood, of a score test that is followed
  double score_to_add_effect = 12.0;        ///< -2 ln evidence, decrease that one more effect needs
  double score_to_add_weather = 6.0;        ///< the same of the first weather, there on most days
  double separable_nats = 3.0;       ///< nats, below which two hypotheses are indistinguishable
  double nominal_gain_factor = 1.5;  ///< 1, times the evidence that an effect has on references
  std::size_t most_effects = 3;      ///< that may act together, limit of the option
};

/// The peak in the spectrum of residual accelerations, docs/concepts/diagnosis.md (116), (118).
struct SpectralPeakConstants {
  double block_s = 30.0;             ///< s, of one periodogram, convention
  double smoothing_s = 0.6;          ///< s, half width of the filter of the rows
  std::size_t least_half_width = 2;  ///< rows, of a filter of third degree
  double quantile = 0.4;             ///< 1, of the half minutes' powers, that counts
  double highest_hz = 1.6;           ///< Hz, of a periodogram, above what short waves are met with
  std::size_t first_harmonic = 2;    ///< of a block; below it Hann's taper sees the mean
  double least_power_gain = 2e-3;    ///< 1, of the filter, at a frequency that counts
  std::array<double, 3> log_widths = {0.1, 0.2, 0.3};  ///< 1, sd of the logarithm of frequency
  std::size_t frequencies = 18;                        ///< of the peak, in even ratios
  std::array<double, 4> corners_hz = {0.03, 0.1, 0.3, 1.0};  ///< Hz, of broad shapes
  int iterations = 60;         ///< multiplicative updates of a mixture
  double initial_share = 0.1;  ///< 1, of the power, where a peak starts
  double shape_error = 0.01;   ///< 1, of the logarithm of what a spectrum differs from nominal
};

/// The direction of waves, docs/concepts/diagnosis.md (128), (129). Development set of seed 72.
struct WaveDirectionConstants {
  std::size_t directions = 72;  ///< that are compared, convention
  double window_s = 5.0;        ///< s, of one likelihood
  double row_s = 0.4;           ///< s, from reading to reading
  std::size_t frequencies = 4;  ///< of the sea, each with a phase of its own in every window
  std::array<double, 3> force_ratios = {0.6, 1.0, 1.6};  ///< 1, of sway to surge, in m/s^2
  double unlike_any = 100.0;    ///< 1, variance of a window's mean and trend, of the spectrum's own
  std::size_t resamples = 200;  ///< of half minutes, convention
};

/// The scatter of windows in waves, docs/concepts/diagnosis.md (90).
struct StochasticExcitationConstants {
  /// 1, by which windows may scatter more than the spectrum of the accelerations says.
  std::array<double, 4> factors = {1.0, 1.4, 2.0, 2.8};
};

/// The lack of fit, docs/concepts/diagnosis.md (98).
struct LackOfFitConstants {
  double prior_effect_sd = 0.3;  ///< typical sizes, of each effect in what a fit leaves
};

/// Weights of a logistic regression: the log odds of an unknown cause, docs/concepts/diagnosis.md
/// step 10.
struct UnknownWeights {
  double intercept = 0.0;
  double per_log_share = 0.0;           ///< per unit of ln of the share of the excess that is left
  double per_misfit = 0.0;              ///< per unit of ln of the lack of fit over the nominal one
  double per_median_misfit = 0.0;       ///< the same of the median window
  double per_predictable = 0.0;         ///< per unit of LackOfFit::predictable
  double per_negative_log_prior = 0.0;  ///< per nat
  double per_further_fault = 0.0;       ///< per fault after the first
  double of_drift = 0.0;                ///< where something drifts
  double of_waves = 0.0;                ///< where something is stochastic
  double of_intermittence = 0.0;        ///< where something is intermittent
};

/// Gap assessment, ranking and verdict, docs/concepts/diagnosis.md (91). The weights are of
/// least logarithmic score over the development sets of seeds 61 and 62, with the true effect in
/// the library, and without it where a stranger is the likeliest; the intercepts and the weight of
/// further faults are chosen on seeds 65 and 72.
struct RankingConstants {
  double material_score = 8.0;            ///< -2 ln evidence, beyond which a gap is material
  double material_log_lack_of_fit = 0.9;  ///< 1, ln of the lack of fit over that of references
  double equivalence_factor = 2.0;        ///< 1, upper bound of G^2 over the floor's limit
  double nominal_median = 0.75;           ///< 1, of the windows' squares, over their mean; seed 61
  UnknownWeights unknown_beside_faults = {.intercept = -0.95,
                                          .per_log_share = 1.45,
                                          .per_misfit = 1.5,
                                          .per_median_misfit = 1.9,
                                          .per_predictable = 0.45,
                                          .per_negative_log_prior = 3.35,
                                          .per_further_fault = 1.0,
                                          .of_drift = 1.9,
                                          .of_waves = 2.3,
                                          .of_intermittence = 3.55};
  UnknownWeights unknown_beside_weather = {.intercept = -4.9,
                                           .per_misfit = 4.25,
                                           .per_predictable = 7.1,
                                           .of_drift = 0.35,
                                           .of_waves = 1.2};
  double explained_share = 0.7;     ///< 1, of the excess, from which on a gap is explained
  double naming_probability = 0.9;  ///< of a named cause at least, development sets 2 and 3
};

/// The delays that recordings show by themselves, docs/concepts/diagnosis.md (120).
struct DelayConstants {
  double between_days_sd_s = 0.02;     ///< s, half-normal prior of the sd between nominal days
  double time_constant_sd_s = 0.02;    ///< s, prior sd of one recording's propellers
  double delay_sd_s = 0.4;             ///< s, likewise of its delays: that of the effects
  std::size_t least_references = 2;    ///< that show their delays, convention
  std::size_t posterior_draws = 1000;  ///< behind each standard error
};

/// The onset, docs/concepts/diagnosis.md (95).
struct OnsetConstants {
  double minimum_deviance = 20.0;   ///< -2 ln likelihood, besides 2 ln of the number of windows
  double interval_deviance = 3.84;  ///< -2 ln likelihood, chi-squared of one at 95 %
  std::size_t minimum_windows = 4;  ///< on either side of an onset, convention
};

/// The testability of effects, docs/concepts/diagnosis.md (92), (99).
struct TestabilityConstants {
  double power = 0.9;              ///< 1, probability that a detectable size shows, convention
  double detectable_sigmas = 3.0;  ///< sigmas, that the typical size shows at least, convention
};

/// The manoeuvres that separate hypotheses, docs/concepts/diagnosis.md (96).
struct SeparationConstants {
  double decisive_nats = 5.0;   ///< nats, above which a manoeuvre is expected to decide
  double minimum_nats = 1.0;    ///< nats, below which a manoeuvre is not advised
  std::size_t most_advice = 3;  ///< manoeuvres, convention
  double cruise_command = 0.4;  ///< 1, of full command, before a manoeuvre; convention
  double cruise_s = 10.0;       ///< s, how long; convention
};

/// What a report lists.
struct ReportConstants {
  std::size_t most_causes = 5;                ///< besides the unknown one, convention
  double minimum_listed_probability = 0.001;  ///< of a cause after the first, convention
};

struct DiagnosisConstants {
  HorizonConstants horizons;
  FreeRunConstants free_runs;
  GapConstants gap;
  LocalisationConstants localisation;
  MissingForceConstants missing_force;
  LinearisationConstants linearisation;
  WiringConstants wiring;
  BaselineConstants baseline;
  ResidualMetricConstants metric;
  RecordingConstants recording;
  EffectFitConstants effect_fit;
  VariationConstants variation;
  SearchConstants search;
  SpectralPeakConstants spectral_peak;
  WaveDirectionConstants wave_direction;
  StochasticExcitationConstants stochastic_excitation;
  LackOfFitConstants lack_of_fit;
  RankingConstants ranking;
  DelayConstants delays;
  OnsetConstants onset;
  TestabilityConstants testability;
  SeparationConstants separation;
  ReportConstants report;
};

inline constexpr DiagnosisConstants kDiagnosis;

}  // namespace telltale
