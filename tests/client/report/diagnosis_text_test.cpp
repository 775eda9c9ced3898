#include "telltale/client/report/diagnosis_text.hpp"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

constexpr double kDegree = std::numbers::pi / 180.0;

CausalEffect Wind() {
  CausalEffect wind;
  wind.effect = "wind";
  wind.parameters = {{"wind_north", 3.0, 0.5, "m/s"}};
  wind.size = ParameterEstimate{"speed", 5.0, 0.375, "m/s"};
  wind.towards = CircularInterval{307.0 * kDegree, 7.0 * kDegree, false};
  return wind;
}

TEST(EstimatesOf, WeatherBeginsWithItsSizeAndDirection) {
  EXPECT_THAT(EstimatesOf(Wind()),
              ElementsAre(Pair("speed", "5.00 ± 0.38 m/s"), Pair("towards", "307 ± 7 deg (95 %)"),
                          Pair("wind_north", "3.00 ± 0.50 m/s")));
}

TEST(EstimatesOf, ADirectionThatTheRecordingDoesNotTellIsAny) {
  CausalEffect wind = Wind();
  wind.towards->half_width_rad = 95.0 * kDegree;
  EXPECT_THAT(EstimatesOf(wind), ::testing::Contains(Pair("towards", "any")));
}

TEST(EstimatesOf, AnAxisHasTwoDirections) {
  CausalEffect wind = Wind();
  wind.towards->or_opposite = true;
  EXPECT_THAT(EstimatesOf(wind),
              ::testing::Contains(Pair("towards", "307 ± 7 deg (95 %), or the opposite way")));
}

TEST(EstimatesOf, AFaultHasItsParametersAlone) {
  CausalEffect lag;
  lag.parameters = {{"tau", 0.15, 0.035, "s"}};
  EXPECT_THAT(EstimatesOf(lag), ElementsAre(Pair("tau", "0.150 ± 0.035 s")));
}

TEST(BesideWeatherText, NamesAllThatIsThere) {
  Diagnosis diagnosis;
  EXPECT_EQ(BesideWeatherText(diagnosis), "");
  diagnosis.present_weather = {"waves"};
  EXPECT_EQ(BesideWeatherText(diagnosis), " and the waves of this recording");
  diagnosis.present_weather = {"wind", "waves"};
  EXPECT_EQ(BesideWeatherText(diagnosis), " and the wind and waves of this recording");
}

}  // namespace
}  // namespace telltale
