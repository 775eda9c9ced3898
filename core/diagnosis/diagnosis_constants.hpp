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
  double largest_error = 1e3;                ///< m and rad, limit of a single error; convention
  double minimum_position_noise_m = 0.005;   ///< m, floor of the weight of a fix; convention
  double minimum_heading_noise_rad = 0.001;  ///< rad, floor of the weight of a heading; convention
};

/// The gap and its noise floor, docs/concepts/diagnosis.md (80).
struct GapConstants {
  double largest_sigmas = 100.0;      ///< 1, root mean square at which a window's error is cut
  double block_s = 30.0;              ///< s, within which errors may be correlated
  std::size_t resamples = 1000;       ///< block bootstrap, convention
  double level = 0.95;                ///< 1, of every bound, convention
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

/// The linearisation of free runs and their response to harmonic accelerations, (84), (90).
struct LinearisationConstants {
  double negligible_size = 0.02;        ///< typical sizes, below which an effect is left out
  std::size_t frequencies = 12;         ///< per stochastic effect, in even ratios
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
  double converged_ratio = 0.995;         ///< 1, of the whitened square after a step to that before
  int covariance_rounds = 2;              ///< covariance and unknowns in turn, per step
  int variance_iterations = 25;           ///< unknowns and their variances in turn, per round
  std::array<double, 8> step_lengths = {1.0,  0.7,  0.5,  0.35,
                                        0.25, 0.12, 0.06, 0.03};  ///< 1, of a Gauss-Newton step
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

struct DiagnosisConstants {
  HorizonConstants horizons;
  FreeRunConstants free_runs;
  GapConstants gap;
  LocalisationConstants localisation;
  LinearisationConstants linearisation;
  WiringConstants wiring;
  BaselineConstants baseline;
  ResidualMetricConstants metric;
};

inline constexpr DiagnosisConstants kDiagnosis;

}  // namespace telltale
