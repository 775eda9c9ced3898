#include "baselines/accelerations.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/effects/augmented_boat.hpp"
#include "telltale/core/effects/sensor_chain.hpp"

namespace blind::baselines {
namespace {

using telltale::AugmentedBoat;
using telltale::AugmentedModel;
using telltale::Nu;
using telltale::Pose;
using telltale::PreparedDataset;
using telltale::RowRange;

constexpr double kSpanS = 1.0;
constexpr double kParameterRidge = 0.25;  // a prior of twice the typical size

std::size_t RowsOfSpan(const PreparedDataset& dataset) {
  return static_cast<std::size_t>(std::lround(kSpanS / dataset.sampling_period_s));
}

/// Visits the first row of each span, with its segment.
template <class Visit>
void ForEachSpan(const PreparedDataset& dataset, Visit visit) {
  const std::size_t rows = RowsOfSpan(dataset);
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    const RowRange& segment = dataset.segments[s];
    for (std::size_t k = segment.begin; k + rows < segment.end; k += rows) visit(s, k);
  }
}

/// A model that simulates spans from what was measured, with fixes `late_s` old: what they say of
/// the boat's way is of that time, and driven by commands of that time.
class SimulatedRow {
 public:
  SimulatedRow(const PreparedDataset& dataset, const AugmentedModel& model, double late_s)
      : dataset_(dataset),
        late_s_(late_s),
        boat_(model, telltale::RecordingFrameOf(dataset), dataset.hull),
        steps_(telltale::StepsPerRow(model.model, dataset.sampling_period_s)),
        step_s_(dataset.sampling_period_s / static_cast<double>(steps_)) {
    for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
      const RowRange& segment = dataset.segments[s];
      drives_.push_back(boat_.DrivesAlong(dataset.commands[s],
                                          dataset.rows[segment.begin].time_s - late_s, step_s_,
                                          segment.size() * steps_));
    }
  }

  const AugmentedBoat& Boat() const { return boat_; }

  /// The boat at the end of a span, less the age of fixes.
  Pose After(std::size_t segment, std::size_t row) const {
    const RowRange& range = dataset_.segments[segment];
    const double from_s = dataset_.rows[row].time_s - late_s_;
    Pose pose = Start(range, from_s);
    for (std::size_t i = 0; i < RowsOfSpan(dataset_) * steps_; ++i) {
      pose = boat_.Advance(pose, drives_[segment][(row - range.begin) * steps_ + i],
                           from_s + static_cast<double>(i) * step_s_, step_s_);
    }
    return pose;
  }

 private:
  /// Way of the fix that came `late_s` after, turned into the heading of the time it is of.
  Pose Start(const RowRange& range, double time_s) const {
    const Pose fixed = telltale::TrueStart(dataset_, range, time_s + late_s_, boat_);
    if (late_s_ == 0.0) return fixed;
    Pose then = telltale::TrueStart(dataset_, range, time_s, boat_);
    const double turned = fixed.eta.psi_rad - then.eta.psi_rad;
    const Eigen::Vector2d way = telltale::Turned(turned, fixed.nu.u, fixed.nu.v);
    then.nu.u = way[0];
    then.nu.v = way[1];
    return then;
  }

  const PreparedDataset& dataset_;
  double late_s_;
  AugmentedBoat boat_;
  std::size_t steps_;
  double step_s_;
  std::vector<std::vector<telltale::Drive>> drives_;
};

/// Measured less foretold velocities at the ends of all spans. Nothing that was measured after the
/// beginning of a span is used, not even by late fixes, which TrueStart would look ahead for.
Eigen::Matrix3Xd ResidualsOf(const PreparedDataset& dataset, AugmentedModel model) {
  const double late_s = AugmentedBoat(model, telltale::RecordingFrameOf(dataset)).LatencyS();
  std::erase_if(model.effects, [](const telltale::ModelledEffect& modelled) {
    return modelled.effect->LatencyS(modelled.values) != 0.0;
  });
  const SimulatedRow prompt(dataset, model, 0.0);
  const SimulatedRow late(dataset, model, late_s);
  std::vector<Eigen::Vector3d> residuals;
  ForEachSpan(dataset, [&](std::size_t segment, std::size_t row) {
    const Nu& measured = dataset.rows[row + RowsOfSpan(dataset)].nu;
    const Nu foretold = telltale::MeasuredPose(prompt.After(segment, row), late.After(segment, row),
                                               dataset.sensors.antenna, prompt.Boat())
                            .nu;
    residuals.emplace_back(measured.u - foretold.u, measured.v - foretold.v,
                           measured.r - foretold.r);
  });
  Eigen::Matrix3Xd matrix(3, static_cast<Eigen::Index>(residuals.size()));
  for (Eigen::Index i = 0; i < matrix.cols(); ++i) {
    matrix.col(i) = residuals[static_cast<std::size_t>(i)];
  }
  return matrix;
}

