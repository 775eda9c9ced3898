#include "telltale/core/uncertainty/timeline.hpp"

#include <algorithm>
#include <numeric>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

/// Where on the timeline each row of the fit stands.
std::vector<std::size_t> PlacesOf(const Timeline& timeline, const ClusteredFit& fit) {
  const std::size_t first = timeline.instants.front();
  std::vector<std::size_t> place_of(timeline.instants.back() - first + 1);
  for (std::size_t t = 0; t < timeline.instants.size(); ++t) {
    place_of[timeline.instants[t] - first] = t;
  }
  std::vector<std::size_t> places;
  places.reserve(fit.instants.size());
  for (const std::size_t instant : fit.instants) places.push_back(place_of[instant - first]);
  return places;
}

}  // namespace

Timeline TimelineOf(const std::vector<ClusteredFit>& fits) {
  Timeline timeline;
  std::vector<std::size_t>& instants = timeline.instants;
  for (const ClusteredFit& fit : fits) {
    Require(fit.instants.size() == static_cast<std::size_t>(fit.W.rows()),
            "the instant of every row");
    instants.insert(instants.end(), fit.instants.begin(), fit.instants.end());
  }
  Require(!instants.empty(), "at least one row");
  std::sort(instants.begin(), instants.end());
  instants.erase(std::unique(instants.begin(), instants.end()), instants.end());
  std::size_t begin = 0;
  for (std::size_t t = 1; t <= instants.size(); ++t) {
    if (t < instants.size() && instants[t] == instants[t - 1] + 1) continue;
    timeline.runs.push_back({begin, t});
    begin = t;
  }
  return timeline;
}

RowsInTime RowsAlong(const Timeline& timeline, const ClusteredFit& fit) {
  const std::vector<std::size_t> places = PlacesOf(timeline, fit);
  RowsInTime in_time;
  in_time.first.assign(timeline.instants.size() + 1, 0);
  for (const std::size_t place : places) ++in_time.first[place + 1];
  std::partial_sum(in_time.first.begin(), in_time.first.end(), in_time.first.begin());

  in_time.rows.resize(fit.W.rows(), fit.W.cols() + 1);
  std::vector<std::size_t> next(in_time.first.begin(), in_time.first.end() - 1);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto from = static_cast<Eigen::Index>(i);
    const auto to = static_cast<Eigen::Index>(next[places[i]]++);
    in_time.rows.row(to) << fit.W.row(from), fit.residual[from];
  }
  return in_time;
}

Eigen::MatrixXd InfluenceAlong(const Timeline& timeline, const ClusteredFit& fit) {
  const Eigen::MatrixXd by_row = fit.residual.asDiagonal() * (fit.W * fit.basis.transpose());
  Eigen::MatrixXd influence =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(timeline.instants.size()), fit.basis.rows());
  const std::vector<std::size_t> places = PlacesOf(timeline, fit);
  for (std::size_t i = 0; i < places.size(); ++i) {
    influence.row(static_cast<Eigen::Index>(places[i])) += by_row.row(static_cast<Eigen::Index>(i));
  }
  return influence;
}

}  // namespace telltale
