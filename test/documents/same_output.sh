#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# same_output.sh PROGRAM PROGRAM: both print the same, at least one line.
set -euo pipefail
first=$("$1")
second=$("$2")
[ -n "$first" ] || { echo "$1 prints nothing" >&2; exit 1; }
diff <(echo "$first") <(echo "$second")
