#include "telltale/core/paper/study.hpp"

namespace telltale {
namespace {

constexpr std::array kStructures = {Structure::kStaticQuadratic, Structure::kFirstOrderDynamic};

RegressionOptions InThePapersTerms(Structure structure, const StudyOptions& study) {
  RegressionOptions options;
  options.include_reverse = study.include_reverse;
  options.structure = structure;
  options.parameterization = Parameterization::kPaper;
  return options;
}

Result<StudyEntry> Partition(const PreparedDataset& dataset, const StudyOptions& options,
                             Structure structure, PartitionMethod method, double training_share,
                             std::size_t repeats) {
  PartitionOptions partition;
  partition.regression = InThePapersTerms(structure, options);
  partition.method = method;
  partition.training_share = training_share;
  partition.repeats = repeats;
  partition.seed = options.seed;
  partition.threads = options.threads;
  const auto scores = StudyPartitions(dataset, partition);
  if (!scores) return tl::unexpected(scores.error());
  return StudyEntry{structure, method, training_share, repeats, *scores};
}

void FillStaticTable(const PreparedDataset& dataset, const StudyOptions& options, Study& study) {
  IdentifyOptions identify = IdentifyOptions::OneStep();
  identify.regression = InThePapersTerms(Structure::kStaticQuadratic, options);
  identify.bootstrap_replicates = 0;
  const auto identification = Identify(dataset, "study", identify);
  if (!identification) {
    study.refusals.push_back(identification.error());
    return;
  }
  study.refusals.insert(study.refusals.end(), identification->refusals.begin(),
                        identification->refusals.end());
  for (const Equation equation : kEquations) {
    if (!identification->Has(equation)) continue;
    const auto regressors = Regressors(equation, Parameterization::kPaper);
    Eigen::VectorXd X(static_cast<Eigen::Index>(regressors.size()));
    Eigen::Index next = 0;
    for (const Coefficient& coefficient : identification->coefficients) {
      if (coefficient.equation != equation) continue;
      X[next++] = coefficient.estimate * dataset.sampling_period_s;
    }
    study.static_table[IndexOf(equation)] = X;
  }
}

void FillDynamicTable(const PreparedDataset& dataset, const StudyOptions& options, Study& study) {
  const RegressionOptions regression = InThePapersTerms(Structure::kFirstOrderDynamic, options);
  for (const Equation equation : kEquations) {
    const auto X = EstimateRedundant(BuildRedundant(dataset, equation, regression));
    if (X) {
      study.dynamic_table[IndexOf(equation)] = *X;
    } else {
      study.refusals.push_back(X.error());
    }
  }
  const auto& [surge, sway, yaw] = study.dynamic_table;
  if (surge && sway && yaw) study.redundant_alpha = RecoverAlpha({*surge, *sway, *yaw});
}

void FillTimeConstant(const PreparedDataset& dataset, const StudyOptions& options, Study& study) {
  IdentifyOptions identify = IdentifyOptions::OneStep();
  identify.regression.structure = Structure::kFirstOrderDynamic;
  identify.regression.include_reverse = options.include_reverse;
  identify.seed = options.seed;
  identify.threads = options.threads;
  const auto identification = Identify(dataset, "study", identify);
  if (identification) {
    study.time_constant = identification->thruster_time_constant;
  } else {
    study.refusals.push_back(identification.error());
  }
}

}  // namespace

Result<Study> StudyRecording(const PreparedDataset& dataset, const StudyOptions& options,
                             const Progress& progress) {
  const auto report = [&](std::string_view stage, double fraction) {
    if (progress) progress(stage, fraction);
  };
  Study study;
  double fraction = 0.0;
  for (const Structure structure : kStructures) {
    for (const auto method : {PartitionMethod::kBySlices, PartitionMethod::kByPoints}) {
      report("random partitions", fraction);
      const auto entry = Partition(dataset, options, structure, method, 0.7, options.repeats);
      if (!entry) return tl::unexpected(entry.error());
      study.partitions.push_back(*entry);
      fraction += 0.2;
    }
    for (const double share : {0.7, 0.6, 0.5}) {
      const auto entry =
          Partition(dataset, options, structure, PartitionMethod::kBySlices, share, 1);
      if (!entry) return tl::unexpected(entry.error());
      study.shares.push_back(*entry);
    }
  }
  report("coefficient tables", 0.9);
  FillStaticTable(dataset, options, study);
  FillDynamicTable(dataset, options, study);
  FillTimeConstant(dataset, options, study);
  report("done", 1.0);
  return study;
}

}  // namespace telltale
