#include "telltale/service/storage/database.hpp"

#include <filesystem>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace telltale {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class DatabaseTest : public ::testing::Test {
 protected:
  std::filesystem::path File() const { return folder_.Path() / "models.sqlite"; }

  void SetVersion(int version) const {
    SQLite::Database(File(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
        .exec("PRAGMA user_version = " + std::to_string(version));
  }

  /// What opening says; empty where it succeeds.
  std::string Fault() const {
    try {
      OpenDatabase(folder_.Path());
      return "";
    } catch (const SQLite::Exception& error) {
      return error.what();
    }
  }

  TemporaryFolder folder_;
};

TEST_F(DatabaseTest, OpensWhatItHasCreated) {
  EXPECT_EQ(Fault(), "");
  EXPECT_EQ(Fault(), "");
  SQLite::Database database(File());
  EXPECT_EQ(database.execAndGet("PRAGMA user_version").getInt(), 3);
}

TEST_F(DatabaseTest, RefusesADatabaseOfAnOlderVersionAndSaysWhatToDo) {
  SetVersion(1);
  EXPECT_THAT(Fault(),
              AllOf(HasSubstr(File().string()), HasSubstr("schema version 1"),
                    HasSubstr("move the file away"), HasSubstr("identify the vehicles again")));
}

TEST_F(DatabaseTest, LeavesADatabaseThatItRefusesAsItIs) {
  SetVersion(1);
  Fault();
  SQLite::Database database(File());
  EXPECT_EQ(database.execAndGet("PRAGMA user_version").getInt(), 1);
  EXPECT_NE(std::string(database.execAndGet("PRAGMA journal_mode").getText()), "wal");
}

TEST_F(DatabaseTest, RefusesADatabaseOfALaterVersion) {
  SetVersion(99);
  EXPECT_THAT(Fault(), AllOf(HasSubstr("schema version 99"), HasSubstr("later version")));
}

}  // namespace
}  // namespace telltale
