#include "seal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace blind::truth {
namespace {

constexpr const char* kLabel = R"({"kind":"single","effects":[{"effect":"wind"}]})";

TEST(Seal, GivesBackWhatWasSealed) {
  EXPECT_EQ(Unsealed(Sealed(kLabel, "017"), "017"), kLabel);
}

TEST(Seal, TellsNothingByWordsOrLength) {
  const std::string sealed = Sealed(kLabel, "017");
  EXPECT_THAT(sealed, testing::Not(testing::HasSubstr("wind")));
  EXPECT_EQ(sealed.size(), Sealed("{}", "017").size());
  EXPECT_NE(sealed, Sealed(kLabel, "018"));
}

TEST(Seal, NoticesAnotherCaseAndEveryChange) {
  const std::string sealed = Sealed(kLabel, "017");
  EXPECT_THROW(Unsealed(sealed, "018"), std::invalid_argument);
  EXPECT_THROW(Unsealed(sealed.substr(0, 200), "017"), std::invalid_argument);
  EXPECT_THROW(Unsealed("wind", "017"), std::invalid_argument);
  for (const std::size_t at : {20u, 100u, 4000u}) {
    std::string changed = sealed;
    changed[at] = changed[at] == '0' ? '1' : '0';
    EXPECT_THROW(Unsealed(changed, "017"), std::invalid_argument) << at;
  }
}

TEST(Seal, RefusesALabelTooLong) {
  EXPECT_THROW(Sealed(std::string(kSealedBytes + 1, 'x'), "017"), std::invalid_argument);
}

}  // namespace
}  // namespace blind::truth
