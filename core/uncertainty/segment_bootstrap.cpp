#include "uncertainty/segment_bootstrap.hpp"

#include <vector>

#include <Eigen/Cholesky>
#include <boost/random/uniform_int_distribution.hpp>

#include "contract.hpp"
#include "parallel.hpp"
#include "random.hpp"

namespace telltale {
namespace {

/// Gram matrices and scores of one equation's segments, each Gram packed as a flat column so that a
/// replicate's sum is one pass over contiguous memory.
struct SegmentGrams {
  Eigen::MatrixXd packed;  // (r * r + r) x segments: W_s'W_s, then W_s'e_s
  Eigen::MatrixXd basis;   // p x r
  Eigen::VectorXd theta;   // p
  Eigen::Index r = 0;
};

SegmentGrams FormGrams(const ClusteredFit& fit) {
  SegmentGrams grams;
  grams.basis = fit.basis;
  grams.theta = fit.theta;
  grams.r = fit.W.cols();
  const Eigen::Index r = grams.r;
  grams.packed.resize(r * r + r, static_cast<Eigen::Index>(fit.clusters.size()));
  for (std::size_t s = 0; s < fit.clusters.size(); ++s) {
    const auto first = static_cast<Eigen::Index>(fit.clusters[s].begin);
    const auto count = static_cast<Eigen::Index>(fit.clusters[s].size());
    const auto rows = fit.W.middleRows(first, count);
    auto column = grams.packed.col(static_cast<Eigen::Index>(s));
    Eigen::Map<Eigen::MatrixXd>(column.data(), r, r).noalias() = rows.transpose() * rows;
    column.tail(r).noalias() = rows.transpose() * fit.residual.segment(first, count);
  }
  return grams;
}

/// How often each segment is drawn in one replicate.
Eigen::VectorXd DrawMultiplicities(std::size_t segments, RandomEngine engine) {
  Eigen::VectorXd multiplicity = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(segments));
  boost::random::uniform_int_distribution<std::size_t> pick(0, segments - 1);
  for (std::size_t draw = 0; draw < segments; ++draw) {
    multiplicity[static_cast<Eigen::Index>(pick(engine))] += 1.0;
  }
  return multiplicity;
}

/// theta* = theta + basis (sum m_s G_s)^-1 sum m_s g_s, or nothing when that system is singular.
bool SolveReplicate(const SegmentGrams& grams, const Eigen::VectorXd& multiplicity,
                    Eigen::Ref<Eigen::VectorXd> theta) {
  const Eigen::Index r = grams.r;
  const Eigen::VectorXd sum = grams.packed * multiplicity;
  const Eigen::Map<const Eigen::MatrixXd> gram(sum.data(), r, r);
  const Eigen::LLT<Eigen::MatrixXd> cholesky(gram);
  // W has orthonormal columns, so a healthy draw is near the identity and rcond is a fair judge.
  constexpr double kSingular = 1e-10;
  if (cholesky.info() != Eigen::Success || cholesky.rcond() < kSingular) return false;
  theta = grams.theta + grams.basis * cholesky.solve(sum.tail(r));
  return true;
}

}  // namespace

BootstrapReplicates BootstrapSegments(const std::vector<ClusteredFit>& fits,
                                      const BootstrapOptions& options) {
  Require(!fits.empty(), "at least one fit");
  const std::size_t segments = fits.front().clusters.size();
  Require(segments > 0, "at least one segment");
  std::vector<SegmentGrams> equations;
  Eigen::Index coefficients = 0;
  for (const ClusteredFit& fit : fits) {
    Require(fit.clusters.size() == segments, "the same segments in every fit");
    equations.push_back(FormGrams(fit));
    coefficients += fit.theta.size();
  }

  const auto draws = static_cast<Eigen::Index>(options.replicates);
  Eigen::MatrixXd theta(coefficients, draws);
  std::vector<char> solved(options.replicates, 0);
  const auto replicate = [&](std::size_t i) {
    const Eigen::VectorXd multiplicity =
        DrawMultiplicities(segments, RandomEngine::Stream(options.seed, i));
    Eigen::Index first = 0;
    bool all = true;
    for (const SegmentGrams& grams : equations) {
      const Eigen::Index p = grams.theta.size();
      all = all && SolveReplicate(grams, multiplicity,
                                  theta.col(static_cast<Eigen::Index>(i)).segment(first, p));
      first += p;
    }
    solved[i] = all ? 1 : 0;
  };
  ForEachIndex(options.replicates, options.threads, replicate);

  BootstrapReplicates replicates;
  Eigen::Index kept = 0;
  for (Eigen::Index i = 0; i < draws; ++i) {
    if (!solved[static_cast<std::size_t>(i)]) continue;
    if (kept != i) theta.col(kept) = theta.col(i);
    ++kept;
  }
  theta.conservativeResize(coefficients, kept);
  replicates.theta = std::move(theta);
  replicates.failures = options.replicates - static_cast<std::size_t>(kept);
  return replicates;
}

Eigen::MatrixXd Covariance(const BootstrapReplicates& replicates) {
  Require(replicates.theta.cols() > 1, "at least two replicates");
  const Eigen::MatrixXd centred = replicates.theta.colwise() - replicates.theta.rowwise().mean();
  return centred * centred.transpose() / static_cast<double>(centred.cols() - 1);
}

}  // namespace telltale
