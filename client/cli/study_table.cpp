#include "telltale/client/cli/study_table.hpp"

#include <algorithm>
#include <complex>

#include "telltale/client/cli/table.hpp"
#include "telltale/core/paper/published_results.hpp"
#include "telltale/core/paper/yellowfish.hpp"

namespace telltale {
namespace {

constexpr std::array kVelocities = {"u", "v", "r"};

std::string StructureText(Structure structure) {
  return structure == Structure::kStaticQuadratic ? "static" : "dynamic";
}

std::string MethodText(PartitionMethod method) {
  return method == PartitionMethod::kBySlices ? "by segments" : "by points";
}

std::string Entry(const StudyEntry& entry) {
  return StructureText(entry.structure) + ", " + MethodText(entry.method);
}

const PublishedPartition& Published(const StudyEntry& entry) {
  const bool segments = entry.method == PartitionMethod::kBySlices;
  if (entry.structure == Structure::kStaticQuadratic) {
    return segments ? kPublishedStaticBySegments : kPublishedStaticByPoints;
  }
  return segments ? kPublishedDynamicBySegments : kPublishedDynamicByPoints;
}

std::string FreeRun(const std::optional<Spread>& spread) {
  return spread ? Significant(spread->mean, 3) : "–";
}

std::string PartitionTable(const Study& study) {
  Table table({{"70/30 partitions", Align::kLeft},
               {"MAE", Align::kRight},
               {"SD", Align::kRight},
               {"paper", Align::kRight},
               {"R2", Align::kRight},
               {"SD", Align::kRight},
               {"paper", Align::kRight},
               {"const.v. R2", Align::kRight},
               {"5 s RMSE", Align::kRight},
               {"const.v.", Align::kRight}});
  for (const StudyEntry& entry : study.partitions) {
    table.AddHeading(Entry(entry) + ", " + Counted(entry.repeats, "partition", "partitions"));
    const PublishedPartition& published = Published(entry);
    for (std::size_t j = 0; j < 3; ++j) {
      const PartitionScores& s = entry.scores[j];
      table.AddRow({kVelocities[j], Fixed(s.mae.mean, 6), Significant(s.mae.standard_deviation, 2),
                    Fixed(published.mae[j], 6), Fixed(s.r2.mean, 6),
                    Significant(s.r2.standard_deviation, 2), Fixed(published.r2[j], 6),
                    Fixed(s.constant_velocity_r2.mean, 4), FreeRun(s.free_run_rmse),
                    FreeRun(s.constant_velocity_free_run_rmse)});
    }
  }
  return table.Render();
}

std::string SharesTable(const Study& study) {
  Table table({{"training share", Align::kLeft},
               {"", Align::kLeft},
               {"MAE train", Align::kRight},
               {"paper", Align::kRight},
               {"valid", Align::kRight},
               {"paper", Align::kRight},
               {"R2 train", Align::kRight},
               {"paper", Align::kRight},
               {"valid", Align::kRight},
               {"paper", Align::kRight}});
  for (const StudyEntry& entry : study.shares) {
    const auto& published = entry.structure == Structure::kStaticQuadratic
                                ? kPublishedStaticShares
                                : kPublishedDynamicShares;
    const auto row = std::find_if(published.begin(), published.end(), [&](const auto& p) {
      return p.training_share == entry.training_share;
    });
    for (std::size_t j = 0; j < 3; ++j) {
      const PartitionScores& s = entry.scores[j];
      table.AddRow({j == 0 ? StructureText(entry.structure) + " " +
                                 Fixed(100.0 * entry.training_share, 0) + " %"
                           : "",
                    kVelocities[j], Fixed(s.training_mae.mean, 4), Fixed(row->training_mae[j], 4),
                    Fixed(s.mae.mean, 4), Fixed(row->mae[j], 4), Fixed(s.training_r2.mean, 4),
                    Fixed(row->training_r2[j], 4), Fixed(s.r2.mean, 4), Fixed(row->r2[j], 4)});
    }
  }
  return table.Render();
}

using CoefficientColumns = std::array<std::optional<Eigen::VectorXd>, 3>;

std::string Cell(const std::optional<Eigen::VectorXd>& column, Eigen::Index row) {
  if (!column) return row == 0 ? "refused" : "";
  return row < column->size() ? Fixed((*column)[row], 4) : "";
}

std::string CoefficientTable(const std::string& title, const CoefficientColumns& ours,
                             const std::array<Eigen::VectorXd, 3>& published) {
  Table table({{title, Align::kLeft},
               {"X_u", Align::kRight},
               {"paper", Align::kRight},
               {"X_v", Align::kRight},
               {"paper", Align::kRight},
               {"X_r", Align::kRight},
               {"paper", Align::kRight}});
  for (Eigen::Index row = 0; row < published[2].size(); ++row) {
    std::vector<std::string> cells = {std::to_string(row + 1)};
    for (std::size_t j = 0; j < 3; ++j) {
      cells.push_back(Cell(ours[j], row));
      cells.push_back(Cell(published[j], row));
    }
    table.AddRow(cells);
  }
  return table.Render();
}

std::array<Eigen::VectorXd, 3> PublishedStatic() {
  const auto vector = [](const auto& values) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  };
  return {vector(kYellowfishStaticTable.surge), vector(kYellowfishStaticTable.sway),
          vector(kYellowfishStaticTable.yaw)};
}

std::string RootText(const std::complex<double>& root) {
  if (root.imag() == 0.0) return Fixed(root.real(), 3);
  return Fixed(root.real(), 3) + (root.imag() < 0.0 ? " - " : " + ") +
         Fixed(std::abs(root.imag()), 3) + "i";
}

std::string AlphaText(const Study& study) {
  std::string text;
  if (study.redundant_alpha) {
    const RedundantAlpha& alpha = *study.redundant_alpha;
    std::string roots;
    for (std::size_t j = 0; j < 3; ++j) {
      roots += std::string(j == 0 ? "" : "; ") + kVelocities[j] + " " +
               RootText(alpha.roots[j][0]) + ", " + RootText(alpha.roots[j][1]);
    }
    text += Wrapped("Alpha from the redundant coefficients, three equations together: " +
                    Fixed(alpha.alpha, 4) + " (misfit " + Significant(alpha.residual, 2) +
                    "). Roots equation by equation: " + roots + ". " +
                    (alpha.agree ? "They agree."
                                 : "They do not agree: no one lag explains the "
                                   "three equations as they stand."));
  }
  if (study.time_constant) {
    const Coefficient& tau = *study.time_constant;
    text += Wrapped("Consistent estimate, one lag and one value per coefficient: time constant " +
                    Significant(tau.estimate, 3) + " s [" + Significant(tau.interval.lower, 3) +
                    ", " + Significant(tau.interval.upper, 3) + "].");
  }
  return text;
}

std::string PointPartitionWarning() {
  return Wrapped(
      "Partition by points hides how a model does on new data: neighbouring points are nearly "
      "copies of each other, so every validation point has its double among the training points.");
}

}  // namespace

std::string StudyTable(const Study& study) {
  return PartitionTable(study) + '\n' + PointPartitionWarning() + '\n' + SharesTable(study) + '\n' +
         CoefficientTable("static, times h", study.static_table, PublishedStatic()) + '\n' +
         CoefficientTable("dynamic, redundant", study.dynamic_table, YellowfishDynamicTable()) +
         '\n' + AlphaText(study);
}

}  // namespace telltale
