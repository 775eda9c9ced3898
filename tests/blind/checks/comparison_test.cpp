#include "score/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "seal.hpp"
#include "support/temporary_folder.hpp"

namespace blind::score {
namespace {

using telltale::TemporaryFolder;

constexpr const char* kWindCase = R"({"kind":"single","effects":[{"effect":"wind","size":1}]})";
constexpr const char* kNominalCase = R"({"kind":"nominal","effects":[]})";
constexpr const char* kWindReport = R"({"verdict":"EXPLAINED","gap":{"closure":0.9},)"
                                    R"("causes":[{"effects":["wind"],"probability":0.95}]})";
constexpr const char* kNoGap = R"({"verdict":"NO_MATERIAL_GAP"})";

/// A set of two cases, wind and nominal.
class ContestTest : public testing::Test {
 protected:
  ContestTest() {
    folder_.Write("set/cases/001/hull", "tern\n");
    folder_.Write("set/cases/002/hull", "tern\n");
    folder_.Write("set/labels/001.sealed", truth::Sealed(kWindCase, "001"));
    folder_.Write("set/labels/002.sealed", truth::Sealed(kNominalCase, "002"));
  }
  Comparison ScoresOf(const std::string& reports, bool partial = false) const {
    return Scores(folder_.Path() / "set", {folder_.Path() / reports}, partial);
  }

  TemporaryFolder folder_;
};

TEST_F(ContestTest, ScoresReportsAgainstTheirLabels) {
  folder_.Write("mine/001.json", kWindReport);
  folder_.Write("mine/001.realised.json", R"({"closure": 0.85})");
  folder_.Write("mine/002.json", kNoGap);
  const Comparison comparison = ScoresOf("mine/");
  ASSERT_EQ(comparison.methods.size(), 1u);
  EXPECT_EQ(comparison.methods[0].name, "mine");
  const Figures& figures = comparison.methods[0].figures;
  EXPECT_EQ(figures.all.top_1.hits, 1u);
  EXPECT_EQ(figures.false_alarms.hits, 0u);
  EXPECT_EQ(figures.false_alarms.all, 1u);
  ASSERT_EQ(figures.closure_errors.size(), 1u);
  EXPECT_NEAR(figures.closure_errors[0], 0.05, 1e-12);
}

TEST_F(ContestTest, OpensNoLabelWhileAReportIsMissing) {
  folder_.Write("mine/001.json", kWindReport);
  folder_.Write("set/labels/001.sealed", "opening this would be noticed");
  try {
    ScoresOf("mine");
    FAIL() << "scored without a report";
  } catch (const ReportsMissing& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("1 of 2 cases have no report yet (002)"));
  }
}

TEST_F(ContestTest, OpensNoLabelWhileAReportCannotBeRead) {
  folder_.Write("mine/001.json", kWindReport);
  folder_.Write("mine/002.json", "{");
  folder_.Write("set/labels/001.sealed", "opening this would be noticed");
  try {
    ScoresOf("mine");
    FAIL() << "scored an unreadable report";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::EndsWith("mine/002.json: this is no JSON"));
  }
}

TEST_F(ContestTest, ScoresSomeWhereAskedTo) {
  folder_.Write("mine/002.json", kNoGap);
  EXPECT_EQ(ScoresOf("mine", true).cases, 1u);
}

TEST_F(ContestTest, ReadsWhatIsSaidWithoutTheTrueEffect) {
  folder_.Write("mine/001.json", kWindReport);
  folder_.Write("mine/002.json", kNoGap);
  folder_.Write("mine/left-out/001.json",
                R"({"verdict":"EXPLAINED","causes":[{"effects":["current"],"probability":0.9}]})");
  const auto singles = SingleEffects(folder_.Path() / "set", {folder_.Path() / "mine"}, false);
  EXPECT_THAT(singles, testing::ElementsAre(testing::Pair("001", "wind")));
  EXPECT_EQ(ScoresOf("mine").methods[0].figures.confidently_wrong.hits, 1u);

  folder_.Write("mine/left-out/001.json",
                R"({"verdict":"NO_MATERIAL_GAP","effects":[{"effect":"wind"}]})");
  try {
    ScoresOf("mine");
    FAIL() << "took a report with the true effect in the library";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::EndsWith("left-out/001.json: wind was not left out"));
  }
}

TEST_F(ContestTest, ListsNoEffectWhileAReportIsMissing) {
  folder_.Write("mine/001.json", kWindReport);
  EXPECT_THROW(SingleEffects(folder_.Path() / "set", {folder_.Path() / "mine"}, false),
               ReportsMissing);
}

TEST_F(ContestTest, TakesDetectabilityFromTheFirstFolderWhereAnotherHasNone) {
  folder_.Write(
      "mine/001.json",
      R"({"verdict":"NO_MATERIAL_GAP","effects":[{"effect":"wind","detectability":12}]})");
  folder_.Write("mine/002.json", kNoGap);
  folder_.Write("other/001.json", kWindReport);
  folder_.Write("other/002.json", kNoGap);
  const Comparison comparison =
      Scores(folder_.Path() / "set", {folder_.Path() / "mine", folder_.Path() / "other"}, false);
  EXPECT_EQ(comparison.methods[1].figures.detectable.top_1.hits, 1u);
  EXPECT_EQ(comparison.methods[1].figures.detectable.top_1.all, 1u);
}

TEST_F(ContestTest, NamesABrokenSeal) {
  folder_.Write("mine/001.json", kWindReport);
  folder_.Write("mine/002.json", kNoGap);
  folder_.Write("set/labels/002.sealed", truth::Sealed(kNominalCase, "003"));
  try {
    ScoresOf("mine");
    FAIL() << "took a label of another case";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("002.sealed: the seal is broken"));
  }
}

}  // namespace
}  // namespace blind::score
