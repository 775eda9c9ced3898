#include "telltale/service/tasks/identification_options.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(IdentificationOptions, AreTheRequestsWishesOverTheDaemonsDefaults) {
  IdentificationSettings settings;
  settings.bootstrap_replicates = 300;
  settings.interval_level = 0.9;
  IdentifyRequest request;
  request.seed = 5;
  IdentifyOptions options = OptionsOf(request, settings);
  EXPECT_EQ(options.bootstrap_replicates, 300u);
  EXPECT_EQ(options.interval_level, 0.9);
  EXPECT_EQ(options.prepare.preset, Preset::kRobust);
  EXPECT_EQ(options.regression.parameterization, Parameterization::kPropeller);
  EXPECT_EQ(options.seed, 5u);
  EXPECT_EQ(options.resampling, Resampling::kSlices);
  EXPECT_EQ(options.interval_method, IntervalMethod::kPercentile);
  request.bootstrap_replicates = 0;
  request.resampling = Resampling::kMovingBlocks;
  request.interval_method = IntervalMethod::kStudentized;
  request.preset = Preset::kPaper;
  request.parameterization = Parameterization::kPaper;
  options = OptionsOf(request, settings);
  EXPECT_EQ(options.bootstrap_replicates, 0u);
  EXPECT_EQ(options.resampling, Resampling::kMovingBlocks);
  EXPECT_EQ(options.interval_method, IntervalMethod::kStudentized);
  EXPECT_EQ(options.prepare.preset, Preset::kPaper);
  EXPECT_EQ(options.regression.parameterization, Parameterization::kPaper);
  EXPECT_EQ(options.dead_zone_source, DeadZoneSource::kGiven);
  request.structure = Structure::kFirstOrderDynamic;
  request.dead_zone_source = DeadZoneSource::kIdentified;
  EXPECT_FALSE(options.regression.include_reverse);
  request.include_reverse = true;
  options = OptionsOf(request, settings);
  EXPECT_TRUE(options.regression.include_reverse);
  EXPECT_EQ(options.regression.structure, Structure::kFirstOrderDynamic);
  EXPECT_EQ(options.dead_zone_source, DeadZoneSource::kIdentified);
}

TEST(IdentificationOptions, LeaveTheStructureToTheDataWhereNothingNamesOne) {
  IdentificationSettings settings;
  IdentifyRequest request;
  EXPECT_TRUE(LeavesStructureToData(request, settings));
  settings.structure = Structure::kStaticQuadratic;
  EXPECT_FALSE(LeavesStructureToData(request, settings));
  EXPECT_EQ(OptionsOf(request, settings).regression.structure, Structure::kStaticQuadratic);
  settings.structure = std::nullopt;
  request.estimator = Estimator::kOneStep;  // of free coefficients
  EXPECT_FALSE(LeavesStructureToData(request, settings));
  settings.structure = Structure::kFossen;
  EXPECT_EQ(OptionsOf(request, settings).regression.structure, Structure::kStaticQuadratic);
  request.estimator = Estimator::kUnknown;
  EXPECT_EQ(OptionsOf(request, settings).regression.structure, Structure::kFossen);
  request.structure = Structure::kFirstOrderDynamic;
  EXPECT_EQ(OptionsOf(request, settings).regression.structure, Structure::kFirstOrderDynamic);
}

}  // namespace
}  // namespace telltale
