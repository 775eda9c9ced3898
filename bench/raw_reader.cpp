// What it costs to take the telemetry of a fleet from the bus and to do nothing with it. Waits for
// the first sample, then counts for some seconds, and prints the samples taken, those of which the
// sequence numbers say that they are lost, and the processor seconds of this process.
//
//   raw_reader DOMAIN SECONDS

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <map>
#include <string>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"

namespace telltale {
namespace {

using Clock = std::chrono::steady_clock;

double ProcessorSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// The samples of all channels, and the gaps in their numbers.
struct Counts {
  std::uint64_t taken = 0;
  std::uint64_t lost = 0;
};

/// The reader of one channel.
template <class Wire>
class Channel {
 public:
  Channel(const Participant& participant, WaitSet& wait_set, Counts& counts)
      : reader_(participant), counts_(counts) {
    wait_set.Attach(reader_, [this] { reader_.Take([this](const Wire& wire) { Count(wire); }); });
  }

 private:
  void Count(const Wire& wire) {
    std::uint64_t& newest = newest_[wire.vehicle_id];
    if (newest > 0 && wire.sequence_number > newest) {
      counts_.lost += wire.sequence_number - newest - 1;
    }
    newest = wire.sequence_number;
    ++counts_.taken;
  }

  Reader<Wire> reader_;
  Counts& counts_;
  std::map<std::string, std::uint64_t> newest_;  ///< number by boat
};

void CountFor(std::uint32_t domain, std::chrono::duration<double> duration) {
  const Participant participant(domain);
  WaitSet wait_set(participant);
  Counts counts;
  Channel<telltale_wire_GnssFix> gnss(participant, wait_set, counts);
  Channel<telltale_wire_Heading> heading(participant, wait_set, counts);
  Channel<telltale_wire_Thrusters> thrusters(participant, wait_set, counts);
  while (counts.taken == 0) wait_set.Wait(std::chrono::seconds(1));
  const Counts before = counts;
  const double processor_s = ProcessorSeconds();
  const auto end = Clock::now() + std::chrono::ceil<Clock::duration>(duration);
  while (Clock::now() < end) wait_set.Wait(end - Clock::now());
  std::cout << counts.taken - before.taken << ' ' << counts.lost - before.lost << ' '
            << ProcessorSeconds() - processor_s << '\n';
}

}  // namespace
}  // namespace telltale

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: raw_reader DOMAIN SECONDS\n";
    return 2;
  }
  telltale::CountFor(static_cast<std::uint32_t>(std::atoi(argv[1])),
                     std::chrono::duration<double>(std::atof(argv[2])));
}
