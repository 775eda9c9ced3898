#pragma once

#include <vector>

#include <prometheus/collectable.h>
#include <prometheus/metric_family.h>

#include "telltale/service/monitoring/fleet_view.hpp"

namespace telltale {

/// The fleet and the daemon as Prometheus reads them, docs/reference/metrics.md.
class FleetMetrics : public prometheus::Collectable {
 public:
  explicit FleetMetrics(FleetView& view) : view_(view) {}

  std::vector<prometheus::MetricFamily> Collect() const override;

 private:
  FleetView& view_;
};

}  // namespace telltale
