#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Compares with PCL on the real scans in $LISCO_TEST_DATA (default ../shared/data), ground removed, and prints the table of
# doc/benchmarks.md. Options are handed on to against_pcl, for example --runs 20.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/cmake/script_tools.sh"
scans=${LISCO_TEST_DATA:-$root/../shared/data}/scans

"$root/cmake/install_dependencies.sh"
build_quietly "$root" "$root/build/benchmarks" -DCMAKE_BUILD_TYPE=Release -DLISCO_BUILD_BENCHMARKS=ON -DLISCO_BUILD_TESTS=OFF

# Heights below which the ground lies in each scan.
ground=(hdl32e_outdoor_0=-2.10 hdl32e_outdoor_1=-2.10 hdl64e_city_0=-1.60 hdl64e_city_1=-1.60 vlp16_close_0=-0.57
        vlp16_street_0=-1.99 vls128_street_0=-1.74 os1_128_outdoor_0=-1.81 os1_64_sparse_0=-0.48)
rotating=()
for scan in "$scans"/*.pcd; do
  [[ $scan == */rgbd_* ]] || rotating+=("$scan")
done
"$root/build/benchmarks/benchmarks/against_pcl" "${ground[@]/#/--ground=}" "$@" -- "${rotating[@]}"
# A camera's cloud is dense: PCL takes minutes at the tolerances above.
echo
"$root/build/benchmarks/benchmarks/against_pcl" --tolerance 0.01 0.02 0.05 0.1 "$@" -- "$scans"/rgbd_*.pcd
