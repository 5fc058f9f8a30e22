# SPDX-License-Identifier: BSD-3-Clause
# The steps of evaluation.sh, which sources this: what is measured, into $out, and where it is published. A step writes
# its files aside and moves them into place at its end; a step whose files are there is done.
# shellcheck shell=bash

timed_steps=(scene1 scene2 scene3 scene4 scene5 points real drive rivals columns threads dbscan)
counted_steps=(mask subclusters merges boards table pictures)
[ "$counts_only" = no ] || counted_steps=(scene1 scene2 scene3 scene4 scene5 real "${counted_steps[@]}")

# run_step NAME: what measure_NAME does in the folder $work becomes $out/NAME.
run_step() {
  local name=$1 begin=$SECONDS
  [ ! -d "$out/$name" ] || return 0
  work=$out/$name.partial
  rm -rf "$work"
  mkdir -p "$work"
  case $name in
    scene[1-5]) measure_scene "${name#scene}" ;;
    *) "measure_$name" ;;
  esac
  mv "$work" "$out/$name"
  echo "$name: $((SECONDS - begin)) s"
}

simulate() { "$build/apps/lisco_simulate" "$@" >/dev/null; }

# scene N: makes scene N, unless it is there, and sets `scan` to its file.
scene() {
  scan=$out/scenes/SCEN$1.pcd
  mkdir -p "$out/scenes"
  [ -f "$scan" ] || simulate --scene "$1" -o "$scan"
}

# compare ARGUMENT...: PCL and others side by side, tables in $work/all.txt and all.csv; for --counts without times.
# $most_runs and $most_seconds may be set for it.
compare() {
  local times=(--runs "${most_runs:-$runs}" --max-seconds "${most_seconds:-1000}")
  [ "$counts_only" = no ] || times=(--check-only)
  report "$work/all.txt" "$build/apps/lisco_compare" --must-agree grid,lisco "${times[@]}" --csv "$work/all.csv" "$@" \
    2>"$work/notes.txt" || { cat "$work/notes.txt" >&2 && return 1; }
}
plot() { [ "$counts_only" = yes ] || echo "--plot $work/charts"; }

# Figure 7, and table I and the objects.
measure_scene() {
  scene "$1"
  # shellcheck disable=SC2046
  compare --baselines pcl,pcl-octree,grid,paper,lisco --tolerance 0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9,1 \
    --ground-z -1.6 $(plot) "$scan"
}

# Figure 8: one scene, scanned in more and more steps.
measure_points() {
  local steps
  mkdir "$work/scans"
  for steps in 0282 0563 1125 2250 4500; do
    simulate --scene 3 --steps "$((10#$steps))" -o "$work/scans/SCEN3_$steps.pcd"
  done
  compare --baselines pcl,pcl-octree,grid,paper,lisco --tolerance 0.4 --ground-z -1.6 --plot "$work/charts" \
    "$work/scans"
}

# Figure 9: each rotation of all recordings, and the scans that are of no recording here, once.
rotations=(--no-details --return strongest --ground slope --baselines "pcl,grid,paper,lisco"
  --tolerance "0.3,0.4,0.7")
