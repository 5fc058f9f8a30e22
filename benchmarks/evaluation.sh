#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Repeats the paper's evaluation: simulates its five scenes, times PCL, Lisco as published, a voxel grid and this
# library on them and on the real scans in $LISCO_TEST_DATA (default ../shared/data), and rewrites the tables and charts
# of doc/evaluation.md. Takes about twenty minutes. Options are passed on to lisco_compare. Fewer --runs than the
# document states (20, as in the paper) are refused, so that its figures do not become less accurate.
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
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

simulate() { "$build/apps/lisco_simulate" "$@" >/dev/null; }
compare=("$build/apps/lisco_compare" --baselines pcl,pcl-octree,grid,paper,lisco --must-agree grid,lisco
  --max-seconds 1000 "$@")

# The paper's scenes: returns (its table I), time over tolerance (its figure 7), objects found.
mkdir "$out/scenes"
for scene in 1 2 3 4 5; do simulate --scene "$scene" -o "$out/scenes/SCEN$scene.pcd"; done
report "$out/scenes.txt" "${compare[@]}" --tolerance 0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9,1 --ground-z -1.6 \
  --csv "$out/scenes.csv" --plot "$out/scene_charts" "$out/scenes"

# Time over the number of points (its figure 8): one scene, scanned in more and more steps.
mkdir "$out/growth"
for steps in 0282 0563 1125 2250 4500; do
  simulate --scene 3 --steps "$((10#$steps))" -o "$out/growth/SCEN3_$steps.pcd"
done
report "$out/growth.txt" "${compare[@]}" --tolerance 0.4 --ground-z -1.6 --csv "$out/growth.csv" \
  --plot "$out/growth_charts" "$out/growth"

# Real scans (its figure 9), and what the paper's mask misses there.
report "$out/real.txt" "${compare[@]}" --tolerance 0.3,0.4,0.7 "${ground[@]}" --csv "$out/real.csv" \
  --plot "$out/real_charts" "${rotating[@]}"
"$build/benchmarks/literal_mask" "${ground[@]}" "${rotating[@]}" >"$out/mask.csv"

# The document changes only after all measurements have succeeded.
for text in "$out"/{scenes,growth,real}.txt; do refuse_fewer_runs "$(runs_stated "$text")"; done
head -n 3 "$out/scenes.txt" | code_block | replace_section "$document" "machine"
table counts "$out/scenes.csv" | replace_section "$document" "counts"
table times "$out/scenes.csv" | replace_section "$document" "scenes"
table scored "$out/scenes.csv" | replace_section "$document" "objects"
table times "$out/growth.csv" | replace_section "$document" "points"
table times "$out/real.csv" | replace_section "$document" "real scans"
table mask "$out/mask.csv" | replace_section "$document" "mask"
for scene in 1 2 3 4 5; do
  cp "$out/scene_charts/time_over_tolerance_SCEN$scene.png" "$images/evaluation_scen$scene.png"
done
cp "$out/growth_charts/time_over_points_0.4.png" "$images/evaluation_points.png"
cp "$out/real_charts/time_over_tolerance.png" "$images/evaluation_real.png"
