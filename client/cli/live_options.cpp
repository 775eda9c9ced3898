#include "telltale/client/cli/live_options.hpp"
#include "telltale/client/cli/number_range.hpp"

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {

void LiveOptions::AddTo(CLI::App& command, double default_timeout_s,
                        const std::string& timeout_help) {
  timeout_s = default_timeout_s;
  command.add_option("--domain", domain, "DDS domain")
      ->envname("TELLTALE_DOMAIN")
      ->check(CLI::Range(0u, kHighestDomain))
      ->capture_default_str();
  command.add_option("--timeout", timeout_s, timeout_help)
      ->type_name("S")
      ->check(NumberWithin(0.0, 1e6))
      ->capture_default_str();
}

RequestTiming LiveOptions::Timing() const {
  RequestTiming timing;
  timing.match = std::min(timing.match, Timeout());
  timing.reply = Timeout();
  return timing;
}

CLI::Validator IdentifierText() {
  const auto check = [](const std::string& text) {
    return IsVehicleId(text) ? std::string() : "must be " + std::string(kVehicleIdAllowed);
  };
  return {check, ""};
}

CLI::Option* AddVehicleId(CLI::App& command, std::string& vehicle_id) {
  return command.add_option("--vehicle-id", vehicle_id, "the vehicle")
      ->type_name("ID")
      ->check(IdentifierText());
}

std::string TimedOutText(const LiveOptions& live) {
  return "the daemon is there but did not answer within " + Fixed(live.timeout_s, 0) +
         " s: look at its log, or raise --timeout";
}

std::string NobodyThereAdvice(std::uint32_t domain) {
  return "is telltaled running on domain " + std::to_string(domain) +
         " (--domain, TELLTALE_DOMAIN), and do both sides use the same CYCLONEDDS_URI?";
}

}  // namespace telltale
