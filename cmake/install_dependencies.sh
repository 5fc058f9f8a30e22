#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs Debian's (or Ubuntu's) packages for building, running and testing, and those given as arguments. Does
# nothing, and needs no network, if all are installed.
set -euo pipefail

packages=(g++ cmake ninja-build pkg-config libpcl-dev libhwy-dev libboost-dev libboost-program-options-dev
          nlohmann-json3-dev
          libcairo2-dev libpcap-dev libsqlite3-dev liblz4-dev libzstd-dev libbz2-dev zlib1g-dev fonts-dejavu-core
          gnuplot-nox libgtest-dev doxygen dpkg-dev file help2man binutils "$@"
          pybind11-dev python3-dev python3-numpy python3-scipy python3-sklearn python3-pytest python3-hypothesis
          python3-matplotlib python3-distributed python3-pip python3-mypy)

missing=()
for package in "${packages[@]}"; do
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)
log=$(mktemp)
trap 'rm -f "$log"' EXIT
echo "installing ${missing[*]} (takes minutes: up to 600 MB to download with dependencies)"
if ! { "${as_root[@]}" apt-get update &&
       "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
         apt-get install -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1 </dev/null; then
  cat "$log" >&2
  echo "could not install: ${missing[*]}" >&2
  exit 1
fi
