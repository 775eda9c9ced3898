#include "telltale/core/estimation/output_error/shooting_residual.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "telltale/core/estimation/output_error/variational_dynamics.hpp"
#include "telltale/core/simulation/divergence.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {
namespace {

constexpr Eigen::Index kPsi = 2;

using SensitivityRow = Eigen::Matrix<double, 1, kSensitivityColumns>;

/// Collects the residuals of a shooting segment, in the order of its nodes.
class ShootingResidualWriter {
 public:
  ShootingResidualWriter(const ShootingPlan& plan, const ShootingSegment& shooting_segment,
                         const SharedUnknowns& unknowns, const NoiseScale& noise_scale,
                         bool with_derivatives)
      : plan_(plan),
        noise_scale_(noise_scale),
        shared_(unknowns.Size()),
        varied_(with_derivatives) {
    shooting_residual_.residual.resize(shooting_segment.Residuals());
    if (!varied_) return;
    shooting_residual_.by_start = RowMajorMatrix::Zero(shooting_segment.Residuals(), 6);
    shooting_residual_.by_shared.resize(shooting_segment.Residuals(), shared_);
  }

  void Add(const NorthEastPosition& fix, const SensitiveState& now) {
    const double c = std::cos(now.state[kPsi]);
    const double s = std::sin(now.state[kPsi]);
    const double ahead = c * plan_.antenna.forward_m - s * plan_.antenna.starboard_m;
    const double abeam = s * plan_.antenna.forward_m + c * plan_.antenna.starboard_m;
    const double noise = noise_scale_.position * plan_.position_noise_m;
    shooting_residual_.residual[row_] = (now.state[0] + ahead - fix.north_m) / noise;
    shooting_residual_.residual[row_ + 1] = (now.state[1] + abeam - fix.east_m) / noise;
    if (varied_) {
      const Sensitivity& S = now.sensitivity;
      // A rotation of the initial heading rotates the whole simulated track about its start.
      const double x = now.state[0] - start_[0] + ahead;
      const double y = now.state[1] - start_[1] + abeam;
      shooting_residual_.by_start.block<2, 3>(row_, 0) << 1.0, 0.0, -y, 0.0, 1.0, x;
      shooting_residual_.by_start.block<2, 3>(row_, 0) /= noise;
      Write((S.row(0) - abeam * S.row(kPsi)) / noise, row_);
      Write((S.row(1) + ahead * S.row(kPsi)) / noise, row_ + 1);
    }
    Soften(2);
    row_ += 2;
  }

  void Add(const MeanHeading& heading, const SensitiveState& before, const SensitiveState& after) {
    const auto mean = [&](const auto& psi_a, const auto& r_a, const auto& psi_b, const auto& r_b) {
      return heading.psi_before * psi_a + heading.r_before * r_a + heading.psi_after * psi_b +
             heading.r_after * r_b;
    };
    const double noise = noise_scale_.heading * heading.noise_rad;
    const double psi = mean(before.state[kPsi], before.state[5], after.state[kPsi], after.state[5]);
    shooting_residual_.residual[row_] = (psi - heading.psi_rad) / noise;
    if (varied_) {
      const Sensitivity& A = before.sensitivity;
      const Sensitivity& B = after.sensitivity;
      shooting_residual_.by_start(row_, kPsi) = 1.0 / noise;
      Write(mean(A.row(kPsi), A.row(5), B.row(kPsi), B.row(5)) / noise, row_);
    }
    Soften(1);
    ++row_;
  }

  void StartAt(const ShootingState& start) { start_ = start; }
  ShootingResidual Take() && { return std::move(shooting_residual_); }

 private:
  void Write(const SensitivityRow& by, Eigen::Index row) {
    shooting_residual_.by_start.row(row).tail<3>() = by.head<kFirstShared>();
    shooting_residual_.by_shared.row(row) = by.segment(kFirstShared, shared_);
  }

  /// Huber: with threshold k, the squared residual is s^2 up to k and 2 k s - k^2 beyond.
  void Soften(Eigen::Index rows) {
    const double huber_threshold = noise_scale_.huber_threshold;
    auto residual = shooting_residual_.residual.segment(row_, rows);
    const double size = residual.norm();
    if (size <= huber_threshold) return;
    const Eigen::VectorXd along = residual / size;
    const double softened = std::sqrt(huber_threshold * (2.0 * size - huber_threshold));
    residual = softened * along;
    if (!varied_) return;
    const auto soften = [&](auto block) {
      const Eigen::RowVectorXd radial = along.transpose() * block;
      block *= softened / size;
      block += (huber_threshold / softened - softened / size) * along * radial;
    };
    soften(shooting_residual_.by_start.middleRows(row_, rows));
    soften(shooting_residual_.by_shared.middleRows(row_, rows));
  }

  const ShootingPlan& plan_;
  const NoiseScale& noise_scale_;
  Eigen::Index shared_;
  bool varied_;
  ShootingState start_ = ShootingState::Zero();
  Eigen::Index row_ = 0;
  ShootingResidual shooting_residual_;
};

bool HasDiverged(const ShootingState& state) {
  return !Within({state[3], state[4], state[5]}, kShootingLimits);
}

}  // namespace

std::optional<ShootingResidual> ComputeShootingResidual(
    const ShootingPlan& plan, const ShootingSegment& shooting_segment,
    const SharedUnknowns& unknowns, const Eigen::VectorXd& theta, const ShootingState& start,
    const NoiseScale& noise_scale, bool with_derivatives) {
  const VariationalDynamics dynamics(unknowns, theta, with_derivatives);
  std::optional<double> time_constant_s;
  if (unknowns.lagging) time_constant_s = std::max(theta[0], kShortestSimulatedTimeConstantS);
  SegmentThrusters thrusters(shooting_segment, time_constant_s);
  ShootingResidualWriter writer(plan, shooting_segment, unknowns, noise_scale, with_derivatives);
  writer.StartAt(start);
  SensitiveState now;
  now.state = start;
  now.sensitivity.setZero();
  now.sensitivity.block<3, 3>(3, 0).setIdentity();
  for (const ShootingNode& node : shooting_segment.nodes) {
    if (node.fix) writer.Add(*node.fix, now);
    if (node.leg_s <= 0.0) break;
    const SensitiveState next =
        dynamics.Step(now, thrusters.Advance(node.steady, node.leg_s), node.leg_s);
    if (HasDiverged(next.state)) return std::nullopt;
    if (node.heading) writer.Add(*node.heading, now, next);
    now = next;
  }
  return std::move(writer).Take();
}

}  // namespace telltale