measure_real() {
  local ouster=("$data"/ouster/OS-{0-32-U1,1-32-G,1-64,1-128_v}*.pcap)
  most_runs=1 compare "${rotations[@]}" "$data"/captures/*.pcap "$data"/bags/*.db3 "${ouster[@]}" \
    "$data"/scans/{hdl64e_city_0,hdl64e_city_1,hdl64e_kitti_0,ring64_zeros,vls128_deskewed_0}.pcd
}

# The same on a simulated drive.
measure_drive() {
  simulate --terrain road --speed 10 --rotations "$drive" -o "$work/rotations"
  most_runs=1 compare "${rotations[@]}" "$work"/rotations/rotation_*.pcd
  rm -r "$work/rotations"
}

# All methods, the slow ones fewer times.
measure_rivals() {
  local n scans=()
  for n in 1 2 3 4 5; do scene $n && scans+=("$scan"); done
  most_seconds=20 compare --baselines pcl,pcl-tutorial,pcl-octree,flann,nanoflann,grid,paper,lisco \
    --tolerance 0.1,0.4,1 --ground-z -1.6 --plot "$work/charts" "${scans[@]}"
}

# From the first to the last column, and from the last column to the clusters.
measure_columns() {
  local latency=("$build/benchmarks/stream_latency" "${ground[@]}" --ground-z hdl32e_outdoor=-2.10
    --ground-z vlp16_close=-0.57 --ground-z vlp16_street=-1.99 --ground-z vls128_street=-1.74
    --sensor hdl32e=hdl32e --sensor hdl64e=hdl64e --sensor vlp16=vlp16 --sensor vls128=vls128 --sensor os1=os1)
  report "$work/all.txt" "${latency[@]}" --runs $(((runs + 3) / 4)) --tolerance 0.3,0.4,0.7 "$data"/captures/*.pcap \
    "$data"/scans/{hdl64e_city_0,os1_128_outdoor_0}.pcd
  report "$work/timeline.txt" "${latency[@]}" --runs "$runs" --table timeline "$data/scans/vls128_street_0.pcd"
  gnuplot -e "data='$work/timeline.txt'; image='$work/timeline.png'" "$root/benchmarks/timeline.gp"
}

measure_threads() {
  scene 3
  report "$work/all.txt" "$build/benchmarks/engine_stages" --table threads --runs $((2 * runs)) --tolerance 0.4 \
    "${ground[@]}" --ground-z SCEN3=-1.6 "$scan" \
    "$data"/scans/{hdl64e_kitti_0,os1_128_outdoor_0,vls128_street_0}.pcd
}

measure_dbscan() {
  scene 1
  PYTHONPATH=$build/python /usr/bin/python3 "$root/python/benchmarks/dbscan.py" --runs 3 --limit 10 \
    --tolerance 0.1 0.4 1 --  "$scan=-1.6" "$data/scans/vlp16_street_0.pcd=-1.99" >"$work/all.txt"
}

# What the paper's mask misses, and why; its picture for two sensors.
measure_mask() {
  "$build/benchmarks/literal_mask" "${ground[@]}" "${rotating[@]}" >"$work/all.csv"
  local name
  for name in hdl64e_city_0 os1_128_outdoor_0; do
    "$build/benchmarks/mask_cells" "${ground[@]}" "$data/scans/$name.pcd" >"$work/$name.txt"
  done
  gnuplot -e "first='$work/hdl64e_city_0.txt'; second='$work/os1_128_outdoor_0.txt'; stem='$work/mask'" \
    "$root/benchmarks/mask.gp" 2>"$work/gnuplot.log" || { cat "$work/gnuplot.log" >&2 && return 1; }
}

# scenes_and_scans: sets `scans` to three scenes and two scans, `heights` to the options of their ground.
scenes_and_scans() {
  local n
  scans=() heights=("${ground[@]}")
  for n in 1 3 5; do scene $n && scans+=("$scan") && heights+=(--ground-z "SCEN$n=-1.6"); done
  scans+=("$data"/scans/{hdl64e_city_0,hdl32e_outdoor_0}.pcd)
}
measure_subclusters() {
  scenes_and_scans
  "$build/benchmarks/growing_subclusters" -o "$work" "${heights[@]}" "${scans[@]}" >"$work/all.csv"
}
measure_merges() {
  scenes_and_scans
  "$build/benchmarks/merge_cost" "${heights[@]}" "${scans[@]}" >"$work/all.csv"
}

# Instructions of one extraction: those of two less those of one, so that memory is there.
instructions_of() {
  local count="$build/benchmarks/extractions" total=()
  local n
  for n in 1 2; do
    total+=("$(valgrind --tool=callgrind --callgrind-out-file=/dev/null "$count" "$@" --count $n 2>&1 >"$work/line" |
      sed -n 's/.*Collected : *//p')")
  done
  echo "$((total[1] - total[0])),$(cat "$work/line")" >>"$work/all.txt"
}
measure_boards() {
  local method files
  scene 3
  files=("$scan" "$data/scans/vlp16_street_0.pcd")
  for file in "${files[@]}"; do
    for method in pcl grid lisco; do  # 128 bits, as NEON's
      instructions_of --baseline $method --simd SSE4 "${ground[@]}" --ground-z SCEN3=-1.6 "$file"
    done
  done
}

