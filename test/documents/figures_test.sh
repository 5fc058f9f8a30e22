#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# figures_test.sh PYTHON FIGURES ROOT: figures.py finds a figure that is not its table's, a sentence that is gone and a
# statement that its table contradicts, and --write replaces the first.
set -euo pipefail
python=$1 figures=$2 root=$3
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
mkdir "$copy/doc"
cp "$root"/README.md "$copy"
cp "$root"/doc/*.md "$copy/doc"
document=$copy/doc/evaluation.md

# expect STATUS TEXT [OPTION]: the exit code, and what it prints.
expect() {
  local status=0 printed
  printed=$("$python" "$figures" ${3:-} "$copy" 2>&1) || status=$?
  if [ $status -ne "$1" ] || ! grep -q "$2" <<<"$printed"; then
    printf 'exit code %d, not %d, or not "%s":\n%s\n' $status "$1" "$2" "$printed" >&2
    exit 1
  fi
}

expect 0 "sentences agree with their tables"
sed -i 's/gives PCL.s clusters in all cases, [0-9.]* to/gives PCL'\''s clusters in all cases, 99999 to/' \
  "$document"
expect 1 "states 99999 where"
expect 0 "sentences agree" --write
if grep -q 99999 "$document"; then
  echo "--write left a wrong figure" >&2
  exit 1
fi
sed -i 's/It is faster than the paper.s algorithms/It is as fast as the algorithms/' "$document"
expect 1 "0 times in it, not once"
cp "$root/doc/evaluation.md" "$document"
sed -i '/^| SCEN1 | [0-9]* | 0.1 |/s/\(| [0-9.]* |\)$/| 0.5 |/' "$document"
expect 1 "no longer true" --write
