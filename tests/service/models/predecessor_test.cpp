#include "telltale/service/models/predecessor.hpp"

#include <string>

#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"
#include "support/temporary_folder.hpp"

namespace telltale {
namespace {

class PredecessorTest : public ::testing::Test {
 protected:
  PredecessorTest() {
    model_ = IdentificationByHand();
    model_.provenance = {};
  }

  Identification Over(double start_s) {
    model_.window.start_s = start_s;
    model_.window.end_s = start_s + 600.0;
    return model_;
  }

  TemporaryFolder folder_;
  Identification model_;
  ModelStore store_{Storage(folder_.Path())};
};

TEST_F(PredecessorTest, AFirstModelHasNone) {
  EXPECT_FALSE(ChangeSincePredecessor(store_, Over(0.0)));
}

TEST_F(PredecessorTest, IsTheNewestThatSharesNoData) {
  store_.Save(Over(0.0), 1.0, std::nullopt);
  store_.Save(Over(500.0), 2.0, std::nullopt);
  store_.Save(Over(900.0), 3.0, std::nullopt);
  const auto change = ChangeSincePredecessor(store_, Over(1100.0));
  ASSERT_TRUE(change);
  EXPECT_EQ(change->revision, 2u);
  EXPECT_EQ(change->verdict, ChangeVerdict::kNoSignificantChange);
  EXPECT_EQ(change->coefficients.size(), 5u);
}

TEST_F(PredecessorTest, ThatWasMadeAlike) {
  store_.Save(Over(0.0), 1.0, std::nullopt);
  model_.sampling_period_s = 1.0;
  store_.Save(Over(1000.0), 2.0, std::nullopt);
  model_.sampling_period_s = 0.2;
  model_.coefficients[7].estimate += 100.0;
  const auto change = ChangeSincePredecessor(store_, Over(2000.0));
  EXPECT_EQ(change->revision, 1u);
  EXPECT_EQ(change->verdict, ChangeVerdict::kChanged);
  EXPECT_EQ(change->coefficients[0].regressor, "r:d^2");
}

TEST_F(PredecessorTest, ThereIsNoVerdictOnModelsOfTheSameData) {
  store_.Save(Over(0.0), 1.0, std::nullopt);
  const auto change = ChangeSincePredecessor(store_, Over(599.0));
  ASSERT_TRUE(change);
  EXPECT_EQ(change->verdict, ChangeVerdict::kInconclusive);
  EXPECT_EQ(change->revision, 0u);
  EXPECT_NE(change->reason.find("share data"), std::string::npos);
}

TEST_F(PredecessorTest, ThereIsNoVerdictFromTooFewClusters) {
  model_.provenance.clusters = 10;
  store_.Save(Over(0.0), 1.0, std::nullopt);
  const auto change = ChangeSincePredecessor(store_, Over(600.0));
  EXPECT_EQ(change->verdict, ChangeVerdict::kInconclusive);
  EXPECT_EQ(change->revision, 1u);
}

}  // namespace
}  // namespace telltale
