#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Measures the page of a scan in Chromium on a quiet machine: how long it takes to load, and how fast it turns. Exits
# with 1 if that is above 2 s or below 30 frames per second.
#
#   benchmarks/view.sh [--publish]
#
# --publish rewrites the figures in doc/view.md. LISCO_BUILD: a build with tests and benchmarks, which is used as it is;
# LISCO_WAIT=any measures on a busy machine, too.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/benchmarks/tools.sh"

publishes=
while [ $# -gt 0 ]; do
  case $1 in
    --publish) publishes=yes && shift ;;
    *) echo "view.sh: unknown option $1" >&2 && exit 2 ;;
  esac
done
if [ -n "${LISCO_BUILD:-}" ]; then
  build=$LISCO_BUILD
else
  "$root/cmake/install_dependencies.sh" chromium
  build_quietly "$root" "$build" -DCMAKE_BUILD_TYPE=Release -DLISCO_BUILD_BENCHMARKS=ON -DLISCO_BUILD_TESTS=ON
fi
wait_for_quiet
echo "$noise"
out=$(mktemp)
trap 'rm -f "$out"' EXIT
status=0
LISCO_WALL_TIME=1 "$build/test/view/lisco_page_tests" --gtest_filter='*LoadsAndTurns200000PointsInTime' >"$out" ||
  status=1
[ "$status" = 0 ] || grep -v '^\[' "$out" >&2
{
  echo "Chromium $(chromium --version 2>/dev/null | grep -oE '[0-9.]{5,}'),$(
    sed -n 's/^model name[^:]*://p' /proc/cpuinfo | head -n 1), $noise"
  sed -n '/^wall time/p; /^processor time/p' "$out"
} >"$out.lines"
cat "$out.lines"
[ -z "$publishes" ] || [ "$status" != 0 ] || code_block <"$out.lines" | replace_section "$root/doc/view.md" "page speed"
rm -f "$out.lines"
exit "$status"
