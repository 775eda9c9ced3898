#include "telltale/client/exchange/disturbance.hpp"

#include "telltale/client/exchange/shortest.hpp"

namespace telltale {

std::string PrintDisturbanceCsv(std::span<const DisturbanceSample> samples) {
  std::string text = "time_s,sigma_u,sigma_v,sigma_r\n";
  for (const auto& [time_s, sigma] : samples) {
    text += Shortest(time_s) + ',' + Shortest(sigma.u) + ',' + Shortest(sigma.v) + ',' +
            Shortest(sigma.r) + '\n';
  }
  return text;
}

}  // namespace telltale
