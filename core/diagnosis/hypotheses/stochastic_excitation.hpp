#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"

namespace telltale {

/// The peak in the spectrum of the accelerations that the nominal boat leaves unexplained, within
/// the range of the library's stochastic effect, and what it does to the errors of free runs.
/// `errors` are those of the boat itself. Nothing where the library has no stochastic effect.
ObservedExcitation ObservedExcitationOf(std::span<const Effect* const> library,
                                        const FreeRuns& runs,
                                        const std::vector<PreparedDataset>& references,
                                        const AugmentedModel& boat, const Eigen::MatrixXd& errors);

/// The same of what `effects` leave. A current moves a boat at the frequency at which it turns, and
/// at harmonics of it: to the boat that knows of no current that is a peak.
ObservedExcitation ExcitationBeside(const Effect& stochastic,
                                    const std::vector<ModelledEffect>& effects,
                                    const DiagnosisProblem& problem);

/// The peak alone.
SpectralPeak PeakBeside(const Effect& stochastic, const std::vector<ModelledEffect>& effects,
                        const DiagnosisProblem& problem);

/// An effect whose accelerations are random: free runs cannot predict it, but their errors scatter
/// more, as observed, docs/concepts/diagnosis.md (90). The errors stay as they are. Errors of
/// windows grow most by the lowest frequencies of a peak, of which its spectrum shows least: the
/// scatter is that of the spectrum times the likeliest factor for `left`, the errors that other
/// effects leave. The score is the evidence for the scatter, and no more than what the peak itself
/// gains. Requires: a stochastic effect.
EffectFit FitStochasticExcitation(const Effect& effect, const ObservedExcitation& observed,
                                  const DiagnosisProblem& problem, const ResidualMetric& metric,
                                  const Eigen::MatrixXd& left);

/// Deterministic effects together with a stochastic one: fitted to errors that scatter as the
/// problem's excitation says, and once more with the excitation and the scatter that they leave.
EffectFit FitBeside(const Effect& stochastic, const DiagnosisProblem& problem,
                    const ResidualMetric& metric, const std::vector<const Effect*>& effects,
                    const Eigen::VectorXd& start);

/// The covariance that a stochastic effect of these values adds to a window's errors. Zero where no
/// effect is stochastic. Shapes: rows x rows.
Eigen::MatrixXd ScatterOf(const std::vector<ModelledEffect>& effects, const FreeRuns& runs,
                          const AugmentedModel& boat);

/// By how much the stochastic effects of a fit, and the gusts, drifts and spells that it allows
/// for, raise the mean square of each row's error.
Eigen::VectorXd StochasticMeanSquares(const EffectFit& fit, const FreeRuns& runs,
                                      const AugmentedModel& boat);

/// In sigmas, what the effect's typical size adds to the scatter of a nominal boat's windows.
double StochasticDetectability(const Effect& effect, const DiagnosisProblem& problem);

}  // namespace telltale
