#include "telltale/core/identification/physical_range.hpp"

#include <gtest/gtest.h>

#include "support/physical_boat.hpp"

namespace telltale {
namespace {

using testing::PhysicalBoat;

PhysicalRange RangeOfTheBoat() {
  return RangeOf(*testing::KnownPhysicalBoat(PhysicalBoat(), 0.1).physical);
}

TEST(PhysicalRange, LeavesABoatAsItIs) {
  EXPECT_EQ(RangeOfTheBoat().Within(PhysicalBoat()), PhysicalBoat());
}

// A hull of three metres whose propellers are 0.7 m apart, of which the model does not hold the
// length.
TEST(PhysicalRange, HoldsTheIntervalsOfALongHull) {
  FossenVector boat = PhysicalBoat();
  boat[At(FossenParameter::kM33)] = 2.5;
  const PhysicalModel model = *testing::KnownPhysicalBoat(boat, 0.2).physical;
  const Interval& interval =
      model.parameters[static_cast<std::size_t>(At(FossenParameter::kM33))].interval;
  EXPECT_GE(RangeOf(model).greatest[At(FossenParameter::kM33)], interval.upper);
}

// Parameters far beyond what a boat can have: free runs of what is made of them stay finite.
TEST(PhysicalRange, MakesABoatOfAnything) {
  for (const double factor : {-10.0, -1.0, 0.0, 10.0}) {
    const FossenVector p = RangeOfTheBoat().Within(factor * PhysicalBoat());
    EXPECT_NO_THROW(FossenDynamics(p, testing::kPhysicalBoatSeparation)) << factor;
    for (const FossenParameter drag :
         {FossenParameter::kXu, FossenParameter::kXuu, FossenParameter::kYv, FossenParameter::kYvv,
          FossenParameter::kYrv, FossenParameter::kNr, FossenParameter::kNvr,
          FossenParameter::kNrr}) {
      EXPECT_GE(p[At(drag)], 0.0) << factor;
    }
    EXPECT_GE(p[At(FossenParameter::kM22)], 0.7) << factor;
  }
}

}  // namespace
}  // namespace telltale
