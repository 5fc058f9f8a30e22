#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# others.sh LISCO_CLUSTER FOLDER: recordings written by @mcap/core are read by lisco_cluster, and those of lisco_cluster
# by @mcap/core and @foxglove/rosmsg2-serialization, which npm installs into the folder. Exit code 77, skipped: there is
# no npm, or no network. Bags written by ROS 1's own library are read, too, if it is installed (Debian's python3-rosbag
# and python3-sensor-msgs).
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cluster=$1
folder=$2
mkdir -p "$folder"
cd "$folder"

if ! command -v npm >npm.log 2>&1 || ! command -v node >>npm.log 2>&1; then
  echo "skipped: there is no npm (Debian's packages nodejs and npm)"
  exit 77
fi
if [ ! -d node_modules/@mcap/core ] || [ ! -d node_modules/zstd-codec ]; then
  [ -f package.json ] || echo '{"private": true}' >package.json
  if ! timeout 120 npm install --no-audit --no-fund @mcap/core@2 @foxglove/rosmsg@5 \
       @foxglove/rosmsg2-serialization@3 lz4js@0.2 zstd-codec@0.1 >npm.log 2>&1; then
    tail -n 5 npm.log
    echo "skipped: npm cannot install the packages (is there a network?)"
    exit 77
  fi
fi
cp "$here/others.mjs" .

rm -rf written results result.mcap
mkdir written
node others.mjs write written
expected=
for method in none lz4 zstd unchunked; do
  "$cluster" "written/$method.mcap" --topic /points -t 0.5 --min-size 3 >out.txt 2>err.txt
  said=$(grep -E '^  (read|scan|clusters|sizes)' out.txt)
  [ "$(grep -c '^  clusters  2 of' out.txt)" = 5 ] || { cat out.txt; echo "$method: not 2 clusters in all 5"; exit 1; }
  grep -q 'arranged by ring in 4 rows x 60 columns' out.txt || { cat out.txt; echo "$method: not arranged"; exit 1; }
  [ -z "$expected" ] || [ "$said" = "$expected" ] || { echo "$method gives other clusters"; exit 1; }
  expected=$said
done

# The lowest of four lasers is left out as ground: 60 returns.
"$cluster" written/lz4.mcap --topic /points -t 0.5 --min-size 3 --ground height:0.05 -o results --bag result.mcap \
  >out.txt 2>err.txt
[ "$(find results -name clusters.csv | wc -l)" = 5 ]
node others.mjs read result.mcap >read.txt
# The clusters' sizes and oriented boxes by the tables, and by the recording.
for table in $(find results -name clusters.csv | sort); do
  awk -F, 'NR > 1 { print $1, $2, 60, $13, $14, $15, $16, $17, $18, $19 }' "$table"
done >tables.txt
if ! grep -v '^#' read.txt | diff - tables.txt; then
  echo "the recording holds other clusters than the tables"
  exit 1
fi
[ "$(grep -c '^# sensor_msgs/msg/PointCloud2 lidar_link 240 points' read.txt)" = 5 ] ||
  { cat read.txt; echo "other clouds"; exit 1; }
# What was written can be clustered again.
"$cluster" result.mcap -t 0.5 --min-size 3 >out.txt 2>err.txt
[ "$(grep -c '^  clusters  2 of' out.txt)" = 5 ]
echo "5 clouds in 4 recordings, and 1 recording of results"

if ! python3 -c 'import rosbag, sensor_msgs.msg' >npm.log 2>&1; then
  echo "left out: bags of ROS 1's own library, which is not installed"
  exit 0
fi
python3 "$here/rosbag_writer.py" written
for method in none bz2 lz4; do
  "$cluster" "written/$method.bag" -t 0.5 --min-size 3 >out.txt 2>err.txt
  [ "$(grep -c '^  clusters  2 of' out.txt)" = 5 ] || { cat out.txt; echo "$method: not 2 clusters in all 5"; exit 1; }
done
echo "5 clouds in 3 bags of ROS 1"
