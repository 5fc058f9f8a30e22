#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# same_files.sh PROGRAM PROGRAM: both print the same for a small cloud and write the same files, at least two.
set -euo pipefail
export LC_ALL=C
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# A table with 12 boxes of three sizes on it, in the order of its rows.
awk 'BEGIN {
  for (y = 0; y < 90; ++y)
    for (x = 0; x < 120; ++x) {
      box = x % 30 < 20 && y % 30 < 18
      top = box ? 0.1 + 0.02 * (int(x / 30) % 3) : 0
      for (z = box ? 0.04 : 0; z <= top; z += 0.01)
        if (!box || z + 0.01 > top || x % 30 == 0 || y % 30 == 0)
          points[count++] = sprintf("%.4f %.4f %.4f %d", 0.011 * x + 0.003 * sin(7 * y), 0.011 * y + 0.003 * sin(5 * x),
                                    1 + z + 0.002 * sin(3 * x + 11 * y), x % 7)
    }
  print "VERSION .7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1"
  print "WIDTH " count "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " count "\nDATA ascii"
  for (i = 0; i < count; ++i) print points[i]
}' >"$folder/table.pcd"

for number in 1 2; do
  mkdir "$folder/$number"
  (cd "$folder/$number" && "${!number}" ../table.pcd >printed)
done
diff -r "$folder/1" "$folder/2"
files=$(find "$folder/1" -name '*.pcd' -o -name '*.txt' | wc -l)
[ "$files" -ge 2 ] || { echo "only $files files" >&2; exit 1; }
cat "$folder/1/printed"
