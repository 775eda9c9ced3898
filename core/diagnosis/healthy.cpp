#include "telltale/core/diagnosis/healthy.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "telltale/core/contract.hpp"
#include "telltale/core/diagnosis/judge.hpp"
#include "telltale/core/linear_algebra/covariance.hpp"
#include "telltale/core/linear_algebra/decompositions.hpp"

namespace telltale {
namespace {

// Of the typical size: what a healthy boat may always have of an effect, and its day of weather,
// believed as if one recording had shown it.
constexpr double kEverPresent = 0.1;
constexpr double kPriorRecordings = 1.0;
constexpr double kLasting = 0.5;      // typical sizes of what a boat may always have, to begin with
constexpr double kModelTrust = 10.0;  // by how many of its standard errors a model may be off
constexpr double kNever = 1e-6;
constexpr double kMostOptimism = 10.0;
constexpr int kRecalibrations = 8;  // at most
constexpr double kSettled = 0.995;  // of the squares: smaller gains are not worth another round
constexpr double kSlopeStep = 0.1;  // in typical sizes
constexpr int kRounds = 2;          // of scatter and unknowns in turn
constexpr int kIterations = 25;     // of unknowns and sizes in turn
constexpr std::array kShares = {1.0, 0.7, 0.5, 0.35, 0.25, 0.12, 0.06, 0.03};  // of a step

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
double Kappa(const Eigen::LLT<Eigen::MatrixXd>& factor,
             const std::vector<Eigen::MatrixXd>& recordings) {
  double product = 0.0;
  double square = 0.0;
  for (const Eigen::MatrixXd& errors : recordings) {
    const Eigen::MatrixXd white = factor.matrixL().solve(errors);
    for (Eigen::Index w = 0; w + 1 < white.cols(); ++w) {
      product += white.col(w).dot(white.col(w + 1));
      square += 0.5 * (white.col(w).squaredNorm() + white.col(w + 1).squaredNorm());
    }
  }
  const double rho = square > 0.0 ? product / square : 0.0;
  return std::clamp((1.0 - rho) / (1.0 + rho), 0.1, 1.0);
}

/// What is estimated from healthy recordings, as one stack of unknowns: coefficients, lasting
/// effects, then the weather of each day. All are changes of the boat about which the sensitivities
/// were taken, but for the weather, which is taken anew.
class HealthyFit {
 public:
  HealthyFit(const UncertainModel& model, const std::vector<Slot>& slots, std::size_t days)
      : base_(static_cast<Eigen::Index>(model.free.size())),
        slots_(static_cast<Eigen::Index>(slots.size())),
        passing_(PassingOf(slots)),
        days_(static_cast<Eigen::Index>(days)),
        coefficients_(Eigen::VectorXd::Zero(base_)),
        lasting_(Eigen::VectorXd::Zero(slots_)),
        lasting_sizes_(Eigen::VectorXd::Constant(slots_, kLasting)),
        day_sizes_(Eigen::VectorXd::Constant(Passing(), kEverPresent)) {
    Eigen::MatrixXd correlation = model.Correlation();
    correlation.diagonal().array() += 1e-6;
    base_information_ = Inverse(correlation) / (kModelTrust * kModelTrust);
    lasting_limits_.resize(slots_, 2);
    for (Eigen::Index j = 0; j < slots_; ++j) {
      const Slot& slot = slots[static_cast<std::size_t>(j)];
      const EffectParameter& parameter = slot.effect->Parameters()[slot.parameter];
      lasting_limits_.row(j) << parameter.lower / parameter.typical,
          parameter.upper / parameter.typical;
      if (slot.effect->Facts().habit == Habit::kOwn) continue;
      lasting_limits_.row(j).setZero();
      lasting_sizes_[j] = kNever;
    }
  }

