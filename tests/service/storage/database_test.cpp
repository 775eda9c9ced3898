#include "telltale/service/storage/database.hpp"

#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/storage_fixture.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/service/storage/stores.hpp"

namespace telltale {
namespace {

using namespace std::string_view_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;

Schema Notes(int version = 1) {
  return {.name = "notes",
          .tables = {{"notes",
                      {{"id", ColumnType::kInteger, "NOT NULL"},
                       {"value", ColumnType::kReal, ""},
                       {"text", ColumnType::kText, ""},
                       {"bytes", ColumnType::kBlob, ""}},
                      {"id"}}},
          .version = version,
          .oldest_version = 1};
}

class DatabaseTest : public StorageTest {
 protected:
  /// What opening says; empty where it succeeds.
  std::string Fault(const Schema& schema) const {
    try {
      Storage().Open(schema);
      return "";
    } catch (const DatabaseError& error) {
      return error.what();
    }
  }

  static std::int64_t Count(Database& database) {
    return IntegerOf(database, "SELECT COUNT(*) AS value FROM notes");
  }
};

INSTANTIATE_TEST_SUITE_P(Engines, DatabaseTest, kEngines, EngineName);

TEST_P(DatabaseTest, GivesBackEachValueAsItWas) {
  const auto database = Storage().Open(Notes());
  const std::string_view bytes = "\0\x7f\x80\xff'\\"sv;
  constexpr double kReal = 0.1 + 0.2;  // seventeen digits tell it from its neighbours
  constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::lowest();
  EXPECT_EQ(database->Execute("INSERT INTO notes VALUES ($1, $2, $3, $4)",
                              {kLowest, kReal, "d\u00e9j\u00e0 '\\"sv, Blob(bytes)}),
            1u);
  EXPECT_EQ(
      database->Execute("INSERT INTO notes VALUES ($1, $2, $3, $4)",
                        {std::int64_t{2}, std::monostate(), std::monostate(), std::monostate()}),
      1u);
  int rows = 0;
  database->Query("SELECT * FROM notes ORDER BY id", {}, [&](const Row& row) {
    if (++rows == 2) {
      for (const char* column : {"value", "text", "bytes"}) EXPECT_TRUE(row.IsNull(column));
      return;
    }
    EXPECT_FALSE(row.IsNull("bytes"));
    EXPECT_EQ(row.Integer("id"), kLowest);
    EXPECT_EQ(row.Real("value"), kReal);
    EXPECT_EQ(row.Text("text"), "d\u00e9j\u00e0 '\\");
    EXPECT_EQ(row.Bytes("bytes"), bytes);
  });
  EXPECT_EQ(rows, 2);
}

TEST_P(DatabaseTest, UndoesATransactionThatThrows) {
  const auto database = Storage().Open(Notes());
  const auto insert = [&] { database->Execute("INSERT INTO notes (id) VALUES (1)"); };
  EXPECT_THROW(database->InTransaction([&] {
    insert();
    throw std::logic_error("no");
  }),
               std::logic_error);
  EXPECT_EQ(Count(*database), 0);
  database->InTransaction(insert);
  EXPECT_EQ(Count(*database), 1);
  EXPECT_THROW(database->InTransaction(insert), DatabaseError);
  EXPECT_EQ(Count(*database), 1);
}

TEST_P(DatabaseTest, SaysWhetherWhatComesIsSaved) {
  const telltale::Storage storage = Storage();
  const auto database = storage.Open(Notes());
  EXPECT_FALSE(storage.status().Fault());
  EXPECT_THROW(database->Execute("INSERT INTO nowhere VALUES (1)"), DatabaseError);
  ASSERT_TRUE(storage.status().Fault());
  EXPECT_THAT(*storage.status().Fault(), HasSubstr("nowhere"));
  EXPECT_FALSE(storage.status().Unavailable());
  database->Execute("INSERT INTO notes (id) VALUES (1)");
  EXPECT_FALSE(storage.status().Fault());
}

TEST_P(DatabaseTest, KeepsWhatItHasAcrossOpenings) {
  Storage().Open(Notes())->Execute("INSERT INTO notes (id) VALUES (1)");
  EXPECT_EQ(Count(*Storage().Open(Notes())), 1);
}

TEST_P(DatabaseTest, AddsTheColumnsThatAnOlderVersionLacks) {
  Storage().Open(Notes())->Execute("INSERT INTO notes (id) VALUES (1)");
  Schema later = Notes(2);
  later.tables[0].columns.push_back({"author", ColumnType::kText, "NOT NULL DEFAULT 'nobody'"});
  later.tables.push_back({"pages", {{"number", ColumnType::kCounter, ""}}, {}});
  const auto database = Storage().Open(later);
  std::string author;
  database->Query("SELECT author FROM notes", {},
                  [&](const Row& row) { author = row.Text("author"); });
  EXPECT_EQ(author, "nobody");
  EXPECT_EQ(IntegerOf(*database, "SELECT COUNT(*) AS value FROM pages"), 0);
}

TEST_P(DatabaseTest, RefusesAnOlderVersionThatItCannotBringToItsOwnAndSaysWhatToDo) {
  EXPECT_EQ(Fault(Notes(1)), "");
  Schema later = Notes(3);
  later.oldest_version = 2;
  EXPECT_THAT(Fault(later), AllOf(HasSubstr("notes"), HasSubstr("schema version 1"),
                                  HasSubstr("identify the vehicles again")));
  EXPECT_EQ(Fault(Notes(1)), "");
}

TEST_P(DatabaseTest, RefusesALaterVersionAndLeavesItAsItIs) {
  EXPECT_EQ(Fault(Notes(99)), "");
  EXPECT_THAT(Fault(Notes(1)), AllOf(HasSubstr("schema version 99"), HasSubstr("later version")));
  EXPECT_EQ(Fault(Notes(99)), "");
}

TEST(SqliteDatabase, LeavesAFileThatItRefusesAsItIs) {
  const TemporaryFolder folder;
  const auto file = folder.Path() / "models.sqlite";
  SQLite::Database(file, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
      .exec("PRAGMA user_version = 1");
  try {
    Storage(folder.Path()).Open(ModelsSchema());
    ADD_FAILURE() << "it is opened";
  } catch (const DatabaseError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr(file.string()), HasSubstr("schema version 1"),
                                    HasSubstr("move the file away")));
  }
  SQLite::Database database(file);
  EXPECT_EQ(database.execAndGet("PRAGMA user_version").getInt(), 1);
  EXPECT_NE(std::string(database.execAndGet("PRAGMA journal_mode").getText()), "wal");
}

TEST(PostgresDatabase, ConnectsAgainToAServerThatComesBack) {
  EngineStorage engine(Engine::kPostgres);
  const telltale::Storage storage = engine.Storage();
  const auto database = storage.Open(Notes());
  database->Execute("INSERT INTO notes (id) VALUES (1)");
  engine.Server().Stop();
  const auto count = [&] { return IntegerOf(*database, "SELECT COUNT(*) AS value FROM notes"); };
  EXPECT_THROW(count(), DatabaseUnavailable);
  EXPECT_THROW(count(), DatabaseUnavailable);  // within the second in which it does not try
  ASSERT_TRUE(storage.status().Unavailable());
  engine.Server().Start();
  const auto returns = [&] {
    try {
      return count() == 1;
    } catch (const DatabaseUnavailable&) {
      return false;
    }
  };
  while (!returns()) {  // for as long as a test may run
  }
  EXPECT_FALSE(storage.status().Fault());
  engine.Server().Stop();
  engine.Server().Start();
  EXPECT_EQ(count(), 1);  // nobody has noticed
}

TEST(PostgresDatabase, UndoesWhatALostConnectionLeavesHalfDone) {
  EngineStorage engine(Engine::kPostgres);
  const auto database = engine.Storage().Open(Notes());
  EXPECT_THROW(database->InTransaction([&] {
    database->Execute("INSERT INTO notes (id) VALUES (1)");
    engine.Server().Stop();
    engine.Server().Start();
    database->Execute("INSERT INTO notes (id) VALUES (2)");
  }),
               DatabaseUnavailable);
  EXPECT_EQ(IntegerOf(*database, "SELECT COUNT(*) AS value FROM notes"), 0);
}

TEST(PostgresDatabase, SaysWhyThereIsNoConnectionWithoutThePassword) {
  const TemporaryFolder folder;
  try {
    Storage(folder.Path(), "postgresql://boat:sesame@127.0.0.1:1/telltale").Open(Notes());
    ADD_FAILURE() << "it is opened";
  } catch (const DatabaseUnavailable& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("PostgreSQL"), HasSubstr("127.0.0.1"),
                                    ::testing::Not(HasSubstr("sesame"))));
  }
}

}  // namespace
}  // namespace telltale
