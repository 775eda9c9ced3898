// Prints every published model with its bounds: subscribe [DOMAIN [SECONDS]], without SECONDS until
// Ctrl-C.
#include <chrono>
#include <cstdio>
#include <limits>
#include <string>

#include <telltale/client/bus/participant.hpp>
#include <telltale/client/fleet/subscriber.hpp>

void Print(const telltale::PublishedModel& model) {
  std::printf("%s, revision %llu\n", model.identification.vehicle_id.c_str(),
              static_cast<unsigned long long>(model.revision));
  for (const telltale::Coefficient& c : model.identification.coefficients) {
    std::printf("  %-10s %12.5g  in [%.5g, %.5g] %s at %g %%\n", c.symbol.c_str(), c.estimate,
                c.interval.lower, c.interval.upper, c.unit.c_str(), 100 * c.interval.level);
  }
}

int main(int argc, char** argv) try {
  if (argc > 1 && std::string(argv[1]) == "--help") {
    std::puts("Usage: subscribe [DOMAIN [SECONDS]]\nPrints every published model with its bounds.");
    return 0;
  }
  const telltale::Participant participant(argc > 1 ? std::stoul(argv[1]) : 0);
  telltale::ModelSubscriber models(participant, Print, [](const telltale::CodecError& error) {
    std::fprintf(stderr, "unreadable model: %s\n", error.Message().c_str());
  });
  const double seconds = argc > 2 ? std::stod(argv[2]) : std::numeric_limits<double>::infinity();
  const auto start = std::chrono::steady_clock::now();
  while (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() <
         seconds) {
    models.Wait(std::chrono::milliseconds(200));
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "subscribe: %s\n", error.what());
  return 1;
}