Eigen::Vector3d NominalScale(const ReferenceBasis& basis) {
  Eigen::Vector3d square = Eigen::Vector3d::Zero();
  double spans = 0.0;
  for (const PreparedDataset& reference : basis.inputs.references) {
    const Eigen::Matrix3Xd residuals = ResidualsOf(reference, basis.nominal.boat);
    square += residuals.rowwise().squaredNorm();
    spans += static_cast<double>(residuals.cols());
  }
  return (square / spans).cwiseSqrt();
}

/// (1 - rho) / (1 + rho) of one span's misses with the next's.
double IndependentShare(const Eigen::Matrix3Xd& residuals) {
  const Eigen::Index pairs = residuals.cols() - 1;
  const double rho = residuals.leftCols(pairs).cwiseProduct(residuals.rightCols(pairs)).sum() /
                     residuals.leftCols(pairs).squaredNorm();
  return std::clamp((1.0 - rho) / (1.0 + rho), 0.1, 1.0);
}

/// Misses of a recording in nominal scales, and what effects would change of them.
class Signatures {
 public:
  Signatures(const ReferenceBasis& basis, const PreparedDataset& dataset,
             const Eigen::Vector3d& scale)
      : basis_(basis), dataset_(dataset), scale_(scale), residuals_(Scaled(basis.nominal.boat)) {}

  const Eigen::Matrix3Xd& Misses() const { return residuals_; }

  /// Of one typical size, by the secant over `sense` of them.
  Eigen::VectorXd Of(const telltale::EffectParameterRef& parameter_ref, double sense) const {
    const double typical = parameter_ref.effect->Parameters()[parameter_ref.parameter].typical;
    const auto with = basis_.With({telltale::At(parameter_ref, sense * typical)});
    return ((residuals_ - Scaled(with)) / sense).reshaped();
  }

  /// What a size of that sign leaves less of the squared misses.
  double Gain(const Eigen::VectorXd& signature, double sense) const {
    const double slope = sense * signature.dot(residuals_.reshaped());
    return std::pow(std::max(slope, 0.0), 2) / signature.squaredNorm();
  }

  /// 1 or -1, where the effect alone explains more: many differ by more than their sign.
  double SenseOf(const telltale::EffectParameterRef& parameter_ref) const {
    const telltale::EffectParameter& parameter =
        parameter_ref.effect->Parameters()[parameter_ref.parameter];
    if (-parameter.typical < parameter.lower) return 1.0;
    return Gain(Of(parameter_ref, -1.0), -1.0) > Gain(Of(parameter_ref, 1.0), 1.0) ? -1.0 : 1.0;
  }

 private:
  Eigen::Matrix3Xd Scaled(const AugmentedModel& model) const {
    return scale_.cwiseInverse().asDiagonal() * ResidualsOf(dataset_, model);
  }

  const ReferenceBasis& basis_;
  const PreparedDataset& dataset_;
  Eigen::Vector3d scale_;
  Eigen::Matrix3Xd residuals_;
};

/// Sizes that the reference recordings would regress to: what preparation and model always leave.
Eigen::VectorXd NominalVariation(const ReferenceBasis& basis, const Eigen::Vector3d& scale,
                                 const std::vector<double>& senses) {
  const auto parameter_refs = static_cast<Eigen::Index>(basis.parameter_refs.size());
  Eigen::MatrixXd information =
      kParameterRidge * Eigen::MatrixXd::Identity(parameter_refs, parameter_refs);
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(parameter_refs);
  for (const PreparedDataset& reference : basis.inputs.references) {
    const Signatures signatures(basis, reference, scale);
    Eigen::MatrixXd columns(signatures.Misses().size(), parameter_refs);
    for (std::size_t i = 0; i < senses.size(); ++i) {
      columns.col(static_cast<Eigen::Index>(i)) = signatures.Of(basis.parameter_refs[i], senses[i]);
    }
    information += columns.transpose() * columns;
    slope += columns.transpose() * signatures.Misses().reshaped();
  }
  return information.ldlt().solve(slope);
}

}  // namespace

Accelerations AccelerationsOf(const ReferenceBasis& basis) {
  const Eigen::Vector3d scale = NominalScale(basis);
  const Signatures signatures(basis, basis.inputs.recording, scale);
  Eigen::MatrixXd columns(signatures.Misses().size(),
                          static_cast<Eigen::Index>(basis.parameter_refs.size()));
  std::vector<double> senses;
  for (std::size_t i = 0; i < basis.parameter_refs.size(); ++i) {
    senses.push_back(signatures.SenseOf(basis.parameter_refs[i]));
    columns.col(static_cast<Eigen::Index>(i)) = signatures.Of(basis.parameter_refs[i], senses[i]);
  }
  const Eigen::VectorXd residuals =
      signatures.Misses().reshaped() - columns * NominalVariation(basis, scale, senses);
  return {.residuals = residuals,
          .signatures = columns,
          .independent = IndependentShare(residuals.reshaped(3, residuals.size() / 3)) *
                         static_cast<double>(residuals.size())};
}

}  // namespace blind::baselines
