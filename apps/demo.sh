#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs missing dependencies, builds the programs, simulates a scan of a street, clusters it by PCL and by Lisco side
# by side, and draws it. The results are in demo/ (or the folder given); the last line names a page that shows the scene
# in a browser.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/cmake/script_tools.sh"

"$root/cmake/install_dependencies.sh"
build_quietly "$root" "$root/build/demo" -DCMAKE_BUILD_TYPE=Release -DLISCO_BUILD_TESTS=OFF
programs=$root/build/demo/apps
results=${1:-$root/demo}
mkdir -p "$results"
"$programs/lisco_simulate" --terrain road -o "$results/scan.pcd"
"$programs/lisco_cluster" "$results/scan.pcd" --tolerance 0.4 -o "$results"
"$programs/lisco_compare" "$results/scan.pcd" --tolerance 0.4 --ground slope --baselines pcl,grid,paper,lisco --runs 10
echo
echo "the scene, for a browser: $(realpath "$results/view.html")"
