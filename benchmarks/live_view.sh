#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Plays a capture at the sensor's speed by lisco_stream, in turns without --http and with viewers, and compares the
# latencies: medians of the rounds, in ms, and the median of the rounds' ratios. One viewer more never reads.
#
#   benchmarks/live_view.sh CAPTURE SENSOR [--viewers N] [--rounds N] [--tolerance M] [--publish]
#
# --publish rewrites the sensor's table in doc/view.md.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/benchmarks/tools.sh"

capture=${1:?a capture} sensor=${2:?its sensor}
shift 2
viewers=2 rounds=5 tolerance=0.4 publishes=
while [ $# -gt 0 ]; do
  case $1 in
    --viewers) viewers=${2:?} && shift 2 ;;
    --rounds) rounds=${2:?} && shift 2 ;;
    --tolerance) tolerance=${2:?} && shift 2 ;;
    --publish) publishes=yes && shift ;;
    *) echo "live_view.sh: unknown option $1" >&2 && exit 2 ;;
  esac
done
[ -n "${LISCO_PROGRAMS:-}" ] || build_benchmarks
programs=${LISCO_PROGRAMS:-$build/apps}
out=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$out"' EXIT

# view PORT READ...: opens a viewer, and gives what it receives to a command.
view() {
  local port=$1
  shift
  exec 3<>"/dev/tcp/127.0.0.1/$port"
  printf 'GET /live HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n%s\r\n%s\r\n\r\n' \
    'Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==' 'Sec-WebSocket-Version: 13' >&3
  exec "$@" <&3 >/dev/null  # so that a signal to the job reaches it
}

# play FILE OPTION...: the closing table
play() {
  local file=$1
  shift
  "$programs/lisco_stream" "$capture" --sensor "$sensor" --tolerance "$tolerance" --realtime --stats "$@" \
    >"$file" 2>"$out/err"
}

for ((round = 1; round <= rounds; ++round)); do
  play "$out/without.$round"
  : >"$out/err"
  play "$out/with.$round" --http 0 --viewers $((viewers + 1)) &
  player=$!
  until port=$(grep -o '127.0.0.1:[0-9]*' "$out/err"); do sleep 0.02; done
  watching=()
  for ((viewer = 0; viewer < viewers; ++viewer)); do
    view "${port#*:}" cat &
    watching+=($!)
  done
  view "${port#*:}" sleep 600 &
  watching+=($!)
  wait "$player"
  kill "${watching[@]}" 2>/dev/null || true
  wait "${watching[@]}" 2>/dev/null || true
done

# numbers KIND ROW: p50, p99 and max of a row of the closing table, a line for each round
numbers() {
  for ((round = 1; round <= rounds; ++round)); do
    sed -n "s/^  $2 *p50 \([0-9.]*\), p99 \([0-9.]*\), max \([0-9.]*\).*/\1 \2 \3/p" "$out/$1.$round"
  done
}
median() { sort -g | awk '{ value[NR] = $1 } END { print (value[int((NR + 1) / 2)] + value[int(NR / 2) + 1]) / 2 }'; }
rotations() { cat "$out/$1".* | sed -n 's/, after .*//; /^rotation /p' | sort | uniq | md5sum; }

{
  echo "$(basename "$capture"), $tolerance m, $rounds rounds, $viewers viewers and one that never reads; ms"
  [ "$(rotations without)" = "$(rotations with)" ] && echo "the rotations and their clusters are the same"
  printf '%-10s %-5s %10s %10s %8s\n' latency '' without with ratio
  for row in column rotation; do
    paste -d ' ' <(numbers without $row) <(numbers with $row) >"$out/both"
    column=0
    for what in p50 p99 max; do
      column=$((column + 1))
      values=()
      for value in "\$$column" "\$($column + 3)" "\$($column + 3) / \$$column"; do
        values+=("$(awk "{ print $value }" "$out/both" | median)")
      done
      printf '%-10s %-5s %10.5f %10.5f %8.2f\n' "$row" "$what" "${values[@]}"
    done
  done
} >"$out/table"
cat "$out/table"
[ -z "$publishes" ] || {
  code_block <"$out/table" | replace_section "$root/doc/view.md" "live view $sensor"
  "$root/test/documents/figures.py" --write "$root" doc/view.md
}
