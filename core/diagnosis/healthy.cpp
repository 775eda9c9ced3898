#include "diagnosis/healthy.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "contract.hpp"
#include "diagnosis/judge.hpp"

namespace telltale {
namespace {

// Of the typical size: what a healthy boat may always have of an effect, believed as if one
// recording had shown it.
constexpr double kEverPresent = 0.1;
constexpr double kPriorRecordings = 1.0;
constexpr double kModelTrust = 10.0;  // by how many of its standard errors a model may be off
constexpr double kNever = 1e-6;
constexpr double kOffCentre = 0.02;  // typical sizes by which the mean of days may be off
constexpr int kHalvings = 4;
constexpr double kLasting = 0.5;    // typical sizes of what a boat may always have, to begin with
constexpr int kRecalibrations = 4;  // sensitivities taken, the boat changed between
constexpr int kRounds = 2;          // of covariance and sizes in turn
constexpr int kIterations = 25;     // of sizes

/// L^-1 applied to every window of every column, L L' the covariance of a window.
Eigen::MatrixXd Whitened(const Eigen::LLT<Eigen::MatrixXd>& factor,
                         const Eigen::MatrixXd& stacked) {
  const Eigen::Index rows = factor.rows();
  Eigen::MatrixXd white = stacked;
  for (Eigen::Index j = 0; j < white.cols(); ++j) {
    auto windows = white.col(j).reshaped(rows, stacked.rows() / rows);
    factor.matrixL().solveInPlace(windows);
  }
  return white;
}

Eigen::MatrixXd SecondMoment(const std::vector<Eigen::MatrixXd>& residuals) {
  const Eigen::Index rows = residuals.front().rows();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(rows, rows);
  double windows = 0.0;
  for (const Eigen::MatrixXd& residual : residuals) {
    sum += residual * residual.transpose();
    windows += static_cast<double>(residual.cols());
  }
  sum /= windows;
  const double shrink = std::clamp(0.15 * static_cast<double>(rows) / windows, 0.01, 0.3);
  const Eigen::VectorXd diagonal = sum.diagonal();
  sum *= 1.0 - shrink;
  sum.diagonal() += shrink * diagonal;
  return sum;
}

/// (1 - rho) / (1 + rho) of whitened errors from one window to the next.
double Kappa(const std::vector<Eigen::MatrixXd>& whitened) {
  double product = 0.0;
  double square = 0.0;
  for (const Eigen::MatrixXd& white : whitened) {
    for (Eigen::Index w = 0; w + 1 < white.cols(); ++w) {
      product += white.col(w).dot(white.col(w + 1));
      square += 0.5 * (white.col(w).squaredNorm() + white.col(w + 1).squaredNorm());
    }
  }
  const double rho = square > 0.0 ? product / square : 0.0;
  return std::clamp((1.0 - rho) / (1.0 + rho), 0.1, 1.0);
}

/// What is estimated from healthy recordings, as one stack of unknowns: coefficients, lasting
/// effects, then the effects of each day. All are changes of the boat about which the sensitivities
/// were taken, but for the effects of a day, which are taken anew.
class HealthyFit {
 public:
  HealthyFit(const UncertainModel& model, const std::vector<Slot>& slots, std::size_t days)
      : base_(static_cast<Eigen::Index>(model.free.size())),
        slots_(static_cast<Eigen::Index>(slots.size())),
        days_(static_cast<Eigen::Index>(days)),
        coefficients_(Eigen::VectorXd::Zero(base_)),
        lasting_(Eigen::VectorXd::Zero(slots_)),
        lasting_sizes_(Eigen::VectorXd::Constant(slots_, kLasting)),
        day_sizes_(Eigen::VectorXd::Constant(slots_, kEverPresent)) {
    base_information_ = (model.Correlation() + 1e-6 * Eigen::MatrixXd::Identity(base_, base_))
                            .llt()
                            .solve(Eigen::MatrixXd::Identity(base_, base_)) /
                        (kModelTrust * kModelTrust);
    lasting_limits_.resize(slots_, 2);
    for (Eigen::Index j = 0; j < slots_; ++j) {
      const Slot& slot = slots[static_cast<std::size_t>(j)];
      const EffectParameter& parameter = slot.effect->Parameters()[slot.parameter];
      lasting_limits_.row(j) << parameter.lower / parameter.typical,
          parameter.upper / parameter.typical;
      passes_.push_back(slot.effect->Facts().habit == Habit::kPasses);
      if (slot.effect->Facts().habit == Habit::kOwn) continue;
      lasting_limits_.row(j).setZero();
      lasting_sizes_[j] = kNever;
    }
  }

