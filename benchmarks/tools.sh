# SPDX-License-Identifier: BSD-3-Clause
# Shared by the scripts here, which source it after setting `root`.
. "$root/cmake/script_tools.sh"

data=${LISCO_TEST_DATA:-$root/../shared/data}
build=${LISCO_BUILD:-$root/build/benchmarks}

# build_benchmarks [PACKAGE... [-- CMAKE-OPTION...]]: installs missing packages, and builds the programs, unless
# $LISCO_BUILD names a folder where they have been built.
build_benchmarks() {
  [ -z "${LISCO_BUILD:-}" ] || return 0
  local packages=()
  while [ $# -gt 0 ] && [ "$1" != -- ]; do packages+=("$1") && shift; done
  "$root/cmake/install_dependencies.sh" "${packages[@]}"
  build_quietly "$root" "$build" -DCMAKE_BUILD_TYPE=Release -DLISCO_BUILD_BENCHMARKS=ON -DLISCO_BUILD_TESTS=OFF \
    "${@:2}"
}

# wait_for_quiet: waits until the machine is quiet, up to $LISCO_WAIT minutes (default 60), and sets `noise` to a line
# that says how quiet it is. Exits if it is not; LISCO_WAIT=any measures on any machine. Does nothing if a calling
# script has exported `noise`.
wait_for_quiet() {
  [ -z "${noise:-}" ] || return 0
  local wait=${LISCO_WAIT:-60}
  [ "$wait" != any ] || { noise=$("$build/benchmarks/machine_noise") || true; return 0; }
  until noise=$("$build/benchmarks/machine_noise"); do
    if [ "$SECONDS" -ge $((60 * wait)) ]; then
      echo "the machine is busy, nothing is measured (LISCO_WAIT: minutes to wait, or any); $noise" >&2
      exit 3
    fi
    echo "waiting; $noise"
  done
}

# Sets `rotating` to the rotating scans, and `ground` to the options with the height of the ground in each, which are
# also those of recording_sets.cpp.
find_real_scans() {
  rotating=()
  for scan in "$data"/scans/*.pcd; do
    [[ $scan == */rgbd_* || $scan == */airborne_* ]] || rotating+=("$scan")
  done
  if [ ! -f "${rotating[0]}" ]; then
    echo "no real scans in $data/scans; set LISCO_TEST_DATA" >&2
    return 1
  fi
  ground=()
  for height in hdl32e_outdoor_0=-2.10 hdl32e_outdoor_1=-2.10 hdl64e_city_0=-1.60 hdl64e_city_1=-1.60 \
                vlp16_close_0=-0.57 vlp16_street_0=-1.99 vls128_street_0=-1.74 os1_128_outdoor_0=-1.81 \
                os1_64_sparse_0=-0.48 hdl64e_kitti_0=-1.30 vls128_deskewed_0=0.30; do
    ground+=(--ground-z "$height")
  done
}

# report LOG COMMAND...: runs a comparison with its tables in LOG, and shows them if it fails.
report() {
  local log=$1
  shift
  "$@" >"$log" || {
    cat "$log" >&2
    return 1
  }
}

# table NAME CSV...: one of the tables of tables.awk.
table() {
  local name=$1
  shift
  awk -v table="$name" -f "$root/benchmarks/tables.awk" "$@"
}

# replace_section FILE NAME: replaces the lines of FILE between `<!-- NAME -->` and `<!-- end -->` by stdin.
replace_section() {
  local file=$1 name=$2 new
  new=$(mktemp)
  cat >"$new"
  if ! awk -v begin="<!-- $name -->" '
       $0 == begin { begun = 1 }
       begun && $0 == "<!-- end -->" { ended = 1 }
       END { exit !ended }' "$file"; then
    echo "$file has no complete section '$name'" >&2
    return 1
  fi
  awk -v begin="<!-- $name -->" -v new="$new" '
    $0 == begin { print; print ""; while ((getline line < new) > 0) print line; print ""; inside = 1; next }
    inside && $0 == "<!-- end -->" { inside = 0 }
    !inside { print }' "$file" >"$file.partial"
  mv "$file.partial" "$file"
  rm "$new"
}

# code_block: stdin as a block of code.
code_block() {
  echo '```'
  cat
  echo '```'
}
