#include "telltale/idl/codec/vehicle_file.hpp"

#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "support/test_name.hpp"

namespace telltale {
namespace {

using testing::HasSubstr;

const std::string kGood = R"(vehicle_id: "boat-1"
propeller_separation_m: 0.57
port { neutral_us: 1511 full_forward_us: 1911 full_reverse_us: 1111 }
starboard { neutral_us: 1511 full_forward_us: 1111 full_reverse_us: 1911 }  # reversed
gnss_antenna { forward_m: 0.1 starboard_m: -0.2 }
mass_kg: 15.0
)";

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

void ExpectSame(const Vehicle& a, const Vehicle& b) {
  EXPECT_EQ(a.vehicle_id, b.vehicle_id);
  EXPECT_EQ(a.propeller_separation_m, b.propeller_separation_m);
  for (const auto& [x, y] : {std::pair(a.port, b.port), std::pair(a.starboard, b.starboard)}) {
    EXPECT_EQ(x.neutral_us, y.neutral_us);
    EXPECT_EQ(x.full_forward_us, y.full_forward_us);
    EXPECT_EQ(x.full_reverse_us, y.full_reverse_us);
  }
  EXPECT_EQ(a.gnss_antenna.forward_m, b.gnss_antenna.forward_m);
  EXPECT_EQ(a.gnss_antenna.starboard_m, b.gnss_antenna.starboard_m);
  EXPECT_EQ(a.mass_kg, b.mass_kg);
}

TEST(VehicleFile, ReadsEveryField) {
  const auto vehicle = ParseVehicle(kGood);
  ASSERT_TRUE(vehicle) << vehicle.error().Message();
  ExpectSame(*vehicle, {"boat-1", 0.57, {1511, 1911, 1111}, {1511, 1111, 1911}, {0.1, -0.2}, 15.0});
}

TEST(VehicleFile, AntennaAndMassMayBeLeftOut) {
  std::string text = Replaced(kGood, "mass_kg: 15.0", "");
  text = Replaced(text, "gnss_antenna { forward_m: 0.1 starboard_m: -0.2 }", "");
  const auto vehicle = ParseVehicle(text);
  ASSERT_TRUE(vehicle) << vehicle.error().Message();
  EXPECT_EQ(vehicle->gnss_antenna.forward_m, 0.0);
  EXPECT_EQ(vehicle->gnss_antenna.starboard_m, 0.0);
  EXPECT_FALSE(vehicle->mass_kg.has_value());
}

TEST(VehicleFile, FieldsOfTheHullHaveDefaults) {
  const auto without = ParseVehicle(kGood);
  ASSERT_TRUE(without) << without.error().Message();
  EXPECT_FALSE(without->hull.has_value());
  const auto vehicle = ParseVehicle(kGood + "hull { length_m: 2.0 lateral_area_m2: 0.9 }");
  ASSERT_TRUE(vehicle) << vehicle.error().Message();
  ASSERT_TRUE(vehicle->hull.has_value());
  EXPECT_EQ(vehicle->hull->length_m, 2.0);
  EXPECT_EQ(vehicle->hull->beam_m, HullParticulars{}.beam_m);
  EXPECT_EQ(vehicle->hull->draught_m, HullParticulars{}.draught_m);
  EXPECT_EQ(vehicle->hull->frontal_area_m2, HullParticulars{}.frontal_area_m2);
  EXPECT_EQ(vehicle->hull->lateral_area_m2, 0.9);
  const auto again = ParseVehicle(PrintVehicle(*vehicle));
  ASSERT_TRUE(again) << again.error().Message();
  EXPECT_EQ(again->hull->length_m, 2.0);
  EXPECT_EQ(again->hull->lateral_area_m2, 0.9);
}

TEST(VehicleFile, AHullOutOfRangeIsRefusedNamingItsField) {
  for (const auto& [field, value, allowed] :
       {std::tuple("length_m", "0.1", "[0.2, 100]"), std::tuple("beam_m", "51", "[0.1, 50]"),
        std::tuple("draught_m", "0", "[0.01, 20]"),
        std::tuple("frontal_area_m2", "-1", "[0.001, 1000]"),
        std::tuple("lateral_area_m2", "nan", "[0.001, 1000]")}) {
    const auto vehicle =
        ParseVehicle(kGood + "hull { " + field + ": " + value + " }", "boat.textproto");
    ASSERT_FALSE(vehicle) << field;
    EXPECT_EQ(vehicle.error().field, std::string("hull.") + field);
    EXPECT_EQ(vehicle.error().value, value);
    EXPECT_THAT(vehicle.error().allowed, HasSubstr(allowed));
    EXPECT_EQ(vehicle.error().where, "boat.textproto:7");
  }
}

TEST(VehicleFile, PrintedAndReadAgainIsTheSame) {
  const Vehicle vehicle{"a_b.c",     1.0 / 3.0,   {1500.5, 2000, 1000}, {1480, 1100, 1900},
                        {0.1, 1e-7}, std::nullopt};
  const auto again = ParseVehicle(PrintVehicle(vehicle));
  ASSERT_TRUE(again) << again.error().Message();
  ExpectSame(*again, vehicle);
  const auto from_proto = VehicleOf(ToProto(vehicle));
  ASSERT_TRUE(from_proto) << from_proto.error().Message();
  ExpectSame(*from_proto, vehicle);
}

struct VehicleFault {
  std::string from, to;  // what is changed in the good file
  std::string field, value, allowed, where;
};

void PrintTo(const VehicleFault& fault, std::ostream* out) {
  *out << AsTestName(fault.from + " to " + fault.to);
}

class WrongVehicle : public testing::TestWithParam<VehicleFault> {};

TEST_P(WrongVehicle, IsRefusedNamingFieldValueRangeAndLine) {
  const VehicleFault& fault = GetParam();
  testing::internal::CaptureStderr();
  const auto vehicle = ParseVehicle(Replaced(kGood, fault.from, fault.to), "boat.textproto");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_FALSE(vehicle);
  EXPECT_EQ(vehicle.error().field, fault.field);
  EXPECT_EQ(vehicle.error().value, fault.value);
  EXPECT_THAT(vehicle.error().allowed, HasSubstr(fault.allowed));
  EXPECT_EQ(vehicle.error().where, fault.where);
}

INSTANTIATE_TEST_SUITE_P(
    VehicleFile, WrongVehicle,
    testing::Values(
        VehicleFault{"vehicle_id: \"boat-1\"", "", "vehicle_id", "", "required", "boat.textproto"},
        VehicleFault{"boat-1", "", "vehicle_id", "\"\"", "1..64", "boat.textproto:1"},
        VehicleFault{"boat-1", "a/b", "vehicle_id", "\"a/b\"", "letters", "boat.textproto:1"},
        VehicleFault{"propeller_separation_m: 0.57", "", "propeller_separation_m", "", "[0.05, 50]",
                     "boat.textproto"},
        VehicleFault{"0.57", "0.049", "propeller_separation_m", "0.049", "[0.05, 50]",
                     "boat.textproto:2"},
        VehicleFault{"0.57", "50.1", "propeller_separation_m", "50.1", "[0.05, 50]",
                     "boat.textproto:2"},
        VehicleFault{"0.57", "nan", "propeller_separation_m", "nan", "[0.05, 50]",
                     "boat.textproto:2"},
        VehicleFault{"0.57", "inf", "propeller_separation_m", "inf", "[0.05, 50]",
                     "boat.textproto:2"},
        VehicleFault{"0.57", "\"wide\"", "propeller_separation_m", "\"wide\"", "double",
                     "boat.textproto:2"},
        VehicleFault{"propeller_separation_m", "propeller_seperation_m", "propeller_seperation_m",
                     "0.57", "propeller_separation_m", "boat.textproto:2"},
        VehicleFault{"port {", "larboard {", "larboard", "{", "port, starboard",
                     "boat.textproto:3"},
        VehicleFault{"port { neutral_us: 1511", "port { neutral_ms: 1511", "neutral_ms", "1511",
                     "neutral_us, full_forward_us, full_reverse_us", "boat.textproto:3"},
        VehicleFault{"port { neutral_us: 1511 full_forward_us: 1911 full_reverse_us: 1111 }", "",
                     "port", "", "required", "boat.textproto"},
        VehicleFault{"starboard { neutral_us: 1511", "starboard {", "starboard.neutral_us", "",
                     "[800, 2200]", "boat.textproto:4"},
        VehicleFault{"full_forward_us: 1911", "", "port.full_forward_us", "", "[500, 2500]",
                     "boat.textproto:3"},
        VehicleFault{"full_reverse_us: 1111", "", "port.full_reverse_us", "", "[500, 2500]",
                     "boat.textproto:3"},
        VehicleFault{"neutral_us: 1511", "neutral_us: 799", "port.neutral_us", "799", "[800, 2200]",
                     "boat.textproto:3"},
        VehicleFault{"full_forward_us: 1911", "full_forward_us: 2501", "port.full_forward_us",
                     "2501", "[500, 2500]", "boat.textproto:3"},
        VehicleFault{"full_reverse_us: 1111", "full_reverse_us: 499", "port.full_reverse_us", "499",
                     "[500, 2500]", "boat.textproto:3"},
        VehicleFault{"full_reverse_us: 1111", "full_reverse_us: 1600", "port.full_reverse_us",
                     "1600", "other side of neutral_us = 1511", "boat.textproto:3"},
        VehicleFault{"full_reverse_us: 1111", "full_reverse_us: 1511", "port.full_reverse_us",
                     "1511", "other side", "boat.textproto:3"},
        VehicleFault{"full_forward_us: 1911", "full_forward_us: 1511", "port.full_forward_us",
                     "1511", "other than neutral_us = 1511", "boat.textproto:3"},
        VehicleFault{"forward_m: 0.1", "forward_m: 101", "gnss_antenna.forward_m", "101",
                     "[-100, 100]", "boat.textproto:5"},
        VehicleFault{"starboard_m: -0.2", "starboard_m: -101", "gnss_antenna.starboard_m", "-101",
                     "[-100, 100]", "boat.textproto:5"},
        VehicleFault{"mass_kg: 15.0", "mass_kg: 0", "mass_kg", "0", "(0, 100000]",
                     "boat.textproto:6"},
        VehicleFault{"mass_kg: 15.0", "mass_kg: 1e6", "mass_kg", "1000000", "(0, 100000]",
                     "boat.textproto:6"},
        VehicleFault{"mass_kg: 15.0", "\tmass_kg:\theavy", "mass_kg", "heavy", "double",
                     "boat.textproto:6"},
        VehicleFault{"mass_kg: 15.0", "mass_kg: 15.0 mass_kg: 16", "mass_kg", "16",
                     "multiple times", "boat.textproto:6"}));

TEST(VehicleFile, TextThatIsNoVehicleIsRefused) {
  EXPECT_EQ(ParseVehicle("").error().field, "vehicle_id");
  EXPECT_EQ(ParseVehicle("{\"vehicleId\": 1}").error().where, "vehicle file:1");
  EXPECT_FALSE(ParseVehicle(std::string("\0\xff\xfe", 3)));
}

TEST(VehicleFile, AnIdHasUpTo64Characters) {
  EXPECT_TRUE(IsVehicleId(std::string(64, 'x')));
  EXPECT_FALSE(IsVehicleId(std::string(65, 'x')));
  EXPECT_FALSE(IsVehicleId("b\xc3\xa5t"));
}

TEST(VehicleIdLike, IsAlwaysAVehicleId) {
  EXPECT_EQ(VehicleIdLike("00000042"), "00000042");
  EXPECT_EQ(VehicleIdLike("2024-05-01 12:00"), "2024-05-01_12_00");
  EXPECT_EQ(VehicleIdLike("b\xc3\xa5t"), "b__t");
  EXPECT_EQ(VehicleIdLike(""), "_");
  EXPECT_EQ(VehicleIdLike(std::string(65, 'x')), std::string(64, 'x'));
  for (int c = 0; c < 256; ++c) {
    EXPECT_TRUE(IsVehicleId(VehicleIdLike(std::string(1, static_cast<char>(c))))) << c;
  }
}

}  // namespace
}  // namespace telltale
