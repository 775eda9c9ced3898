#include "telltale/core/identification/physical_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "telltale/core/base/format_number.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/version.hpp"
#include "telltale/core/estimation/prediction_error/heterogeneity.hpp"
#include "telltale/core/estimation/prediction_error/prediction_error.hpp"
#include "telltale/core/estimation/prediction_error/score_covariance.hpp"
#include "telltale/core/uncertainty/constrained_estimate.hpp"
#include "telltale/core/uncertainty/interval.hpp"

namespace telltale {
namespace {

using enum FossenParameter;

// Of a recording that differs, over all of them.
constexpr double kDifferenceLevel = 0.05;
constexpr double kLeastCommandDeviation = 0.05;

NoiseModel MeanNoise(const std::vector<NoiseModel>& noise) {
  NoiseModel mean = noise.front();
  const auto average = [&](auto member) {
    double sum = 0.0;
    for (const NoiseModel& one : noise) sum += std::log(member(one));
    return std::exp(sum / static_cast<double>(noise.size()));
  };
  for (Eigen::Index i = 0; i < 3; ++i) {
    mean.acceleration_sigma[i] =
        average([i](const NoiseModel& one) { return one.acceleration_sigma[i]; });
  }
  mean.acceleration_time_constant_s =
      average([](const NoiseModel& one) { return one.acceleration_time_constant_s; });
  mean.fix_drift_sigma_m = average([](const NoiseModel& one) { return one.fix_drift_sigma_m; });
  mean.fix_sigma_m = average([](const NoiseModel& one) { return one.fix_sigma_m; });
  mean.heading_sigma_rad = average([](const NoiseModel& one) { return one.heading_sigma_rad; });
  mean.stamp_sigma_s = average([](const NoiseModel& one) { return one.stamp_sigma_s; });
  return mean;
}

ConstrainedEstimate Constrained(const PredictionErrorFit& fit, const FossenPrior& prior,
                                Eigen::MatrixXd covariance) {
  return {fit.parameters, fit.newton_mean, std::move(covariance), prior.least, prior.greatest};
}

// Each parameter by itself.
std::vector<Coefficient> BoundedParameters(const ConstrainedEstimate& fit, const FossenPrior& prior,
                                           const IdentifyOptions& options) {
  const Eigen::MatrixXd draws = DrawsOf(fit, options.posterior_draws, options.seed);
  const Eigen::VectorXd standard_errors = OfColumns(draws).diagonal().cwiseSqrt();
  const std::vector<Interval> intervals = IntervalsOf(fit, draws, options.interval_level);
  std::vector<Coefficient> parameters;
  for (std::size_t i = 0; i < kFossenParameters; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const FossenParameterName& name = FossenParameterNames()[i];
    Coefficient parameter;
    parameter.symbol = name.symbol;
    parameter.unit = name.unit;
    parameter.estimate = fit.estimate[at];
    parameter.standard_error = standard_errors[at];
    parameter.interval = intervals[i];
    parameter.status = prior.Decides(at, parameter.standard_error) ? CoefficientStatus::kPrior
                                                                   : CoefficientStatus::kEstimated;
    parameters.push_back(parameter);
  }
  return parameters;
}

// The coefficients that the parameters imply, with bounds from the same draws.
void WriteImpliedCoefficients(const FossenVector& parameters, const Eigen::MatrixXd& draws,
                              double separation_m, double level, Identification& identification) {
  const Eigen::VectorXd estimates = CoefficientsOf(parameters, separation_m);
  Eigen::MatrixXd implied(estimates.size(), draws.cols());
  for (Eigen::Index i = 0; i < draws.cols(); ++i) {
    implied.col(i) = CoefficientsOf(WithPositiveMass(draws.col(i)), separation_m);
  }
  const Eigen::MatrixXd covariance = OfColumns(implied);
  const auto write = [&](Eigen::Index at, Coefficient coefficient) {
    coefficient.estimate = estimates[at];
    coefficient.standard_error = std::sqrt(covariance(at, at));
    const auto drawn = implied.row(at);
    coefficient.interval =
        IntervalWithin({drawn.begin(), drawn.end()}, coefficient.estimate, level);
    coefficient.status = CoefficientStatus::kEstimated;
    return coefficient;
  };
  Eigen::Index at = 0;
  for (const Equation equation : kEquations) {
    for (const Regressor& regressor : Regressors(equation, Parameterization::kPropeller)) {
      Coefficient coefficient;
      coefficient.equation = equation;
      coefficient.regressor = regressor.name;
      coefficient.symbol = regressor.symbol;
      coefficient.unit = regressor.unit;
      identification.coefficients.push_back(write(at++, coefficient));
    }
  }
  identification.covariance = covariance.topLeftCorner(at, at);
  Coefficient time_constant;
  time_constant.symbol = "tau";
  time_constant.unit = "s";
  identification.thruster_time_constant = write(at, time_constant);
  identification.time_constant_covariance = covariance.topRightCorner(at, 1);
}

// What a boat has to do for the data to tell a parameter.
std::string_view ManoeuvreThatShows(FossenParameter parameter) {
  switch (parameter) {
    case kXu:
    case kXuu: return "straight runs at several speeds and coasting";
    case kForwardLinear:
    case kForwardQuadratic:
    case kForwardDeadBand: return "small and large commands ahead";
    case kReverseLinear:
    case kReverseQuadratic:
    case kReverseDeadBand: return "small and large commands in reverse";
    case kReverseLoss: return "reverse thrust at speed and at rest";
    case kTimeConstant:
    case kCommandDelay:
    case kFixDelay: return "steps of the commands";
    default: return "turns to both sides at several speeds";
  }
}

Refusal PriorWarning(const PhysicalModel& model) {
  std::string names;
  std::string manoeuvres;
  const auto add = [](std::string_view text, std::string& list) {
    if (list.find(text) != std::string::npos) return;
    list.append(list.empty() ? "" : ", ").append(text);
  };
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    if (model.parameters[i].status != CoefficientStatus::kPrior) continue;
    names += (names.empty() ? "" : ", ") + model.parameters[i].symbol;
    add(ManoeuvreThatShows(static_cast<FossenParameter>(i)), manoeuvres);
  }
  if (names.empty()) return {};
  return {"parameters", "the data hardly narrow the prior of " + names,
          "record " + manoeuvres + ", which show " + names};
}

// Recordings that are not of the same boat as the others, each with the move that shows it.
std::vector<Refusal> DifferingRecordings(const Heterogeneity& heterogeneity,
                                         const FossenVector& parameters) {
  const std::size_t recordings = heterogeneity.recordings.size();
  std::vector<Refusal> warnings;
  for (std::size_t i = 0; i < recordings; ++i) {
    const RecordingDifference& difference = heterogeneity.recordings[i];
    if (difference.p_value * static_cast<double>(recordings) > kDifferenceLevel) continue;
    const FossenParameterName& name =
        FossenParameterNames()[static_cast<std::size_t>(difference.parameter)];
    warnings.push_back(
        {"recordings",
         "number " + std::to_string(i + 1) + " of " + std::to_string(recordings) +
             " differs from the others beyond its bounds (p = " +
             FormatSignificant(difference.p_value, 1) + "): without it " +
             std::string(name.symbol) + " would be " + FormatSignificant(difference.without, 3) +
             " in place of " + FormatSignificant(parameters[At(difference.parameter)], 3),
         "identify it alone and compare; leave it out if the boat was another then"});
  }
  return warnings;
}

double CommandDeviation(const PreparedDataset& dataset) {
  double sum = 0.0;
  double square = 0.0;
  double count = 0.0;
  for (const PreparedRow& row : dataset.rows) {
    for (const double delta : {row.delta.port, row.delta.starboard}) {
      sum += delta;
      square += delta * delta;
      count += 1.0;
    }
  }
  return count == 0.0 ? 0.0 : std::sqrt(std::max(square / count - sum * sum / count / count, 0.0));
}

// What the model's reader should know of it beside its bounds.
std::vector<Refusal> WarningsOf(const PredictionErrorFit& fit, const PhysicalModel& model,
                                const Heterogeneity& heterogeneity) {
  std::vector<Refusal> warnings;
  if (Refusal warning = PriorWarning(model); !warning.subject.empty()) {
    warnings.push_back(std::move(warning));
  }
  if (!fit.converged) {
    warnings.push_back(
        {"model",
         "the fit did not converge: what the commands alone explain of the motion does not settle "
         "the parameters. They are where predictions err least, which disturbances of the boat "
         "bias, and their bounds may not hold",
         "record longer, or in calmer weather, steps of both propellers that do not answer to the "
         "motion, as those of an autopilot on a path do"});
  }
  for (Refusal& warning : DifferingRecordings(heterogeneity, fit.parameters)) {
    warnings.push_back(std::move(warning));
  }
  return warnings;
}

std::string BoundsBasis(const PredictionErrorFit& fit, const Heterogeneity& heterogeneity) {
  std::string basis = "scores of " + std::to_string(fit.blocks.size()) +
                      " blocks of 10 s, Student t, truncated to the physical range";
  if (heterogeneity.birge_ratio > 0.0) {
    basis += "; recordings scatter by " + FormatNumber(heterogeneity.birge_ratio, 2) +
             " of what their bounds expect";
  }
  return basis;
}

// The parameters of a fit with bounds, and draws of all of them together.
struct BoundedFit {
  PhysicalModel model;
  Eigen::MatrixXd draws;
};

BoundedFit Bounded(const PredictionErrorFit& fit, const FossenPrior& prior, double separation_m,
                   const IdentifyOptions& options) {
  const RobustCovariance bounds = CovarianceOf(fit, options.interval_level);
  BoundedFit bounded;
  bounded.draws =
      DrawsOf(Constrained(fit, prior, bounds.covariance), options.posterior_draws, options.seed);
  bounded.model.parameters =
      BoundedParameters(Constrained(fit, prior, bounds.ForSingles()), prior, options);
  bounded.model.covariance = OfColumns(bounded.draws);
  bounded.model.noise = MeanNoise(fit.noise);
  bounded.model.propeller_separation_m = separation_m;
  return bounded;
}

// The model that the fit makes, with bounds; what the vehicle and the dataset say of it is unset.
Identification ModelOf(const PredictionErrorFit& fit, const FossenPrior& prior, double separation_m,
                       const IdentifyOptions& options) {
  BoundedFit bounded = Bounded(fit, prior, separation_m, options);
  const Heterogeneity heterogeneity = HeterogeneityOf(fit, prior);

  Identification model;
  model.structure = Structure::kFossen;
  model.parameterization = Parameterization::kPropeller;
  model.estimator = Estimator::kPredictionError;
  model.dead_zone = DeadZoneOf(fit.parameters);
  model.physical = std::move(bounded.model);
  WriteImpliedCoefficients(fit.parameters, bounded.draws, separation_m, options.interval_level,
                           model);
  model.refusals = WarningsOf(fit, *model.physical, heterogeneity);
  model.provenance.bounds_basis = BoundsBasis(fit, heterogeneity);
  model.provenance.clusters = fit.blocks.size();
  return model;
}

Result<PredictionErrorFit> Fit(const PreparedDataset& dataset, const Vehicle& vehicle,
                               const FossenPrior& prior, const PredictionErrorOptions& options,
                               const std::function<void(double)>& progress) {
  PredictionErrorFit fit =
      FitPredictionError(dataset, vehicle.propeller_separation_m, prior, options, progress);
  if (!fit.parameters.allFinite() || !fit.information.allFinite()) {
    return Refuse("model", "the fit of the physical model diverged",
                  "check the vehicle file and the recording with `telltale validate`");
  }
  return fit;
}

}  // namespace

