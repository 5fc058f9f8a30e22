#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the pictures of doc/gallery.md in doc/images/gallery, from $LISCO_TEST_DATA (default: ../shared/data): clusters
# a scan of each sensor, opens its view.html in Chromium, and saves what the page shows, without its panel, as a PNG of
# 48 colours. Takes some minutes.
#
#   doc/images/gallery.sh [NAME...]     only the pictures of these names
#
# Needs chromium and python3-pil.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$root/cmake/script_tools.sh"
data=${LISCO_TEST_DATA:-$root/../shared/data}
build=${LISCO_BUILD:-$root/build/demo}
[ -x "$build/apps/lisco_cluster" ] || build_quietly "$root" "$build" -DCMAKE_BUILD_TYPE=Release -DLISCO_BUILD_TESTS=OFF
out=$root/doc/images/gallery
mkdir -p "$out"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# picture NAME ARGUMENT...: of the first scan, or of the second rotation of a recording.
picture() {
  local name=$1 pages page
  shift
  [ ${#wanted[@]} -eq 0 ] || [[ " ${wanted[*]} " == *" $name "* ]] || return 0
  (cd "$data" && "$build/apps/lisco_cluster" "$@" --write view -o "$work/$name") >/dev/null
  pages=("$work/$name/view.html")
  [ -z "$(find "$work/$name" -mindepth 2 -name view.html)" ] || pages=("$work/$name"/*/view.html)
  page=${pages[1]:-${pages[0]}}
  chromium --headless --no-sandbox --hide-scrollbars --window-size=1020,440 --virtual-time-budget=4000 \
    --user-data-dir="$work/chromium" --screenshot="$work/$name.png" "file://$page" >/dev/null 2>&1
  /usr/bin/python3 - "$work/$name.png" "$out/$name.png" <<'PYTHON'
import sys
from PIL import Image
picture = Image.open(sys.argv[1]).convert("RGB").crop((0, 0, 700, 440))
picture.quantize(48, dither=Image.Dither.NONE).save(sys.argv[2], optimize=True)
PYTHON
  echo "$name $(stat -c %s "$out/$name.png") bytes"
}

wanted=("$@")
picture vlp16_street scans/vlp16_street_0.pcd --tolerance 0.4
picture vlp16_close scans/vlp16_close_0.pcd --tolerance 0.3
picture hdl32e_outdoor scans/hdl32e_outdoor_0.pcd --tolerance 0.4
picture hdl64e_city scans/hdl64e_city_0.pcd --tolerance 0.4
picture vls128_street scans/vls128_street_0.pcd --tolerance 0.4
picture vls128_deskewed scans/vls128_deskewed_0.pcd --tolerance 0.4
picture os1_128_outdoor scans/os1_128_outdoor_0.pcd --tolerance 0.4
picture os1_64_sparse scans/os1_64_sparse_0.pcd --tolerance 0.4
picture ring64 scans/ring64_zeros.pcd --tolerance 0.4
picture vlp32c bags/vlp32c.db3 --sensor vlp32c --tolerance 0.5
picture pandar40p bags/pandar40p.db3 --sensor pandar40p --tolerance 0.5
picture pandarqt64 bags/pandarqt64.db3 --sensor pandarqt64 --tolerance 0.4
picture pandarxt16 bags/pandarxt16.db3 --sensor pandarxt16 --tolerance 0.5
picture pandarxt32 bags/pandarxt32.db3 --sensor pandarxt32 --tolerance 0.5
picture os0_32 ouster/OS-0-32-U1_v2.2.0_1024x10.pcap --sensor ouster --metadata ouster/OS-0-32-U1_v2.2.0_1024x10.json \
  --tolerance 0.3
picture os1_32 ouster/OS-1-32-G_v2.1.1_1024x10.pcap --sensor ouster --metadata ouster/OS-1-32-G_v2.1.1_1024x10.json \
  --tolerance 0.4
picture rgbd_office scans/rgbd_office.pcd --tolerance 0.04 --ground none
picture rgbd_table scans/rgbd_table_0.pcd --tolerance 0.005 --ground none
picture airborne scans/airborne_utm_0.pcd --tolerance 5
