#include "telltale/service/diagnosis/diagnosis_recordings.hpp"

#include <optional>

#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"

namespace telltale {
namespace {

/// A fix a second of [start_s, end_s].
Recording FixesOf(double start_s, double end_s) {
  Recording recording;
  for (double t = start_s; t <= end_s; t += 1.0) recording.gnss.push_back({t, 0.0, 0.0});
  return recording;
}

PublishedModel ModelMadeOf(double start_s, double end_s) {
  PublishedModel model{MadeUpIdentification(), 3, 0.0};
  model.identification.window.start_s = start_s;
  model.identification.window.end_s = end_s;
  return model;
}

TEST(DiagnosisRecordings, IsWhatCameSinceTheModelAgainstWhatMadeIt) {
  const auto live =
      SelectDiagnosisRecordings(FixesOf(0.0, 500.0), ModelMadeOf(100.0, 400.0), std::nullopt);
  ASSERT_TRUE(live);
  EXPECT_EQ(live->since.gnss.front().time_s, 401.0);
  EXPECT_EQ(live->since.gnss.back().time_s, 500.0);
  ASSERT_TRUE(live->baseline);
  EXPECT_EQ(live->baseline->gnss.front().time_s, 100.0);
  EXPECT_EQ(live->baseline->gnss.back().time_s, 400.0);
  EXPECT_NE(live->basis.find("300 s behind revision 3"), std::string::npos) << live->basis;
}

TEST(DiagnosisRecordings, TakesTheRecordingBehindTheModelWhereItIsAtHand) {
  const auto live = SelectDiagnosisRecordings(FixesOf(4000.0, 4500.0), ModelMadeOf(100.0, 400.0),
                                              FixesOf(100.0, 400.0));
  ASSERT_TRUE(live);
  EXPECT_EQ(live->since.gnss.size(), 501u);
  ASSERT_TRUE(live->baseline);
  EXPECT_EQ(live->baseline->gnss.size(), 301u);
}

TEST(DiagnosisRecordings, SaysWhereNoBaselineIsAtHand) {
  const auto live =
      SelectDiagnosisRecordings(FixesOf(390.0, 500.0), ModelMadeOf(100.0, 400.0), std::nullopt);
  ASSERT_TRUE(live);
  EXPECT_FALSE(live->baseline);
  EXPECT_NE(live->basis.find("no longer holds"), std::string::npos) << live->basis;
}

TEST(DiagnosisRecordings, LeavesOutWhatCameBeforeTheDrift) {
  const PublishedModel model = ModelMadeOf(100.0, 400.0);
  const Recording window = FixesOf(0.0, 700.0);
  const auto live = SelectDiagnosisRecordings(window, model, std::nullopt, 600.0);
  ASSERT_TRUE(live);
  EXPECT_EQ(live->since.gnss.front().time_s, 601.0);
  EXPECT_NE(live->left_out.find("the 200 s before that"), std::string::npos) << live->left_out;
  ASSERT_TRUE(live->baseline);
  EXPECT_EQ(live->baseline->gnss.back().time_s, 400.0);
  // Too little has come since.
  const auto early = SelectDiagnosisRecordings(window, model, std::nullopt, 650.0);
  ASSERT_TRUE(early);
  EXPECT_EQ(early->since.gnss.front().time_s, 401.0);
  EXPECT_EQ(early->left_out, "");
}

TEST(DiagnosisRecordings, AWindowThatEndsBeforeTheModelsDataIsOfAnotherClock) {
  const auto live =
      SelectDiagnosisRecordings(FixesOf(0.0, 100.0), ModelMadeOf(1000.0, 1400.0), std::nullopt);
  ASSERT_TRUE(live);
  EXPECT_EQ(live->since.gnss.size(), 101u);
  EXPECT_FALSE(live->baseline);
}

TEST(DiagnosisRecordings, IsRefusedWhereTooLittleCameSince) {
  for (const double end_s : {400.0, 459.0}) {
    const auto live =
        SelectDiagnosisRecordings(FixesOf(0.0, end_s), ModelMadeOf(100.0, 400.0), std::nullopt);
    ASSERT_FALSE(live);
    EXPECT_NE(live.error().reason.find("revision 3"), std::string::npos);
  }
  EXPECT_FALSE(SelectDiagnosisRecordings(Recording(), ModelMadeOf(100.0, 400.0), std::nullopt));
}

}  // namespace
}  // namespace telltale