  /// Sums up what whitened recordings say.
  void Take(const std::vector<Sensitivity>& recordings, const Eigen::LLT<Eigen::MatrixXd>& factor,
            double kappa) {
    gram_ = Eigen::MatrixXd::Zero(Size(), Size());
    right_ = Eigen::VectorXd::Zero(Size());
    const Eigen::Index shared = base_ + slots_;
    for (Eigen::Index day = 0; day < days_; ++day) {
      const Sensitivity& recording = recordings[static_cast<std::size_t>(day)];
      Eigen::MatrixXd phi(recording.errors.size(), shared + Passing() + 1);
      phi << recording.by_base, recording.by_slot, recording.by_slot(Eigen::all, passing_),
          recording.errors.reshaped();
      const Eigen::MatrixXd white = Whitened(factor, phi);
      const Eigen::MatrixXd gram = kappa * white.transpose() * white;
      const Eigen::Index own = shared + day * Passing();
      const auto last = gram.col(shared + Passing());
      gram_.topLeftCorner(shared, shared) += gram.topLeftCorner(shared, shared);
      gram_.block(0, own, shared, Passing()) = gram.block(0, shared, shared, Passing());
      gram_.block(own, 0, Passing(), shared) = gram.block(shared, 0, Passing(), shared);
      gram_.block(own, own, Passing(), Passing()) =
          gram.block(shared, shared, Passing(), Passing());
      right_.head(shared) -= last.head(shared);
      right_.segment(own, Passing()) = -last.segment(shared, Passing());
    }
  }

  /// In turn unknowns given sizes, sizes given unknowns.
  void Solve() {
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      unknowns_ = Step();
      Resize();
    }
  }

  /// Makes the change that was found; the next one is sought from there.
  void Accept(double share) {
    coefficients_ += share * unknowns_.head(base_);
    lasting_ = (lasting_ + share * unknowns_.segment(base_, slots_))
                   .cwiseMax(lasting_limits_.col(0))
                   .cwiseMin(lasting_limits_.col(1));
  }

  /// What the weather of a day does to a recording's errors, to be taken away by adding this.
  Eigen::MatrixXd Weather(const Sensitivity& recording, std::size_t day) const {
    const Eigen::VectorXd sizes =
        unknowns_.segment(base_ + slots_ + static_cast<Eigen::Index>(day) * Passing(), Passing());
    return (recording.by_slot(Eigen::all, passing_) * sizes)
        .reshaped(recording.errors.rows(), recording.errors.cols());
  }

  /// What would be left of a recording's errors if sensitivities told all.
  Eigen::MatrixXd Promised(const Sensitivity& recording, std::size_t day) const {
    const Eigen::VectorXd left = recording.errors.reshaped() +
                                 recording.by_base * unknowns_.head(base_) +
                                 recording.by_slot * unknowns_.segment(base_, slots_);
    return left.reshaped(recording.errors.rows(), recording.errors.cols()) +
           Weather(recording, day);
  }

  const Eigen::VectorXd& Coefficients() const { return coefficients_; }
  const Eigen::VectorXd& Lasting() const { return lasting_; }
  Eigen::VectorXd DaySizes() const {
    Eigen::VectorXd sizes = Eigen::VectorXd::Zero(slots_);
    sizes(passing_) = day_sizes_;
    return sizes;
  }
  Eigen::MatrixXd BoatCovariance() const {
    return Inverse(Information()).topLeftCorner(base_ + slots_, base_ + slots_);
  }

 private:
  static std::vector<Eigen::Index> PassingOf(const std::vector<Slot>& slots) {
    std::vector<Eigen::Index> passing;
    for (std::size_t j = 0; j < slots.size(); ++j) {
      if (slots[j].effect->Facts().habit == Habit::kPasses) {
        passing.push_back(static_cast<Eigen::Index>(j));
      }
    }
    return passing;
  }

  Eigen::Index Passing() const { return static_cast<Eigen::Index>(passing_.size()); }
  Eigen::Index Size() const { return base_ + slots_ + days_ * Passing(); }

