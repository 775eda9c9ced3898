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
  /// `serves`: whether this daemon serves, or stands by for another.
  FleetMetrics(FleetView& view, std::function<DaemonActivity()> activity,
               std::function<bool()> serves)
      : view_(view), activity_(std::move(activity)), serves_(std::move(serves)) {}

  std::vector<prometheus::MetricFamily> Collect() const override;

 private:
  FleetView& view_;
  const std::function<DaemonActivity()> activity_;
  const std::function<bool()> serves_;
};

}  // namespace telltale
