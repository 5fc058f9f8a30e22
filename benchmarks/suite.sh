#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs all benchmarks, or the given SECTIONs, and rewrites their tables in doc/benchmarks.md (those of real scans in
# README.md too). A section that fails, as by clusters that are not PCL's, keeps its old table; the others continue, and
# the suite exits with 1. Takes about 50 minutes on two cores, and begins when the machine is quiet (wait_for_quiet in
# tools.sh).
#
#   benchmarks/suite.sh [--runs N] [SECTION...]     --runs: timed runs of each baseline (default 5)
#
# Sections: real recordings layouts vehicle worst growth memory first_call threads stages; latency, whose tables and
# picture are in doc/streaming.md; ground, ground_real and ground_latency, whose tables are in doc/ground.md
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/benchmarks/tools.sh"

all_sections=(real recordings layouts vehicle worst growth memory first_call threads stages latency ground
  ground_real ground_latency)
runs=5
sections=()
while [ $# -gt 0 ]; do
  case $1 in
    --runs)
      runs=${2:?--runs needs a number}
      shift 2
      ;;
    *)
      if [[ " ${all_sections[*]} " != *" $1 "* ]]; then
        echo "suite.sh: there is no section '$1'; known are ${all_sections[*]}" >&2
        exit 2
      fi
      sections+=("$1")
      shift
      ;;
  esac
