#include "telltale/client/recording/inflated_file.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "telltale/client/recording/file_contents.hpp"
#include "telltale/client/recording/temporary_file.hpp"

namespace telltale {
namespace {

TEST(InflatedFile, HoldsWhatIsWritten) {
  const TemporaryFile file;
  InflatedFile out("log.gz", file.Path(), 5);
  EXPECT_TRUE(out.Write("abc", 3));
  EXPECT_TRUE(out.Write("de", 2));
  EXPECT_FALSE(out.Close());
  EXPECT_EQ(ReadFile(file.Path()), "abcde");
}

TEST(InflatedFile, TakesNoMoreThanItMayAndNamesWhatIsCompressed) {
  const TemporaryFile file;
  InflatedFile out("log.gz", file.Path(), 2'000'000);
  const std::string part(1'500'000, ' ');
  EXPECT_TRUE(out.Write(part.data(), part.size()));
  EXPECT_FALSE(out.Write(part.data(), part.size()));
  const auto refusal = out.Close();
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->subject, "log.gz");
  EXPECT_EQ(refusal->reason, "inflates to more than 0.002 GB");
  EXPECT_EQ(ReadFile(file.Path())->size(), part.size());
}

TEST(InflatedFile, SaysWhereItCannotBeWritten) {
  const std::filesystem::path nowhere = "/nowhere/log";
  InflatedFile out("log.gz", nowhere);
  EXPECT_FALSE(out.Write("a", 1));
  const auto refusal = out.Close();
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->subject, nowhere);
  EXPECT_EQ(refusal->reason, "cannot be written while log.gz is decompressed");
}

}  // namespace
}  // namespace telltale