  Eigen::MatrixXd Information() const {
    Eigen::MatrixXd information = gram_;
    information.topLeftCorner(base_, base_) += base_information_;
    information.diagonal().segment(base_, slots_) += lasting_sizes_.cwiseAbs2().cwiseInverse();
    information.diagonal().tail(days_ * Passing()) +=
        day_sizes_.cwiseAbs2().cwiseInverse().replicate(days_, 1);
    return information;
  }

  Eigen::VectorXd Step() const {
    Eigen::VectorXd right = right_;
    right.head(base_) -= base_information_ * coefficients_;
    right.segment(base_, slots_) -= lasting_.cwiseQuotient(lasting_sizes_.cwiseAbs2());
    return Information().llt().solve(right);
  }

  // By the most probable unknowns, not by expectation: what weather shares with the coefficients,
  // which are the same every day, would otherwise keep it large for ever.
  void Resize() {
    const double prior = kPriorRecordings * kEverPresent * kEverPresent;
    const auto weather = unknowns_.tail(days_ * Passing()).reshaped(Passing(), days_);
    day_sizes_ = ((weather.rowwise().squaredNorm().array() + prior) /
                  (static_cast<double>(days_) + kPriorRecordings))
                     .sqrt();
    for (Eigen::Index j = 0; j < slots_; ++j) {
      if (lasting_limits_(j, 0) == lasting_limits_(j, 1)) continue;
      const double now = lasting_[j] + unknowns_[base_ + j];
      lasting_sizes_[j] = std::sqrt((prior + now * now) / (1.0 + kPriorRecordings));
    }
  }

  Eigen::Index base_;
  Eigen::Index slots_;
  std::vector<Eigen::Index> passing_;  // slots of weather
  Eigen::Index days_;
  Eigen::VectorXd coefficients_;
  Eigen::VectorXd lasting_;
  Eigen::VectorXd lasting_sizes_;
  Eigen::VectorXd day_sizes_;
  Eigen::MatrixXd base_information_;
  Eigen::MatrixXd lasting_limits_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd right_;
  Eigen::VectorXd unknowns_;
};

/// By how much more a recording that took no part in estimating the covariance leaves by it: the
/// mean of Hotelling's T^2 over its rows, n / (n - rows - 1) with n windows.
double OptimismOf(const std::vector<Sensitivity>& days) {
  const auto rows = static_cast<double>(days.front().errors.rows());
  double windows = 0.0;
  for (const Sensitivity& day : days) windows += static_cast<double>(day.errors.cols());
  return windows / std::max(windows - rows - 1.0, windows / kMostOptimism);
}

std::vector<Sensitivity> SensitivitiesOf(const std::vector<FreeRuns>& recordings,
                                         const AugmentedModel& boat, const UncertainModel& model,
                                         const std::vector<Slot>& slots, std::size_t threads,
                                         double step) {
  std::vector<Sensitivity> sensitivities;
  for (const FreeRuns& runs : recordings) {
    sensitivities.push_back(SensitivityOf(runs, boat, model, slots, threads, step));
  }
  return sensitivities;
}

/// A boat on its way to how it sails on healthy days.
class Recalibrating {
 public:
  Recalibrating(const std::vector<FreeRuns>& recordings, const UncertainModel& model,
                const std::vector<Slot>& slots, std::size_t threads)
      : recordings_(recordings),
        model_(model),
        slots_(slots),
        threads_(threads),
        fit_(model, slots, recordings.size()),
        boat_{model.model, {}} {
    for (const FreeRuns& runs : recordings) errors_.push_back(runs.Errors(boat_));
    covariance_ = SecondMoment(errors_);
  }