  /// Sums up what whitened recordings say.
  void Take(const std::vector<Sensitivity>& recordings, const Eigen::LLT<Eigen::MatrixXd>& factor,
            double kappa) {
    const Eigen::Index size = Size();
    gram_ = Eigen::MatrixXd::Zero(size, size);
    right_ = Eigen::VectorXd::Zero(size);
    const Eigen::Index shared = base_ + slots_;
    for (Eigen::Index day = 0; day < days_; ++day) {
      const Sensitivity& recording = recordings[static_cast<std::size_t>(day)];
      Eigen::MatrixXd phi(recording.errors.size(), shared + 1);
      phi << recording.by_base, recording.by_slot, recording.errors.reshaped();
      const Eigen::MatrixXd white = Whitened(factor, phi);
      const Eigen::MatrixXd gram = kappa * white.transpose() * white;
      const Eigen::Index first = shared + day * slots_;
      gram_.topLeftCorner(shared, shared) += gram.topLeftCorner(shared, shared);
      gram_.block(0, first, shared, slots_) = gram.block(0, base_, shared, slots_);
      gram_.block(first, 0, slots_, shared) = gram.block(base_, 0, slots_, shared);
      gram_.block(first, first, slots_, slots_) = gram.block(base_, base_, slots_, slots_);
      right_.head(shared) -= gram.col(shared).head(shared);
      right_.segment(first, slots_) = -gram.col(shared).segment(base_, slots_);
    }
  }

  /// In turn unknowns given sizes, sizes given unknowns.
  void Solve() {
    const Eigen::Index shared = base_ + slots_;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      Eigen::MatrixXd information = gram_;
      Eigen::VectorXd right = right_;
      information.topLeftCorner(base_, base_) += base_information_;
      right.head(base_) -= base_information_ * coefficients_;
      const Eigen::VectorXd lasting = lasting_sizes_.cwiseAbs2().cwiseInverse();
      information.diagonal().segment(base_, slots_) += lasting;
      right.segment(base_, slots_) -= lasting.cwiseProduct(lasting_);
      for (Eigen::Index day = 0; day < days_; ++day) {
        information.diagonal().segment(shared + day * slots_, slots_) +=
            day_sizes_.cwiseAbs2().cwiseInverse();
      }
      CentreDays(shared, information);
      const Eigen::LLT<Eigen::MatrixXd> solver(information);
      unknowns_ = solver.solve(right);
      covariance_ = solver.solve(Eigen::MatrixXd::Identity(Size(), Size()));
      Resize(shared);
    }
  }

  /// Makes the change that was found; the next one is sought from there.
  void Accept(double share) {
    coefficients_ += share * unknowns_.head(base_);
    lasting_ = (lasting_ + share * unknowns_.segment(base_, slots_))
                   .cwiseMax(lasting_limits_.col(0))
                   .cwiseMin(lasting_limits_.col(1));
  }

  /// What a recording of one day still misses by.
  Eigen::MatrixXd Residual(const Sensitivity& recording, std::size_t day) const {
    const Eigen::Index shared = base_ + slots_;
    const Eigen::VectorXd slots =
        unknowns_.segment(base_, slots_) +
        unknowns_.segment(shared + static_cast<Eigen::Index>(day) * slots_, slots_);
    const Eigen::VectorXd left = recording.errors.reshaped() +
                                 recording.by_base * unknowns_.head(base_) +
                                 recording.by_slot * slots;
    return left.reshaped(recording.errors.rows(), recording.errors.cols());
  }

  const Eigen::VectorXd& Coefficients() const { return coefficients_; }
  const Eigen::VectorXd& Lasting() const { return lasting_; }
  const Eigen::VectorXd& DaySizes() const { return day_sizes_; }
  Eigen::MatrixXd BoatCovariance() const {
    return covariance_.topLeftCorner(base_ + slots_, base_ + slots_);
  }

 private:
  Eigen::Index Size() const { return base_ + slots_ + days_ * slots_; }

  // What is the same every day is the boat's, and only weather may have a mean of its own.
  void CentreDays(Eigen::Index shared, Eigen::MatrixXd& information) const {
    const double weight = 1.0 / (static_cast<double>(days_) * kOffCentre * kOffCentre);
    for (Eigen::Index j = 0; j < slots_; ++j) {
      if (passes_[static_cast<std::size_t>(j)]) continue;
      for (Eigen::Index a = 0; a < days_; ++a) {
        for (Eigen::Index b = 0; b < days_; ++b) {
          information(shared + a * slots_ + j, shared + b * slots_ + j) += weight;
        }
      }
    }
  }

