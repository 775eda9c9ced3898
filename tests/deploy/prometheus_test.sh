#!/usr/bin/env bash
# Alert rules by promtool, then a real Prometheus and Alertmanager on a real daemon.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
for program in promtool prometheus prometheus-alertmanager; do
  command -v "$program" > /dev/null && continue
  [[ ${CI-} != true ]] || { echo "prometheus_test: no $program" >&2; exit 1; }
  echo "prometheus_test: skipped, no $program (deploy/install-deps --tests)"
  exit 77
done
promtool check config "$root/deploy/prometheus/prometheus.yml"
promtool test rules "$root/tests/prometheus/rules_test.yml"
exec python3 "$root/tests/prometheus/scrape_test.py"
