#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs missing packages, then builds and runs all tests in a release build, and most of those without real scans
# again under AddressSanitizer and UndefinedBehaviorSanitizer. Prints ctest's summary, and its whole output after a
# failure.
# Real scans are read from $LISCO_TEST_DATA (default: ../shared/data); without them their tests are skipped.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/cmake/script_tools.sh"

"$root/cmake/install_dependencies.sh"
# 120 MB to download, for the tests of pages only.
"$root/cmake/install_dependencies.sh" chromium || echo "no Chromium: the tests of pages in a browser are skipped"

# run_tests NAME CTEST-OPTION... -- CMAKE-OPTION...
run_tests() {
  local name=$1 build=$root/build/$1
  shift
  local ctest_options=()
  while [ "$1" != -- ]; do
    ctest_options+=("$1")
    shift
  done
  shift
  build_quietly "$root" "$build" -DLISCO_WARNINGS_AS_ERRORS=ON "$@"
  echo "$name:"
  if ! (cd "$build" && ctest --output-on-failure -j "$(nproc)" "${ctest_options[@]}" >ctest.log 2>&1 </dev/null); then
    cat "$build/ctest.log" >&2
    return 1
  fi
  sed -n '/tests passed/,$p' "$build/ctest.log"
}

run_tests test -- -DCMAKE_BUILD_TYPE=Release -DLISCO_BUILD_BENCHMARKS=ON -DLISCO_BUILD_PYTHON=ON
# -O1 and line numbers only: half the time to compile. With sanitizers, GCC reports variables of the standard library as
# perhaps uninitialized. Left out: what builds or starts programs without sanitizers, and Python.
sanitizers="-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer"
run_tests test-asan-ubsan -LE 'real|package' -E '^lisco_(live_)?page_tests$' -- \
  -DCMAKE_BUILD_TYPE=RelWithDebInfo "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -g1 -DNDEBUG" \
  "-DCMAKE_CXX_FLAGS=$sanitizers -Wno-maybe-uninitialized"
