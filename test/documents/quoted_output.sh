#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# quoted_output.sh DOCUMENT NAME COMMAND...: the command prints what the document shows between fences after the line
# <!-- output of NAME -->.
set -euo pipefail
document=$1 name=$2
shift 2
quoted=$(awk -v mark="<!-- output of $name -->" '
  $0 == mark { found = 1; next }
  found && /^```/ { if (inside) exit; inside = 1; next }
  inside' "$document")
[ -n "$quoted" ] || { echo "$document quotes no output of $name" >&2; exit 1; }
diff <(echo "$quoted") <("$@")
