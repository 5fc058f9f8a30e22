#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# tutorial.sh LISCO_SIMULATE CLUSTER_EXTRACTION: the commands of doc/tutorial.md, in an empty folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"$1" --scene 1 -o scan.pcd >/dev/null
"$2" scan.pcd
for cloud in $("$2" scan.pcd | sed -n 's/^\(cloud_cluster_.*\.pcd\):.*/\1/p'); do
  [ -s "$cloud" ] || { echo "no $cloud"; exit 1; }
done
