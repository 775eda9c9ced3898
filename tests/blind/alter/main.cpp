#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "alter/alterations.hpp"
#include "exit_code.hpp"

namespace {

struct Arguments {
  std::string log;
  std::string out;
  double turn_heading_deg = 0.0;
  double delay_fixes_s = 0.0;
  double shift_commands_s = 0.0;
  std::pair<std::string, double> weaken;
  std::vector<double> thrust_curve{0, 1, 0, 1, 0, 0};
  std::vector<double> move_antenna_m;
  std::vector<double> port_pulses_us{1500, 1900, 1100};
  std::vector<double> starboard_pulses_us{1500, 1900, 1100};
};

void AddOptions(CLI::App& app, Arguments& arguments) {
  app.add_option("--log", arguments.log, "a folder with gnss.csv, heading.csv and thrusters.csv")
      ->type_name("DIR")
      ->required();
  app.add_option("--out", arguments.out, "the folder for the altered log")
      ->type_name("DIR")
      ->required();
  app.add_option("--turn-heading-deg", arguments.turn_heading_deg,
                 "headings show so much more, clockwise, [-180, 180]")
      ->type_name("DEG")
      ->check(CLI::Range(-180.0, 180.0).description(""));
  app.add_option("--delay-fixes-s", arguments.delay_fixes_s,
                 "fixes are stamped so much later, [-10, 10]")
      ->type_name("S")
      ->check(CLI::Range(-10.0, 10.0).description(""));
  app.add_option("--shift-commands-s", arguments.shift_commands_s,
                 "commands are stamped so much earlier, as if thrusters answered late, [-10, 10]")
      ->type_name("S")
      ->check(CLI::Range(-10.0, 10.0).description(""));
  app.add_option("--weaken", arguments.weaken,
                 "port or starboard, and the share of thrust it gives away, [0, 0.9]: its commands "
                 "become those the weaker side would have needed by the thrust curve, cut at full "
                 "command")
      ->type_name("SIDE SHARE");
  app.add_option("--thrust-curve", arguments.thrust_curve,
                 "thrust by share of full command beyond the dead band: linear and quadratic "
                 "ahead, linear and quadratic in reverse, the dead bands (default 0 1 0 1 0 0)")
      ->type_name("F1 F2 R1 R2 DF DR")
      ->check(CLI::NonNegativeNumber.description(""))
      ->expected(6);
  app.add_option("--move-antenna-m", arguments.move_antenna_m,
                 "fixes are of a point so far forward and to starboard")
      ->type_name("FORWARD STARBOARD")
      ->expected(2);
  const auto pulses = [&](const char* name, std::vector<double>& of_side) {
    app.add_option(
           name, of_side,
           "microseconds at neutral, full forward and full reverse (default 1500 1900 1100)")
        ->type_name("NEUTRAL FORWARD REVERSE")
        ->expected(3);
  };
  pulses("--port-pulses-us", arguments.port_pulses_us);
  pulses("--starboard-pulses-us", arguments.starboard_pulses_us);
}

blind::alter::Channel ChannelOf(const std::vector<double>& pulses_us) {
  const blind::alter::Channel channel{pulses_us[0], pulses_us[1], pulses_us[2]};
  const double ahead = channel.full_forward_us - channel.neutral_us;
  const double astern = channel.full_reverse_us - channel.neutral_us;
  if (!(ahead * astern < 0.0)) {
    throw CLI::ValidationError("pulse widths",
                               "full forward and reverse lie on either side of neutral");
  }
  return channel;
}

blind::alter::ThrustCurve ThrustCurveOf(const std::vector<double>& curve) {
  if (curve[0] + curve[1] <= 0.0 || curve[2] + curve[3] <= 0.0 ||
      std::max(curve[4], curve[5]) >= 1.0) {
    throw CLI::ValidationError("--thrust-curve",
                               "thrust grows with the command, and the dead bands are below 1");
  }
  return {curve[0], curve[1], curve[2], curve[3], curve[4], curve[5]};
}

void ApplyWeakening(blind::alter::Telemetry& telemetry, const Arguments& arguments) {
  const auto& [name, lost] = arguments.weaken;
  if ((name != "port" && name != "starboard") || !(lost >= 0.0 && lost <= 0.9)) {
    throw CLI::ValidationError("--weaken", "port or starboard and a share in [0, 0.9]");
  }
  const bool port = name == "port";
  const auto& pulses = port ? arguments.port_pulses_us : arguments.starboard_pulses_us;
  const auto side = port ? blind::alter::Side::kPort : blind::alter::Side::kStarboard;
  const std::size_t cut = blind::alter::Weaken(telemetry, side, lost, ChannelOf(pulses),
                                               ThrustCurveOf(arguments.thrust_curve));
  if (cut > 0)
    std::cerr << "blind_alter: " << cut << " of " << telemetry.pulses.size()
              << " commands were cut at full command\n";
}

/// In the order in which they happen: at the boat, in the chain of the receiver, at the compass.
void Run(const Arguments& arguments) {
  blind::alter::Telemetry telemetry = blind::alter::ReadTelemetry(arguments.log);
  if (telemetry.rows_left_out > 0) {
    std::cerr << "blind_alter: " << telemetry.rows_left_out << " rows are no numbers, left out\n";
  }
  if (!arguments.weaken.first.empty()) ApplyWeakening(telemetry, arguments);
  blind::alter::ShiftCommands(telemetry, arguments.shift_commands_s);
  if (!arguments.move_antenna_m.empty()) {
    const std::size_t dropped = blind::alter::MoveAntenna(telemetry, arguments.move_antenna_m[0],
                                                          arguments.move_antenna_m[1]);
    if (dropped > 0) std::cerr << "blind_alter: " << dropped << " fixes without heading dropped\n";
  }
  blind::alter::DelayFixes(telemetry, arguments.delay_fixes_s);
  blind::alter::TurnHeading(telemetry, arguments.turn_heading_deg);
  blind::alter::WriteTelemetry(telemetry, arguments.out);
}

/// Writing over what is read would leave no log without the change.
void RefuseOverwriting(const Arguments& arguments) {
  std::error_code error;
  if (std::filesystem::equivalent(arguments.log, arguments.out, error)) {
    throw CLI::ValidationError("--out", "this is the log itself");
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Writes a log as it would be had one thing been otherwise");
  app.footer(
      "Reads CSV log folders only, not DataFlash .BIN files.\n"
      "Example: blind_alter --log run225 --turn-heading-deg 4 --out turned\n"
      "         blind_alter --log run225 --weaken starboard 0.2 \\\n"
      "           --starboard-pulses-us 1511 1111 1911 --out weaker");
  Arguments arguments;
  AddOptions(app, arguments);
  return blind::ExitCodeOf<std::invalid_argument>(app, "blind_alter", argc, argv, [&] {
    RefuseOverwriting(arguments);
    Run(arguments);
  });
}
