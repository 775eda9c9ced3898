#include "telltale/core/identification/uncertain_model.hpp"

#include <gtest/gtest.h>

#include "support/physical_boat.hpp"

namespace telltale {
namespace {

class UncertainPhysicalModel : public ::testing::Test {
 protected:
  std::size_t PlaceOf(FossenParameter parameter) const {
    for (std::size_t i = 0; i < model_.free.size(); ++i) {
      if (model_.free[i].column == At(parameter)) return i;
    }
    return model_.free.size();
  }

  const UncertainModel model_ =
      UncertainModelOf(testing::KnownPhysicalBoat(testing::PhysicalBoat(), 0.1)).value();
};

TEST_F(UncertainPhysicalModel, LeavesOutWhatEffectsStandFor) {
  EXPECT_LT(PlaceOf(FossenParameter::kReverseLoss), model_.free.size());
  for (const FossenParameter parameter :
       {FossenParameter::kImbalance, FossenParameter::kForwardDeadBand,
        FossenParameter::kTimeConstant, FossenParameter::kCommandDelay}) {
    EXPECT_EQ(PlaceOf(parameter), model_.free.size());
  }
}

TEST_F(UncertainPhysicalModel, IsTheBoatOfTheChangedParameters) {
  FossenVector changed = testing::PhysicalBoat();
  changed[At(FossenParameter::kNr)] += 0.05;
  const auto place = PlaceOf(FossenParameter::kNr);
  const auto size = static_cast<Eigen::Index>(model_.free.size());
  const VesselModel boat =
      model_.Changed(0.05 * Eigen::VectorXd::Unit(size, static_cast<Eigen::Index>(place)));
  const VesselModel expected = VesselModelOf(changed, testing::kPhysicalBoatSeparation);
  for (std::size_t equation = 0; equation < 3; ++equation) {
    EXPECT_TRUE(boat.theta[equation].isApprox(expected.theta[equation], 1e-12)) << equation;
  }
  EXPECT_EQ(model_.NameOf(place), "Nr");
}

TEST_F(UncertainPhysicalModel, StaysABoatHoweverItIsChanged) {
  const auto size = static_cast<Eigen::Index>(model_.free.size());
  const FossenVector found = model_.ChangedParameters(Eigen::VectorXd::Constant(size, -1000.0));
  EXPECT_EQ(found, model_.physical->range.Within(found));
  EXPECT_EQ(found[At(FossenParameter::kXu)], 0.0);
}

}  // namespace
}  // namespace telltale
