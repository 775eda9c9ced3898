#include "telltale/idl/codec/json/model_version.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"
#include "telltale/core/base/version.hpp"
#include "telltale/idl/codec/json/model.hpp"

namespace telltale {
namespace {

std::string ModelOfVersion(const std::string& version) {
  return "{\"provenance\": {\"softwareVersion\": \"" + version + "\"}, \"outdated\": 3}";
}

TEST(ModelVersion, AnOlderModelIsRefusedWithItsVersionAndWhatToDo) {
  for (const char* version : {"0.1.0", "0.1.99", "0.0.7"}) {
    const auto read = ParseModelJson(ModelOfVersion(version), "boat.json");
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().Message(),
              "boat.json: provenance.softwareVersion = \"" + std::string(version) +
                  "\": this version reads models of version 0.2.0 and later; identify the vehicle "
                  "again with this version");
  }
}

TEST(ModelVersion, AnOlderModelIsRefusedThoughAllItsFieldsAreKnown) {
  Identification made = MadeUpIdentification();
  made.provenance.software_version = "0.1.0";
  const auto read = ParseModelJson(PrintModelJson(made));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().field, "provenance.softwareVersion");
}

TEST(ModelVersion, RecentModelsAreNotOutdated) {
  for (const char* version : {"0.2.0", "0.2.1", "0.10.0", "1.0.0"}) {
    EXPECT_FALSE(OutdatedModel(ModelOfVersion(version), "boat.json")) << version;
  }
  EXPECT_FALSE(OutdatedModel(ModelOfVersion(std::string(Version())), "boat.json"));
}

TEST(ModelVersion, AnUnknownFieldOfARecentModelIsNamed) {
  EXPECT_EQ(ParseModelJson(ModelOfVersion("0.2.0")).error().field, "outdated");
}

TEST(ModelVersion, TextWithoutAVersionIsNotOutdated) {
  for (const char* text : {"", "{", "[1]", "null", "{}", "{\"provenance\": 7}",
                           "{\"provenance\": {\"softwareVersion\": 7}}"}) {
    EXPECT_FALSE(OutdatedModel(text, "boat.json")) << text;
  }
  for (const char* version : {"", "0.1", "0.1.0.0", "0.1.x", "old"}) {
    EXPECT_FALSE(OutdatedModel(ModelOfVersion(version), "boat.json")) << version;
  }
}

}  // namespace
}  // namespace telltale