  // By the most probable unknowns, not by expectation: what a day's effect shares with the
  // coefficients, which are the same every day, would otherwise keep it large for ever.
  void Resize(Eigen::Index shared) {
    const double prior = kPriorRecordings * kEverPresent * kEverPresent;
    Eigen::VectorXd sum = Eigen::VectorXd::Constant(slots_, prior);
    for (Eigen::Index day = 0; day < days_; ++day) {
      const Eigen::Index first = shared + day * slots_;
      sum += unknowns_.segment(first, slots_).cwiseAbs2();
    }
    day_sizes_ = (sum / (static_cast<double>(days_) + kPriorRecordings)).cwiseSqrt();
    for (Eigen::Index j = 0; j < slots_; ++j) {
      if (lasting_limits_(j, 0) == lasting_limits_(j, 1)) continue;
      const double now = lasting_[j] + unknowns_[base_ + j];
      lasting_sizes_[j] = std::sqrt((prior + now * now) / (1.0 + kPriorRecordings));
    }
  }

  Eigen::Index base_;
  Eigen::Index slots_;
  Eigen::Index days_;
  Eigen::VectorXd coefficients_;
  Eigen::VectorXd lasting_;
  Eigen::VectorXd lasting_sizes_;
  Eigen::VectorXd day_sizes_;
  std::vector<bool> passes_;  // by slot
  Eigen::MatrixXd base_information_;
  Eigen::MatrixXd lasting_limits_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd right_;
  Eigen::VectorXd unknowns_;
  Eigen::MatrixXd covariance_;
};

Eigen::VectorXd ScaleOf(const std::vector<Sensitivity>& days) {
  Eigen::VectorXd square = Eigen::VectorXd::Zero(days.front().errors.rows());
  double windows = 0.0;
  for (const Sensitivity& day : days) {
    square += day.errors.rowwise().squaredNorm();
    windows += static_cast<double>(day.errors.cols());
  }
  return (square / windows).cwiseSqrt().cwiseMax(1e-9);
}

double SquareOf(const std::vector<FreeRuns>& recordings, const AugmentedModel& boat,
                const Eigen::LLT<Eigen::MatrixXd>& factor) {
  double sum = 0.0;
  for (const FreeRuns& runs : recordings) {
    sum += factor.matrixL().solve(runs.Errors(boat)).squaredNorm();
  }
  return sum;
}

}  // namespace

Healthy LearnHealthy(const std::vector<FreeRuns>& recordings, const UncertainModel& model,
                     const std::vector<Slot>& slots, std::size_t threads) {
  Require(!recordings.empty(), "at least one healthy recording");
  Healthy healthy;
  HealthyFit fit(model, slots, recordings.size());
  healthy.boat = {model.model, {}};
  std::vector<Eigen::MatrixXd> residuals;
  std::vector<Sensitivity> sensitivities;
  for (int recalibration = 0; recalibration < kRecalibrations; ++recalibration) {
    sensitivities.clear();
    for (const FreeRuns& runs : recordings) {
      sensitivities.push_back(SensitivityOf(runs, healthy.boat, model, slots, threads));
    }
    if (residuals.empty()) {
      for (const Sensitivity& day : sensitivities) residuals.push_back(day.errors);
    }
    for (int round = 0; round < kRounds; ++round) {
      healthy.covariance = SecondMoment(residuals);
      const Eigen::LLT<Eigen::MatrixXd> factor(healthy.covariance);
      std::vector<Eigen::MatrixXd> whitened;
      for (const Eigen::MatrixXd& residual : residuals) {
        whitened.emplace_back(factor.matrixL().solve(residual));
      }
      healthy.kappa = Kappa(whitened);
      fit.Take(sensitivities, factor, healthy.kappa);
      fit.Solve();
      for (std::size_t day = 0; day < residuals.size(); ++day) {
        residuals[day] = fit.Residual(sensitivities[day], day);
      }
    }
    if (recalibration + 1 == kRecalibrations) break;
    const Eigen::LLT<Eigen::MatrixXd> factor(healthy.covariance);
    const double now = SquareOf(recordings, healthy.boat, factor);
    double share = 1.0;
    for (int halving = 0; halving <= kHalvings; ++halving, share /= 2.0) {
      HealthyFit tried = fit;
      tried.Accept(share);
      AugmentedModel boat{model.Changed(tried.Coefficients().cwiseProduct(model.StandardErrors())),
                          EffectsOf(slots, tried.Lasting())};
      if (SquareOf(recordings, boat, factor) > now) continue;
      fit = std::move(tried);
      healthy.boat = std::move(boat);
      break;
    }
  }
  healthy.boat_covariance = fit.BoatCovariance();
  healthy.slot_sizes = fit.DaySizes();
  healthy.scale = ScaleOf(sensitivities);
  for (const Sensitivity& day : sensitivities) {
    const Judge judge(healthy, day, EveryWindow(day), false);
    const Eigen::VectorXd seen = judge.See(day.errors);
    healthy.log_leftovers.push_back(std::log(judge.Leftover(seen)));
    healthy.shaken.push_back(judge.MomentOfUnexplained(seen));
  }
  healthy.days = std::move(sensitivities);
  return healthy;
}

}  // namespace telltale