Result<Identification> IdentifyPhysicalModel(const PreparedDataset& dataset, const Vehicle& vehicle,
                                             const IdentifyOptions& options,
                                             const Progress& progress) {
  if (vehicle.propeller_separation_m <= 0.0) {
    return Refuse("propeller_separation_m",
                  "the distance between the propellers is not known, which turns their difference "
                  "into a moment",
                  "measure it and give a vehicle file; `telltale init` writes one");
  }
  const double deviation = CommandDeviation(dataset);
  if (deviation < kLeastCommandDeviation) {
    return Refuse("commands",
                  "they vary by only " + std::to_string(deviation) +
                      " of full command (standard deviation), 0.05 are needed",
                  "record starts, stops and turns");
  }
  const FossenPrior prior = PriorOf(vehicle);
  const auto fit = Fit(dataset, vehicle, prior, {.threads = options.threads}, [&](double share) {
    if (progress) progress("fitting the physical model", 0.1 + 0.8 * share);
  });
  if (!fit) return tl::unexpected<Refusal>(fit.error());
  if (progress) progress("bounding", 0.9);
  Identification model = ModelOf(*fit, prior, vehicle.propeller_separation_m, options);
  model.vehicle_id = vehicle.vehicle_id;
  model.sampling_period_s = dataset.sampling_period_s;
  return model;
}

Result<PhysicalModel> PhysicalModelAbout(const PhysicalModel& model, const TimingPrior& timing,
                                         const PreparedDataset& dataset, const Vehicle& vehicle,
                                         const IdentifyOptions& options) {
  FossenPrior prior = PriorOf(vehicle);
  prior.mean = model.Estimates();
  prior.standard_deviation[At(kTimeConstant)] = timing.time_constant_sd_s;
  prior.standard_deviation[At(kCommandDelay)] = timing.delay_sd_s;
  prior.standard_deviation[At(kFixDelay)] = timing.delay_sd_s;
  PredictionErrorOptions search{.threads = options.threads};
  search.start = PredictionErrorStart{prior.mean, model.noise};
  search.free_instruments_only = true;
  const auto fit = Fit(dataset, vehicle, prior, search, {});
  if (!fit) return tl::unexpected<Refusal>(fit.error());
  if (!fit->converged) {
    return Refuse("recording", "what the commands explain of the motion does not settle the model",
                  "record longer, or in calmer weather");
  }
  return Bounded(*fit, prior, vehicle.propeller_separation_m, options).model;
}

}  // namespace telltale
