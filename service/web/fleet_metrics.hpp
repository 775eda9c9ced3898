#pragma once

#include <functional>
#include <utility>
#include <vector>

#include <prometheus/collectable.h>
#include <prometheus/metric_family.h>

#include "telltale/service/monitoring/daemon_activity.hpp"
#include "telltale/service/monitoring/fleet_view.hpp"

namespace telltale {

/// The fleet and the daemon as Prometheus reads them, docs/reference/metrics.md.
class FleetMetrics : public prometheus::Collectable {
 public:
  FleetMetrics(FleetView& view, std::function<DaemonActivity()> activity)
      : view_(view), activity_(std::move(activity)) {}

  std::vector<prometheus::MetricFamily> Collect() const override;

 private:
  FleetView& view_;
  const std::function<DaemonActivity()> activity_;
};

}  // namespace telltale
