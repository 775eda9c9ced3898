#!/usr/bin/env bash
# The HTTP API of a real daemon: tests/web/api_test.py.
set -euo pipefail
exec python3 "$(dirname "${BASH_SOURCE[0]}")/../web/api_test.py"