done
[ ${#sections[@]} -gt 0 ] || sections=("${all_sections[@]}")

build_benchmarks
find_real_scans
wait_for_quiet
export noise
echo "$noise"
document=$root/doc/benchmarks.md
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

simulate() { "$build/apps/lisco_simulate" "$@" >/dev/null; }

# compare NAME ARGUMENT...: compares, with the tables in $out/NAME.txt and NAME.csv.
compare() {
  local name=$1
  shift
  report "$out/$name.txt" "$build/apps/lisco_compare" --max-seconds 5 --csv "$out/$name.csv" "$@"
}

# publish TABLE SECTION NAME...: writes the results of `compare NAME` as a table of tables.awk, below the lines that
# name the machine.
publish() {
  local table=$1 section=$2 name=$3
  shift 2
  local csvs=("${@/#/$out/}")
  csvs=("${csvs[@]/%/.csv}")
  {
    head -n 3 "$out/$name.txt" && table "$table" "${csvs[@]}"
  } >"$out/$name.table" && code_block <"$out/$name.table" | replace_section "$document" "$section" &&
    cat "$out/$name.table"
}

# Each of these measures one section. They run as a condition, in which bash ignores `set -e`: hence each &&.

baselines=(--baselines "pcl,grid,lisco" --must-agree "grid,lisco")

measure_real() {
  "$root/benchmarks/real_scans.sh" --runs "$runs"
}

# measure_sets TABLE SETS: clouds as users have them; the table has the sets and what they are made of, not every case.
measure_sets() {
  local table=$1 sets=$2
  report "$out/$table.txt" "$build/benchmarks/recordings" --data "$data" --set "$sets" --summary --runs "$runs" &&
    code_block <"$out/$table.txt" | replace_section "$document" "$table" && cat "$out/$table.txt"
}
measure_recordings() { measure_sets recordings 1,2,3,4,5,6; }
measure_layouts() { measure_sets layouts 7; }

# The paper's streets from a sensor that sees its own vehicle.
simulate_vehicle() {
  [ ! -d "$out/vehicle" ] || return 0
  mkdir "$out/vehicle" || return 1
  local scene
  for scene in 1 2 3 4; do
    simulate --scene "$scene" --vehicle -o "$out/vehicle/scene${scene}_hdl64e.pcd" &&
      simulate --scene "$scene" --vehicle --sensor os1-128 -o "$out/vehicle/scene${scene}_os1-128.pcd" || return 1
  done
}

measure_vehicle() {
  simulate_vehicle &&
    compare vehicle "${baselines[@]}" --runs "$runs" --tolerance 0.1,0.3,0.4,0.7,1 --ground-z -1.6 "$out/vehicle" &&
    publish benchmarks "vehicle" vehicle
}

# Where most returns are neighbours of each other, PCL's time grows with their square: these scans have fewer steps.
simulate_worst() {
  [ ! -d "$out/worst" ] || return 0
  mkdir "$out/worst" || return 1
  local name gap
  for name in room random singletons poles; do
    simulate --case "$name" -o "$out/worst/$name.pcd" || return 1
  done
  for gap in 0.11 0.41 1.01; do  # just beyond each of the tolerances
    simulate --case sheets --gap "$gap" -o "$out/worst/sheets_$gap.pcd" || return 1
  done
  simulate --case wall --steps 450 -o "$out/worst/wall.pcd" &&
    simulate --case blocked --steps 225 -o "$out/worst/blocked.pcd"
}

measure_worst() {
  simulate_worst && compare worst "${baselines[@]}" --runs "$runs" --tolerance 0.1,0.4,1 "$out/worst" &&
    publish benchmarks "worst cases" worst
}

# Twice the lasers, twice the steps, and twice both. Only Lisco is timed, in many runs and two passes, so that a
# disturbance of some seconds does not look like growth.
measure_growth() {
  mkdir "$out/growth" || return 1
  local scene lasers steps size
  for scene in 3 5; do
    for lasers in 016 032 064 128; do
      simulate --scene "$scene" --lasers "$((10#$lasers))" --steps 2048 \
        -o "$out/growth/scene${scene}_lasers_$lasers.pcd" || return 1
    done
    for steps in 0512 1024 2048 4096; do
      simulate --scene "$scene" --lasers 64 --steps "$((10#$steps))" \
        -o "$out/growth/scene${scene}_steps_$steps.pcd" || return 1
    done
    for size in 1 2 4; do
      simulate --scene "$scene" --lasers $((32 * size)) --steps $((1024 * size)) \
        -o "$out/growth/scene${scene}_both_$size.pcd" || return 1
    done
  done
  local pass
  for pass in 1 2; do
    compare "growth$pass" --baselines lisco --runs $((20 * runs)) --tolerance 0.4 --ground-z -1.6 "$out/growth" ||
      return 1
  done
  publish growth "growth" growth1 growth2
}

measure_memory() {
  simulate_vehicle && simulate_worst &&
    report "$out/memory.txt" "$build/benchmarks/memory_use" --tolerance 0.1,0.4,1 "${ground[@]}" \
      --ground-z scene3_hdl64e=-1.6 --ground-z scene3_os1-128=-1.6 "${rotating[@]}" "$out"/vehicle/scene3_*.pcd &&
    report "$out/memory_worst.txt" "$build/benchmarks/memory_use" --tolerance 0.4 "$out/worst" &&
    { cat "$out/memory.txt" && tail -n +5 "$out/memory_worst.txt"; } >"$out/memory.table" &&
    code_block <"$out/memory.table" | replace_section "$document" "memory" && cat "$out/memory.table"
}

# The first call of a process, which finds neither memory nor code in place.
measure_first_call() {
  report "$out/first_call.txt" "$build/benchmarks/first_call" "${ground[@]}" "${rotating[@]}" &&
    code_block <"$out/first_call.txt" | replace_section "$document" "first call" && cat "$out/first_call.txt"
}

# measure_engine TABLE: a table of engine_stages, with four times the runs, which are short.
measure_engine() {
  local table=$1
  report "$out/$table.txt" "$build/benchmarks/engine_stages" --table "$table" --runs $((4 * runs)) \
    --tolerance 0.1,0.4,1 "${ground[@]}" "${rotating[@]}" &&
    code_block <"$out/$table.txt" | replace_section "$document" "$table" && cat "$out/$table.txt"
}

# Threads on real scans, and on clouds as users have them.
measure_threads() {
  measure_engine threads &&
    report "$out/gains.txt" "$build/benchmarks/recordings" --threads 2 --set 1,2,5 --eps 0.1,0.4,1 \
      --min-returns 30000 --summary &&
    code_block <"$out/gains.txt" | replace_section "$document" "threads of sets" && cat "$out/gains.txt"
}

sensors=(--sensor hdl32e=hdl32e --sensor hdl64e=hdl64e --sensor vlp16=vlp16 --sensor vls128=vls128 --sensor os1=os1)

# The captures, and column by column the scans of sensors without a capture.
measure_latency() {
  local scans=("$data"/scans/{hdl64e_city_0,vls128_street_0,os1_128_outdoor_0,os1_64_sparse_0}.pcd)
  local streams=("$data"/captures/*.pcap "${scans[@]}")
  local heights=("${ground[@]}" --ground-z hdl32e_outdoor=-2.10 --ground-z vlp16_close=-0.57
    --ground-z vlp16_street=-1.99 --ground-z vls128_street=-1.74)
  local latency=("$build/benchmarks/stream_latency" --runs "$runs" "${sensors[@]}" "${heights[@]}")
  local streaming=$root/doc/streaming.md
  report "$out/latency.txt" "${latency[@]}" --tolerance 0.1,0.4,1 "${streams[@]}" &&
    code_block <"$out/latency.txt" | replace_section "$streaming" "latency" && cat "$out/latency.txt" &&
    report "$out/windows.txt" "${latency[@]}" --table windows --tolerance 0.4 "$data"/scans/{hdl,os1,vl}*.pcd &&
    code_block <"$out/windows.txt" | replace_section "$streaming" "windows" && cat "$out/windows.txt" &&
    report "$out/timeline.txt" "${latency[@]}" --table timeline "$data/scans/vls128_street_0.pcd" &&
    gnuplot -e "data='$out/timeline.txt'; image='$root/doc/images/timeline.png'" "$root/benchmarks/timeline.gp"
}

# Ground filters against the truth of simulated drives.
measure_ground() {
  report "$out/ground.txt" "$build/benchmarks/ground_truth" &&
    replace_section "$root/doc/ground.md" "ground truth" <"$out/ground.txt" && cat "$out/ground.txt"
}

# The ground filter on real scans.
measure_ground_real() {
  report "$out/ground_real.txt" "$build/benchmarks/ground_real" "${rotating[@]}" &&
    code_block <"$out/ground_real.txt" | replace_section "$root/doc/ground.md" "ground real" &&
    cat "$out/ground_real.txt"
}

# A column's time with the ground filter.
measure_ground_latency() {
  local scans=("$data"/scans/{hdl32e_outdoor_0,hdl64e_city_0,hdl64e_kitti_0,os1_128_outdoor_0,os1_64_sparse_0}.pcd
    "$data"/scans/{vlp16_street_0,vls128_street_0}.pcd)
  report "$out/ground_latency.txt" "$build/benchmarks/ground_latency" --runs 20 "${sensors[@]}" "${scans[@]}" &&
    code_block <"$out/ground_latency.txt" | replace_section "$root/doc/ground.md" "ground latency" &&
    cat "$out/ground_latency.txt"
}

measure_stages() { measure_engine stages; }

# Another section takes a function measure_NAME here, NAME in `all_sections` and in the head of this file, and a section
# for the table in doc/benchmarks.md.

failed=()
for section in "${sections[@]}"; do
  "measure_$section" || failed+=("$section")
done
if [ ${#failed[@]} -gt 0 ]; then
  echo "failed, tables unchanged: ${failed[*]}" >&2
  exit 1
fi
