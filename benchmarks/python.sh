#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Measures the Python package on real scans: its overhead over the C++ call, Lisco against the DBSCAN of scikit-learn
# and Open3D, and the archives' rate with one worker and two. Begins when the machine is quiet; takes about 25 minutes.
#
#   benchmarks/python.sh [--publish] [SECTION...]     sections: overhead dbscan archive (default: all)
#
# --publish rewrites the tables in doc/python.md and doc/archives.md. LISCO_BUILD: a build with benchmarks and Python,
# which is used as it is; LISCO_WAIT=any measures on a busy machine, too.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/benchmarks/tools.sh"

publishes=
sections=()
while [ $# -gt 0 ]; do
  case $1 in
    --publish) publishes=yes ;;
    overhead | dbscan | archive) sections+=("$1") ;;
    *) echo "python.sh: there is no option or section '$1'" >&2 && exit 2 ;;
  esac
  shift
done
[ ${#sections[@]} -gt 0 ] || sections=(overhead dbscan archive)

"$root/cmake/install_dependencies.sh" python3-open3d
if [ -n "${LISCO_BUILD:-}" ]; then
  build=$LISCO_BUILD
else
  build_quietly "$root" "$build" -DCMAKE_BUILD_TYPE=Release -DLISCO_BUILD_BENCHMARKS=ON -DLISCO_BUILD_PYTHON=ON \
    -DLISCO_BUILD_TESTS=OFF
fi
find_real_scans
wait_for_quiet
echo "$noise"
export PYTHONPATH=$build/python
python=$(sed -n 's/^_\?Python3_EXECUTABLE:[A-Z]*=//p' "$build/CMakeCache.txt" | head -n 1)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

measure_overhead() {
  "${python:-python3}" "$root/python/benchmarks/overhead.py" "$build/python/python_overhead" \
    "$data"/scans/{vlp16_street_0,os1_128_outdoor_0,vls128_street_0}.pcd
}

measure_dbscan() {
  "${python:-python3}" "$root/python/benchmarks/dbscan.py" --runs 3 "$data"/scans/vlp16_street_0.pcd=-1.99 \
    "$data"/scans/hdl32e_outdoor_0.pcd=-2.10 "$data"/scans/os1_128_outdoor_0.pcd=-1.81 \
    "$data"/scans/vls128_street_0.pcd=-1.74
}

measure_archive() {
  "${python:-python3}" "$root/python/benchmarks/archive.py" "$data"/scans/vls128_street_0.pcd --repeat 1000 \
    --tolerance 0.4 --remove-ground --piece 10 --runs 3
}

document_of() {
  case $1 in
    archive) echo "$root/doc/archives.md" ;;
    *) echo "$root/doc/python.md" ;;
  esac
}

status=0
for section in "${sections[@]}"; do
  if ! "measure_$section" >"$out/$section"; then
    echo "python.sh: section $section failed" >&2
    status=1
    continue
  fi
  cat "$out/$section"
  [ -z "$publishes" ] || { echo "On $(sed -n 's/^model name[^:]*: //p;' /proc/cpuinfo | head -n 1), $noise:" && echo &&
    cat "$out/$section"; } | replace_section "$(document_of "$section")" "$section"
done
exit "$status"
