#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, builds the programs and clusters a simulated street by PCL and by Lisco, side by side.
# The results are in demo/ (or the folder given).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/cmake/script_tools.sh"

"$root/cmake/install_dependencies.sh"
build_quietly "$root" "$root/build/demo" -DCMAKE_BUILD_TYPE=Release -DLISCO_BUILD_TESTS=OFF
"$root/build/demo/apps/lisco_demo" "${1:-$root/demo}"
