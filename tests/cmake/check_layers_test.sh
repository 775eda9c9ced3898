#!/usr/bin/env bash
# cmake/check-layers passes on this project and fails, with file, line and rule, on each wrong include, and on
# folders that include each other in a circle.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
check=$root/cmake/check-layers
sandbox=$(mktemp -d)
trap 'rm -rf "$sandbox"' EXIT

fail() { echo "FAILED: $1" >&2; exit 1; }

# A small house with one header a layer.
build_house() {
  rm -rf "${sandbox:?}"/*
  mkdir -p "$sandbox"/{core/data,idl/codec,client/bus,service/ingest,tests/support,bench}
  echo '#include <vector>' > "$sandbox/core/data/window.hpp"
  echo '#include "telltale/core/data/window.hpp"' > "$sandbox/idl/codec/wire.hpp"
  printf '#include "telltale/idl/codec/wire.hpp"\n#include <dds/dds.h>\n' > "$sandbox/client/bus/reader.hpp"
  echo '#include "telltale/client/bus/reader.hpp"' > "$sandbox/service/ingest/ingest.hpp"
  echo '#include "telltale/core/data/window.hpp"' > "$sandbox/tests/support/matchers.hpp"
  mkdir -p "$sandbox/tests/blind/truth"
  echo '#include <CLI/CLI.hpp>' > "$sandbox/tests/blind/truth/dice.hpp"
  printf '#include <cmath>\n#include "dice.hpp"\n' > "$sandbox/tests/blind/truth/dice.cpp"
}

# rejects FILE INCLUDE RULE: adding the include as the file's second line is found out.
rejects() {
  build_house
  mkdir -p "$(dirname "$sandbox/$1")"
  printf '#pragma once\n#include %s\n' "$2" > "$sandbox/$1"
  local output status=0
  output=$("$check" "$sandbox" 2>&1) || status=$?
  ((status == 1)) || fail "$1 including $2 should be refused; exit $status, said: $output"
  grep -qF "$1:2: " <<< "$output" || fail "$1 including $2: no file and line in: $output"
  grep -qF "$3" <<< "$output" || fail "$1 including $2: rule '$3' is not in: $output"
}

"$check" "$root" || fail "this project breaks its own line"
build_house
"$check" "$sandbox" > /dev/null || fail "a house in order was refused"

rejects core/data/bad.hpp '"telltale/idl/codec/wire.hpp"' 'core may not see idl'
rejects core/data/bad.cpp '"telltale/client/bus/reader.hpp"' 'core may not see client'
rejects core/data/bad.cpp '<telltale/core/data/window.hpp>' 'own headers are included by ""'
rejects core/data/bad.hpp '"telltale/idl/proto/model.pb.h"' 'core may not see idl'
rejects core/data/bad.hpp '"telltale/idl/dds/telltale.h"' 'core may not see idl'
rejects core/bad.cpp '<dds/dds.h>' 'core knows no DDS'
rejects core/bad.cpp '<google/protobuf/message.h>' 'core knows no Protobuf'
rejects core/bad.cpp '<spdlog/spdlog.h>' 'core writes no log'
rejects core/bad.cpp '<fstream>' 'core knows no files'
rejects core/bad.cpp '<filesystem>' 'core knows no files'
rejects core/bad.cpp '<chrono>' 'core knows no clock'
rejects core/bad.hpp '<ceres/ceres.h>' "Ceres stays inside core's .cpp files"
rejects core/bad.cpp '"telltale/tests/support/matchers.hpp"' 'core may not see tests'
rejects core/bad.cpp '"../idl/codec/wire.hpp"' 'own headers are included as'
rejects core/bad.cpp '"nowhere.hpp"' 'own headers are included as'
rejects core/bad.cpp '"telltale/core/nowhere.hpp"' 'no such header'
rejects idl/codec/bad.hpp '"telltale/client/bus/reader.hpp"' 'idl may not see client'
rejects idl/codec/bad.hpp '"telltale/service/ingest/ingest.hpp"' 'idl may not see service'
rejects client/bus/bad.hpp '"telltale/service/ingest/ingest.hpp"' 'client may not see service'
rejects client/bus/bad.hpp '<SQLiteCpp/SQLiteCpp.h>' "the model store is the service's"
rejects client/bus/bad.hpp '<pqxx/pqxx>' "the store is the service's"
rejects service/ingest/bad.cpp '<dds/dds.h>' 'DDS is handled in client/bus'
rejects service/ingest/bad.cpp '"telltale/tests/support/matchers.hpp"' 'service may not see tests'
rejects tests/blind/truth/bad.cpp '"telltale/core/data/window.hpp"' 'only its own folder'
rejects tests/blind/truth/bad.cpp '"support/matchers.hpp"' 'only its own folder'
rejects tests/blind/truth/bad.cpp '"../../support/matchers.hpp"' 'only its own folder'
rejects tests/blind/truth/bad.cpp '<telltale/core/data/window.hpp>' 'nothing but the standard library'
rejects tests/blind/truth/bad.hpp '<Eigen/Dense>' 'nothing but the standard library'
rejects tests/blind/truth/bad.hpp '<gtest/gtest.h>' 'nothing but the standard library'

# include_chain FILE...: each includes the next.
include_chain() {
  for ((i = 1; i < $#; i++)); do
    mkdir -p "$(dirname "$sandbox/${!i}")"
    local next=$((i + 1))
    echo "#include \"telltale/${!next}\"" >> "$sandbox/${!i}"
  done
}

# A circle of three folders, though no file is on it twice.
build_house
touch "$sandbox/core/data/samples.hpp"
include_chain core/data/window.hpp core/validation/score.hpp core/effects/wind.hpp core/data/samples.hpp
output=$("$check" "$sandbox" 2>&1) && fail "a circle of folders passed"
grep -qE '^core/[a-z]+, core/[a-z]+, core/[a-z]+: these include each other in a circle$' <<< "$output" ||
  fail "the three folders are not named in: $output"

# The files of a folder with others below it stand for themselves: what the others share, and what uses them.
build_house
touch "$sandbox/core/constants.hpp"
include_chain core/diagnose.hpp core/data/window.hpp core/constants.hpp
"$check" "$sandbox" > /dev/null || fail "files beside folders were taken for one"

echo "check-layers finds every wrong include and circle"
