#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Repeats the paper's evaluation: simulates its five scenes, times PCL, Lisco as published, a voxel grid and this
# library on them and on the real scans in $LISCO_TEST_DATA (default ../shared/data), and rewrites the tables and charts
# of doc/evaluation.md. Takes about half an hour. Options are passed on to lisco_compare.
#
# Measures on a quiet machine only: see wait_for_quiet in tools.sh. What was measured is kept in
# build/benchmarks/evaluation until the document is written, so that a run that was stopped goes on with the next scene;
# other programs or options start afresh. Fewer --runs than the document states (20, as in the paper) are refused, so
# that its figures do not become less accurate.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/benchmarks/tools.sh"
document=$root/doc/evaluation.md

# runs_stated FILE: the number of runs that a report states.
runs_stated() { sed -n 's/^\([0-9][0-9]*\) runs\{0,1\} of each in turn.*/\1/p' "$1" | head -n 1; }

# refuse_fewer_runs RUNS: exits if the document's tables are made of more.
refuse_fewer_runs() {
  local stated
  stated=$(runs_stated "$document")
  if [ "$1" -lt "${stated:-20}" ]; then
    echo "evaluation.sh: $document states ${stated:-20} runs of each; its tables are not replaced by those of $1" >&2
    exit 2
  fi
}

runs=20
for ((i = 1; i <= $#; ++i)); do
  case ${!i} in
    --runs) j=$((i + 1)) && runs=${!j:-} ;;
    --runs=*) runs=${!i#--runs=} ;;
  esac
done
if ! [[ $runs =~ ^[1-9][0-9]*$ ]]; then
  echo "evaluation.sh: --runs takes a number, 1 or more" >&2
  exit 2
fi
refuse_fewer_runs "$runs"

build_benchmarks
find_real_scans
images=$root/doc/images
out=$build/evaluation
key=$({ sha256sum "$build"/*.so "$build/apps/lisco_compare" "$build/apps/lisco_simulate" && echo "$data" "$@"; } |
  sha256sum)
if [ "$(cat "$out/key" 2>/dev/null)" != "$key" ]; then
  rm -rf "$out"
  mkdir -p "$out"
  echo "$key" >"$out/key"
fi
wait_for_quiet

simulate() { "$build/apps/lisco_simulate" "$@" >/dev/null; }
compare=("$build/apps/lisco_compare" --must-agree grid,lisco --max-seconds 1000 "$@")
published=pcl,pcl-octree,grid,paper,lisco

# measure NAME ARGUMENT...: compares, with the tables in $out/NAME.txt and NAME.csv and the charts in NAME/, unless that
# has been done.
measure() {
  local name=$1
  shift
  [ ! -f "$out/$name.csv" ] || return 0
  report "$out/$name.txt" "${compare[@]}" --csv "$out/$name.partial.csv" --plot "$out/$name" "$@"
  mv "$out/$name.partial.csv" "$out/$name.csv"
}

# The paper's scenes: returns (its table I), time over tolerance (its figure 7), objects found.
scenes=()
for scene in 1 2 3 4 5; do
  [ -f "$out/SCEN$scene.pcd" ] || simulate --scene "$scene" -o "$out/SCEN$scene.pcd"
  measure "scene$scene" --baselines "$published" --tolerance 0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9,1 --ground-z -1.6 \
    "$out/SCEN$scene.pcd"
  scenes+=("$out/scene$scene.csv")
done

# Time over the number of points (its figure 8): one scene, scanned in more and more steps.
mkdir -p "$out/steps"
for steps in 0282 0563 1125 2250 4500; do
  simulate --scene 3 --steps "$((10#$steps))" -o "$out/steps/SCEN3_$steps.pcd"
done
measure growth --baselines "$published" --tolerance 0.4 --ground-z -1.6 "$out/steps"

# Real scans (its figure 9), and what the paper's mask misses there.
measure real --baselines "$published" --tolerance 0.3,0.4,0.7 "${ground[@]}" "${rotating[@]}"
[ -f "$out/mask.csv" ] || { "$build/benchmarks/literal_mask" "${ground[@]}" "${rotating[@]}" >"$out/mask.partial" &&
  mv "$out/mask.partial" "$out/mask.csv"; }

# The document changes only after all measurements have succeeded.
for text in "$out"/{scene[1-5],growth,real}.txt; do refuse_fewer_runs "$(runs_stated "$text")"; done
{ head -n 3 "$out/scene1.txt" && echo "$noise"; } | code_block | replace_section "$document" "machine"
table counts "${scenes[@]}" | replace_section "$document" "counts"
table times "${scenes[@]}" | replace_section "$document" "scenes"
table scored "${scenes[@]}" | replace_section "$document" "objects"
table times "$out/growth.csv" | replace_section "$document" "points"
table times "$out/real.csv" | replace_section "$document" "real scans"
table mask "$out/mask.csv" | replace_section "$document" "mask"
for suffix in png svg; do
  for scene in 1 2 3 4 5; do
    cp "$out/scene$scene/time_over_tolerance_SCEN$scene.$suffix" "$images/evaluation_scen$scene.$suffix"
  done
  cp "$out/growth/time_over_points_0.4.$suffix" "$images/evaluation_points.$suffix"
  cp "$out/real/time_over_tolerance.$suffix" "$images/evaluation_real.$suffix"
done
rm -rf "$out"
