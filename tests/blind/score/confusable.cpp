#include "score/confusable.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace blind::score {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 23> kPairs = {{
    {"wind", "current"},                     // both push across and along with the heading
    {"heading_bias", "current"},             // both let course and heading part
    {"body_bias", "thruster_misalignment"},  // a turn and a push to one side
    {"thruster_imbalance", "thruster_misalignment"},
    {"thruster_lag", "thruster_delay"},     // thrust that comes late
    {"gnss_latency", "thruster_delay"},     // a boat that seems to answer late
    {"gnss_latency", "antenna_lever_arm"},  // fixes off the boat while it moves
    {"thrust_gain", "payload"},             // less acceleration for the same command
    {"thrust_gain", "hull_fouling"},        // less speed for the same command
    {"thrust_gain", "crossflow_drag"},
    {"thrust_gain", "thrust_sag"},
    {"thrust_sag", "hull_fouling"},
    {"thrust_inflow_loss", "hull_fouling"},  // both grow with speed
    {"hull_fouling", "crossflow_drag"},      // more drag
    {"trim_sinkage", "payload"},             // the same load
    {"trim_sinkage", "hull_fouling"},
    {"output_slew", "thruster_lag"},  // thrust that comes late
    {"output_slew", "thruster_delay"},
    {"output_stuck", "thruster_imbalance"},  // one side that does not follow
    {"intermittent_thrust_loss", "thruster_imbalance"},
    {"magnetic_deviation", "heading_bias"},  // headings off
    {"magnetic_deviation", "current"},
    {"current_shear", "current"},
}};

}  // namespace

bool AreConfusable(std::string_view one, std::string_view other) {
  return std::any_of(kPairs.begin(), kPairs.end(), [&](const auto& pair) {
    return pair == std::pair(one, other) || pair == std::pair(other, one);
  });
}

}  // namespace blind::score
