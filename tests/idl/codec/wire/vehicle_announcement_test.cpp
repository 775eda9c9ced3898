#include "telltale/idl/codec/wire/vehicle_announcement.hpp"

#include <cstring>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

Vehicle Boat() {
  Vehicle vehicle = YellowfishVehicle();
  vehicle.vehicle_id = "boat-7";
  vehicle.mass_kg = 21.5;
  return vehicle;
}

/// The announcement of boat-7 with this text.
auto WithText(const std::string& text) {
  auto wire = Encode(Boat());
  dds_string_free(wire->vehicle_file);
  wire->vehicle_file = dds_string_dup(text.c_str());
  return wire;
}

/// Why it is refused; empty where it is not.
std::string ReasonOf(const WireSample<telltale_wire_VehicleAnnouncement>& wire) {
  const auto vehicle = Decode(*wire);
  return vehicle ? "" : std::string(Name(vehicle.error().reason));
}

TEST(WireVehicleAnnouncement, ArrivesAsItWasSent) {
  const auto vehicle = Decode(*Encode(Boat()));
  ASSERT_TRUE(vehicle) << vehicle.error().Message();
  EXPECT_EQ(PrintVehicle(*vehicle), PrintVehicle(Boat()));
}

TEST(WireVehicleAnnouncement, MayHaveCommentsInAnyLanguage) {
  EXPECT_EQ(ReasonOf(WithText("# Möwe, 鴎\r\n\t" + PrintVehicle(Boat()))), "");
}

TEST(WireVehicleAnnouncement, IsRefusedByItsFirstFault) {
  const std::string file = PrintVehicle(Boat());
  auto two_words = Encode(Boat());
  std::strcpy(two_words->vehicle_id, "two words");
  EXPECT_EQ(ReasonOf(two_words), "MALFORMED_VEHICLE_ID");

  const std::string room(kLargestVehicleFile - file.size(), ' ');
  EXPECT_EQ(ReasonOf(WithText(file + room)), "");
  EXPECT_EQ(ReasonOf(WithText(file + room + " ")), "TOO_LARGE");

  EXPECT_EQ(ReasonOf(WithText("# \x1b[31m\n" + file)), "NOT_TEXT") << "a terminal obeys it";
  EXPECT_EQ(ReasonOf(WithText("# \xc2\x9b\n" + file)), "NOT_TEXT") << "so does one of 8 bits";
  // From table 3-7 of the Unicode standard: what is no well-formed UTF-8.
  EXPECT_EQ(ReasonOf(WithText("# \xc0\xaf\n" + file)), "NOT_TEXT") << "overlong";
  EXPECT_EQ(ReasonOf(WithText("# \xed\xa0\x80\n" + file)), "NOT_TEXT") << "a surrogate";
  EXPECT_EQ(ReasonOf(WithText("# \xf4\x90\x80\x80\n" + file)), "NOT_TEXT") << "past the last";
  EXPECT_EQ(ReasonOf(WithText(file + "# \xe4")), "NOT_TEXT") << "cut off";

  EXPECT_EQ(ReasonOf(WithText("")), "NOT_A_VEHICLE_FILE");
  EXPECT_EQ(ReasonOf(WithText(file + "speed: 3\n")), "NOT_A_VEHICLE_FILE");
  EXPECT_EQ(ReasonOf(WithText(file + "mass_kg: 3\n")), "NOT_A_VEHICLE_FILE") << "twice";

  auto other = Encode(Boat());
  std::strcpy(other->vehicle_id, "boat-8");
  EXPECT_EQ(ReasonOf(other), "OTHER_VEHICLE_ID");
  auto nothing = Encode(Boat());
  dds_string_free(nothing->vehicle_file);
  nothing->vehicle_file = nullptr;
  EXPECT_EQ(ReasonOf(nothing), "NOT_A_VEHICLE_FILE") << "the type of the writer lacks the field";
}

TEST(WireVehicleAnnouncement, SaysWhichFieldOfWhichBoatIsWrong) {
  Vehicle vehicle = Boat();
  vehicle.propeller_separation_m = 99.0;
  const auto decoded = Decode(*Encode(vehicle));
  ASSERT_FALSE(decoded);
  EXPECT_THAT(decoded.error().Message(), HasSubstr("announcement of boat-7"));
  EXPECT_THAT(decoded.error().Message(), HasSubstr("propeller_separation_m = 99"));
  EXPECT_THAT(decoded.error().Message(), HasSubstr("[0.05, 50]"));
}

TEST(WireVehicleAnnouncement, OfARetiredBoatHasItsKeyAlone) {
  EXPECT_EQ(AnnouncedId(*EncodeRetired("boat-7")), "boat-7");
  EXPECT_EQ(ReasonOf(EncodeRetired("boat-7")), "NOT_A_VEHICLE_FILE");
}

}  // namespace
}  // namespace telltale
