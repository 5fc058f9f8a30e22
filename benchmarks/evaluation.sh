#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Repeats the paper's evaluation: measures everything in doc/evaluation.md, section by section in the paper's order, and
# rewrites its tables, charts and figures in the text. About 40 minutes on a quiet machine.
#
#   benchmarks/evaluation.sh                   all; measures on a quiet machine only (wait_for_quiet in tools.sh)
#   benchmarks/evaluation.sh --counts          only what does not depend on time, on any machine: 8 minutes
#   benchmarks/evaluation.sh --into DIR        writes a copy of the document and its images in DIR/doc
#   benchmarks/evaluation.sh --runs N          of each method in turn (default 20, as in the paper)
#   benchmarks/evaluation.sh --drive N         rotations of the simulated drive (default 500; fewer with --into only)
#   benchmarks/evaluation.sh --afresh          measures again what has been measured
#
# Stopped, it goes on with the next step when started again: results are kept in build/benchmarks/evaluation, apart by
# --runs, and used as long as the programs and the data are the same. A second start therefore publishes only. Fewer
# runs than the document states are refused without --into, so that its figures do not become less accurate.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/benchmarks/tools.sh"

# runs_stated FILE: the number of runs that a report states.
runs_stated() { sed -n 's/^\([0-9][0-9]*\) runs\{0,1\} of each in turn.*/\1/p' "$1" | head -n 1; }

# refuse_fewer_runs RUNS: exits if the document's tables are made of more.
refuse_fewer_runs() {
  local stated
  stated=$(runs_stated "$root/doc/evaluation.md")
  if [ "$1" -lt "${stated:-20}" ]; then
    echo "evaluation.sh: the document states ${stated:-20} runs of each; its tables are not replaced by those of $1" >&2
    exit 2
  fi
}

runs=20 drive=500 counts_only=no afresh=no target=$root
while [ $# -gt 0 ]; do
  case $1 in
    --runs) runs=${2:-} && shift $(($# > 1 ? 2 : 1)) ;;
    --runs=*) runs=${1#--runs=} && shift ;;
    --drive) drive=${2:-} && shift $(($# > 1 ? 2 : 1)) ;;
    --counts) counts_only=yes && shift ;;
    --afresh) afresh=yes && shift ;;
    --into)
      [ -n "${2:-}" ] || { echo "evaluation.sh: --into takes a folder" >&2 && exit 2; }
      target=$2 && shift 2
      ;;
    --help) sed -n '3,17s/^# \{0,1\}//p' "$0" && exit 0 ;;
    *) echo "evaluation.sh: unknown argument '$1'; see --help" >&2 && exit 2 ;;
  esac
done
for number in "--runs $runs" "--drive $drive"; do
  [[ $number =~ \ [1-9][0-9]*$ ]] || { echo "evaluation.sh: ${number%% *} takes a number, 1 or more" >&2 && exit 2; }
done
if [ "$target" = "$root" ] && [ $counts_only = no ]; then
  refuse_fewer_runs "$runs"
  [ "$drive" -ge 500 ] || { echo "evaluation.sh: --drive $drive needs --into: the document has 500" >&2 && exit 2; }
fi

build_benchmarks libnanoflann-dev valgrind python3-open3d -- -DLISCO_BUILD_PYTHON=ON
find_real_scans
out=$build/evaluation/${runs}_runs_$drive
[ $counts_only = no ] || out=$build/evaluation/counts
key=$({ sha256sum "$build"/*.so "$build/apps/lisco_compare" "$build/apps/lisco_simulate" && echo "$data"; } | sha256sum)
if [ $afresh = yes ] || [ "$(cat "$out/key" 2>/dev/null)" != "$key" ]; then
  rm -rf "$out"
  mkdir -p "$out"
  git -C "$root" rev-parse --short HEAD >"$out/commit" 2>/dev/null || echo "unknown" >"$out/commit"
  echo "$key" >"$out/key"
fi
. "$root/benchmarks/evaluation_steps.sh"

began=$SECONDS
if [ $counts_only = no ]; then
  [ -f "$out/noise" ] || { wait_for_quiet && echo "$noise" >"$out/noise"; }
  for step in "${timed_steps[@]}"; do run_step "$step"; done
fi
for step in "${counted_steps[@]}"; do run_step "$step"; done
echo "measured in $(((SECONDS - began + 59) / 60)) minutes; publishing in $target/doc"

# The document changes only after all measurements have succeeded.
document=$target/doc/evaluation.md
images=$target/doc/images
if [ "$target" != "$root" ]; then
  mkdir -p "$images"
  cp "$root/doc/evaluation.md" "$document"
fi
publish_counts
[ $counts_only = yes ] || publish_times
"$root/test/documents/figures.py" --write "$target" doc/evaluation.md
