#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# run.sh BODY RUNS [SEED]: runs that many inputs (default seed: 1) on engine, stream, ground, readers, recordings,
# packets, hesai, ouster or http, beginning with those of test/fuzz/corpus. Prints their number; stops at the first that
# fails and prints its file.
# LISCO_FUZZER_SANITIZERS=address,undefined checks memory as well, and takes several times as long. Needs clang.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$root/cmake/script_tools.sh"
body=${1:?a body: engine, stream, ground, readers, recordings, packets, hesai, ouster or http}
runs=${2:?how many inputs}
seed=${3:-1}

sanitizers=${LISCO_FUZZER_SANITIZERS:-}
build=$root/build/fuzzers${sanitizers:+-${sanitizers//,/-}}
build_quietly "$root" "$build" --target "lisco_fuzz_$body" -- -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_COMPILER=clang -DLISCO_BUILD_FUZZERS=ON -DLISCO_BUILD_TESTS=OFF \
  "-DLISCO_FUZZER_SANITIZERS=$sanitizers"
found=$build/found/$body
log=$build/$body.$seed.log
mkdir -p "$found"
# Waiting threads yield the processor; inputs may be long from the beginning on.
if ! OMP_WAIT_POLICY=passive KMP_BLOCKTIME=0 "$build/test/fuzz/lisco_fuzz_$body" -runs="$runs" -seed="$seed" \
  -entropic=0 -len_control=0 -timeout=60 -rss_limit_mb=4096 -print_final_stats=1 -artifact_prefix="$build/$body-" \
  "$found" "$root/test/fuzz/corpus/$body" >"$log" 2>&1; then
  tail -n 40 "$log" >&2
  exit 1
fi
grep -E '^stat::(number_of_executed_units|average_exec_per_sec)' "$log"
