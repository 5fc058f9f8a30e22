#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Compares Lisco with PCL and the voxel grid on the real scans in $LISCO_TEST_DATA (default ../shared/data), ground
# removed, and rewrites the tables of doc/benchmarks.md and README.md. Options (default: --runs 5) are passed on to
# lisco_compare.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/benchmarks/tools.sh"
build_benchmarks
find_real_scans
wait_for_quiet
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

[ $# -gt 0 ] || set -- --runs 5
compare=("$build/apps/lisco_compare" --baselines pcl,grid,lisco --must-agree grid,lisco "$@")
report "$out/rotating.txt" "${compare[@]}" --tolerance 0.1,0.3,0.4,0.7,1 "${ground[@]}" --csv "$out/rotating.csv" \
  "${rotating[@]}"
# A camera's cloud is dense: PCL takes minutes at the tolerances above.
report "$out/camera.txt" "${compare[@]}" --tolerance 0.01,0.02,0.05,0.1 --csv "$out/camera.csv" "$data"/scans/rgbd_*.pcd

{
  head -n 3 "$out/rotating.txt"
  table benchmarks "$out/rotating.csv"
  echo
  table benchmarks "$out/camera.csv"
} >"$out/tables.txt"
code_block <"$out/tables.txt" | replace_section "$root/doc/benchmarks.md" "real scans"
table readme "$out/rotating.csv" | replace_section "$root/README.md" "real scans"
cat "$out/tables.txt"
