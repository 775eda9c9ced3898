#include "telltale/service/web/model_answers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class ComparedTest : public ::testing::Test {
 protected:
  ComparedTest() {
    earlier.revision = 3;
    earlier.identification = IdentificationByHand();
    later = earlier;
    later.revision = 5;
    later.identification.window.start_s = earlier.identification.window.end_s + 100.0;
    later.identification.window.end_s = later.identification.window.start_s + 600.0;
  }

  PublishedModel earlier;
  PublishedModel later;
};

TEST_F(ComparedTest, FindsTheSameModelAlike) {
  const proto::Comparison answer = Compared(earlier, later);
  EXPECT_EQ(answer.earlier(), 3u);
  EXPECT_EQ(answer.later(), 5u);
  EXPECT_EQ(answer.change().verdict(), proto::ALIKE);
  EXPECT_EQ(answer.sentence(),
            "The models do not differ significantly, p = 1. Revision 5 is no different from "
            "revision 3: p = 1.");
  EXPECT_FALSE(answer.windows_overlap());
}

TEST_F(ComparedTest, NamesWhatDiffers) {
  later.identification.coefficients[6].estimate += 20.0;
  const proto::Comparison answer = Compared(earlier, later);
  EXPECT_EQ(answer.change().verdict(), proto::DIFFERS);
  EXPECT_THAT(answer.sentence(), StartsWith("The models differ, p = "));
  EXPECT_THAT(answer.sentence(), HasSubstr("Revision 5 differs from revision 3: p = "));
  EXPECT_EQ(answer.change().coefficients(0).regressor(), "f:d");
}

TEST_F(ComparedTest, SaysWhyModelsOfOtherOptionsCannotBeCompared) {
  later.identification.sampling_period_s = 0.5;
  const proto::Comparison answer = Compared(earlier, later);
  EXPECT_EQ(answer.change().verdict(), proto::CANNOT_TELL);
  EXPECT_EQ(answer.sentence(),
            "The models cannot be compared: the models differ in sampling period.");
}

TEST_F(ComparedTest, SaysWhereTheWindowsOverlap) {
  later.identification.window.start_s = earlier.identification.window.end_s - 1.0;
  EXPECT_TRUE(Compared(earlier, later).windows_overlap());
}

}  // namespace
}  // namespace telltale
