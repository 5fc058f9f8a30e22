#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# tidy.sh [FILE...]: runs clang-tidy with the checks of .clang-tidy over files of the library and the programs (default:
# all), and fails on any finding. Needs clang-tidy.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/cmake/script_tools.sh"
cd "$root"

build=build/tidy
mkdir -p "$build"
quietly "$build/configure.log" cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DLISCO_BUILD_TESTS=OFF \
  -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_COMPILER=clang -DCMAKE_EXPORT_COMPILE_COMMANDS=ON
if [ $# -eq 0 ]; then
  mapfile -t files < <(find src apps -name '*.cpp' | sort)
else
  files=("$@")
fi
# Its counts of findings hidden in other libraries' headers are removed.
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 1 clang-tidy --quiet -p "$build" 2>&1 |
  { grep -vE '^[0-9]+ warnings? generated|^Suppressed |^Use -header-filter' || true; }
