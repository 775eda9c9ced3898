#include "telltale/client/exchange/disturbance_csv.hpp"

#include "telltale/client/exchange/shortest_number.hpp"

namespace telltale {

std::string PrintDisturbanceCsv(std::span<const DisturbanceSample> samples) {
  std::string text = "time_s,sigma_u,sigma_v,sigma_r\n";
  for (const auto& [time_s, sigma] : samples) {
    text += ShortestNumber(time_s) + ',' + ShortestNumber(sigma.u) + ',' + ShortestNumber(sigma.v) +
            ',' + ShortestNumber(sigma.r) + '\n';
  }
  return text;
}

}  // namespace telltale