  /// Whether the boat changed for the better by enough to go on.
  bool Improve() {
    sensitivities_ = SensitivitiesOf(recordings_, boat_, model_, slots_, threads_, kSlopeStep);
    // Weighed by the scatter that sensitivities promise to leave: by the present one, whatever the
    // boat still does wrong would count as noise and stay.
    for (int round = 0; round < kRounds; ++round) {
      Weigh();
      for (std::size_t day = 0; day < errors_.size(); ++day) {
        errors_[day] = fit_.Promised(sensitivities_[day], day);
      }
      covariance_ = SecondMoment(errors_);
    }
    factor_.compute(covariance_);
    errors_ = LessWeather(boat_);
    const double before = Square(errors_);
    return GoAsFarAsItHelps(before) < kSettled * before;
  }

  Healthy Learnt() {
    covariance_ = SecondMoment(errors_);
    Weigh();
    Healthy healthy{.boat = boat_,
                    .covariance = covariance_,
                    .kappa = kappa_,
                    .boat_covariance = fit_.BoatCovariance(),
                    .day_sizes = fit_.DaySizes(),
                    .days = SensitivitiesOf(recordings_, boat_, model_, slots_, threads_, 1.0),
                    .log_leftovers = {}};
    const double optimism = std::log(OptimismOf(healthy.days));
    for (const Sensitivity& day : healthy.days) {
      const Judge judge(healthy, day, EveryWindow(day), false);
      healthy.log_leftovers.push_back(std::log(judge.Leftover(judge.See(day.errors))) + optimism);
    }
    return healthy;
  }

 private:
  void Weigh() {
    factor_.compute(covariance_);
    kappa_ = Kappa(factor_, errors_);
    fit_.Take(sensitivities_, factor_, kappa_);
    fit_.Solve();
  }

  // Steps are longer than linear: a delay or a dead zone that is found moves much besides.
  double GoAsFarAsItHelps(double before) {
    const HealthyFit start = fit_;
    double least = before;
    for (const double share : kShares) {
      HealthyFit tried = start;
      tried.Accept(share);
      const Eigen::VectorXd change = tried.Coefficients().cwiseProduct(model_.StandardErrors());
      AugmentedModel boat{model_.Changed(model_.model, change), EffectsOf(slots_, tried.Lasting())};
      auto left = LessWeather(boat);
      const double square = Square(left);
      if (square >= least) continue;
      least = square;
      fit_ = std::move(tried);
      boat_ = std::move(boat);
      errors_ = std::move(left);
    }
    return least;
  }

  std::vector<Eigen::MatrixXd> LessWeather(const AugmentedModel& boat) const {
    std::vector<Eigen::MatrixXd> left;
    for (std::size_t day = 0; day < recordings_.size(); ++day) {
      left.emplace_back(recordings_[day].Errors(boat) + fit_.Weather(sensitivities_[day], day));
    }
    return left;
  }

  double Square(const std::vector<Eigen::MatrixXd>& errors) const {
    double sum = 0.0;
    for (const Eigen::MatrixXd& day : errors) sum += factor_.matrixL().solve(day).squaredNorm();
    return sum;
  }

  const std::vector<FreeRuns>& recordings_;
  const UncertainModel& model_;
  const std::vector<Slot>& slots_;
  std::size_t threads_;
  HealthyFit fit_;
  AugmentedModel boat_;
  std::vector<Sensitivity> sensitivities_;
  std::vector<Eigen::MatrixXd> errors_;  ///< about the boat, less what weather did
  Eigen::MatrixXd covariance_;
  Eigen::LLT<Eigen::MatrixXd> factor_;  ///< of it
  double kappa_ = 1.0;
};

}  // namespace

Healthy LearnHealthy(const std::vector<FreeRuns>& recordings, const UncertainModel& model,
                     const std::vector<Slot>& slots, std::size_t threads) {
  Require(!recordings.empty(), "at least one healthy recording");
  Recalibrating recalibrating(recordings, model, slots, threads);
  for (int round = 0; round < kRecalibrations && recalibrating.Improve(); ++round) continue;
  return recalibrating.Learnt();
}

}  // namespace telltale