# An annotated scan of a camera, without its table.
measure_table() {
  report "$work/all.txt" "$build/apps/lisco_compare" --check-only --baselines pcl,lisco --ignore-label 1 \
    --tolerance 0.002,0.003,0.005,0.01,0.02,0.05 --csv "$work/all.csv" "$data/scans/rgbd_table_0.pcd"
}

# Figure 6.
measure_pictures() {
  local n
  for n in 1 2 3 4 5; do
    scene $n
    "$build/apps/lisco_cluster" "$scan" --tolerance 0.4 --ground-z -1.6 --write pictures -o "$work/$n" >/dev/null
  done
}

tables() { "$root/benchmarks/evaluation_tables.py" "$@"; }

publish_counts() {
  local n scenes=("$out"/scene[1-5]/all.csv)
  cp "$out/mask/mask.png" "$images/evaluation_mask.png"
  cp "$out/mask/mask.svg" "$images/evaluation_mask.svg"
  table mask "$out/mask/all.csv" | replace_section "$document" "mask"
  tables subclusters "$out/subclusters/all.csv" | replace_section "$document" "subclusters"
  cp "$out/subclusters/subclusters.png" "$images/evaluation_subclusters.png"
  cp "$out/subclusters/subclusters.svg" "$images/evaluation_subclusters.svg"
  cp "$out/subclusters/SCEN3_half.png" "$images/evaluation_half.png"
  cp "$out/subclusters/SCEN3_whole.png" "$images/evaluation_whole.png"
  tables merges "$out/merges/all.csv" | replace_section "$document" "merges"
  tables identical "${scenes[@]}" "$out/real/all.csv" | replace_section "$document" "identical"
  table counts "${scenes[@]}" | replace_section "$document" "counts"
  for n in 1 2 3 4 5; do cp "$out/pictures/$n/top_view.png" "$images/evaluation_top$n.png"; done
  table scored "${scenes[@]}" | replace_section "$document" "objects"
  table scored "$out/table/all.csv" | replace_section "$document" "table objects"
  tables returns "$out/real/all.csv" | replace_section "$document" "returns"
  tables boards "$out/boards/all.txt" | replace_section "$document" "boards"
}

# publish_rotations NAME TITLE SECTION: the chart and the table of a step over rotations.
publish_rotations() {
  {
    echo "![Time over tolerance and returns, $2](images/evaluation_$1.png)"
    echo
    tables rotations "$out/$1/all.csv"
  } | replace_section "$document" "$3"
  tables rotations-data "$out/$1/all.csv" >"$out/$1/data.txt"
  gnuplot -e "data='$out/$1/data.txt'; stem='$images/evaluation_$1'; what='$2'" "$root/benchmarks/rotations.gp" \
    2>"$out/$1/gnuplot.log" || { cat "$out/$1/gnuplot.log" >&2 && return 1; }
}

publish_times() {
  local n suffix scenes=("$out"/scene[1-5]/all.csv)
  { head -n 3 "$out/scene1/all.txt" && cat "$out/noise"; } >"$out/machine"
  { echo "Measured until $(date -r "$out/dbscan" +%F), at commit $(cat "$out/commit"):" && echo &&
      code_block <"$out/machine"; } | replace_section "$document" "machine"
  table times "${scenes[@]}" | replace_section "$document" "scenes"
  {
    echo "![All methods on the scenes](images/evaluation_rivals.png)"
    echo
    tables rivals "$out/rivals/all.csv"
  } | replace_section "$document" "rivals"
  replace_section "$document" "dbscan" <"$out/dbscan/all.txt"
  table times "$out/points/all.csv" | replace_section "$document" "points"
  publish_rotations real "real rotations" "real scans"
  publish_rotations drive "simulated drive" "drive"
  code_block <"$out/columns/all.txt" | replace_section "$document" "columns"
  cp "$out/columns/timeline.png" "$images/timeline.png"
  code_block <"$out/threads/all.txt" | replace_section "$document" "threads"
  for suffix in png svg; do
    for n in 1 2 3 4 5; do
      cp "$out/scene$n/charts/time_over_tolerance_SCEN$n.$suffix" "$images/evaluation_scen$n.$suffix"
    done
    cp "$out/points/charts/time_over_points_0.4.$suffix" "$images/evaluation_points.$suffix"
    cp "$out/rivals/charts/time_over_tolerance.$suffix" "$images/evaluation_rivals.$suffix"
  done
}
