#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/uncertainty/clustered_fit.hpp"
#include "telltale/core/uncertainty/packed_normal_equations.hpp"
#include "telltale/core/uncertainty/timeline.hpp"

namespace telltale {

/// How a replicate is drawn: `draws` times one of the tickets, each of which names a unit. A unit
/// is a part of the rows that is drawn as a whole; with any plan each row is drawn once on average.
struct DrawPlan {
  std::vector<std::uint32_t> tickets;
  std::size_t units = 0;
  std::size_t draws = 0;
};

/// Slices: as many draws as there are slices, each equally likely.
DrawPlan PlanSlices(std::size_t slices);

/// Circular blocks of `length` instants inside each run, one starting at every instant. A run no
/// longer than that is a block of its own, drawn as often as its instants need.
DrawPlan PlanBlocks(const Timeline& timeline, std::size_t length);

/// One unit as it is visited. `tile`: the units so marked overlap nowhere and cover all rows but
/// what is left over at the end of a run.
struct Unit {
  std::size_t index = 0;
  double tickets = 1.0;
  bool tile = true;
  const double* system = nullptr;  ///< packed normal equations of its rows
};

/// Slices of a fit: their systems are formed once.
class SliceUnits {
 public:
  explicit SliceUnits(const ClusteredFit& fit);

  template <class Visit>
  void ForEach(const Visit& visit) const {
    for (Eigen::Index s = 0; s < systems_.cols(); ++s) {
      visit(Unit{static_cast<std::size_t>(s), 1.0, true, systems_.col(s).data()});
    }
  }

 private:
  Eigen::MatrixXd systems_;
};

/// Blocks of a fit: a running sum of the rows' products, the difference of two prefix sums, slides
/// over each run. Nothing but that sum is kept, since a system for every start would outgrow the
/// caches: 13 MB at 16,000 x 13.
class BlockUnits {
 public:
  BlockUnits(const ClusteredFit& fit, const Timeline& timeline, std::size_t length)
      : in_time_(RowsAlong(timeline, fit)), runs_(timeline.runs), length_(length) {}

  template <class Visit>
  void ForEach(const Visit& visit) const {
    std::vector<double> sum(PackedLength(r()));
    std::size_t index = 0;
    for (const RowRange& run : runs_) {
      std::fill(sum.begin(), sum.end(), 0.0);
      const std::size_t block = std::min(length_, run.size());
      for (std::size_t t = run.begin; t < run.begin + block; ++t) Add(t, 1.0, sum);
      if (block == run.size()) {
        visit(Unit{index++, static_cast<double>(length_), true, sum.data()});
        continue;
      }
      for (std::size_t start = 0; start < run.size(); ++start) {
        const bool tile = start % length_ == 0 && start + length_ <= run.size();
        visit(Unit{index++, 1.0, tile, sum.data()});
        Add(run.begin + (start + length_) % run.size(), 1.0, sum);
        Add(run.begin + start, -1.0, sum);
      }
    }
  }

 private:
  std::size_t r() const { return static_cast<std::size_t>(in_time_.rows.cols()) - 1; }

  void Add(std::size_t place, double weight, std::vector<double>& sum) const {
    for (std::size_t i = in_time_.first[place]; i < in_time_.first[place + 1]; ++i) {
      AddRow(in_time_.rows.row(static_cast<Eigen::Index>(i)).data(), r(), weight, sum.data());
    }
  }

  RowsInTime in_time_;
  std::vector<RowRange> runs_;
  std::size_t length_;
};

}  // namespace telltale
