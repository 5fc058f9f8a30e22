#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# program_pages.sh PROGRAM DESCRIPTION MANUAL COMPLETION [HELP2MAN]: writes, from PROGRAM --help, a completion for bash
# into a file and, with HELP2MAN, a manual page into another.
set -euo pipefail
program=$1 description=$2 manual=$3 completion=$4 help2man=${5:-}
export ASAN_OPTIONS=detect_leaks=0  # leaks are reported by the tests

options=$("$program" --help | grep -oE '(^|[ [])--[a-z][a-z-]*' | grep -oE -e '--.*' | sort -u | tr '\n' ' ')
printf 'complete -o bashdefault -o default -W "%s" %s\n' "${options% }" "$(basename "$program")" >"$completion"

if [ -n "$help2man" ]; then
  # The form that help2man takes: "-o, --output FILE  what it does".
  wrapper=$(mktemp)
  trap 'rm -f "$wrapper"' EXIT
  cat >"$wrapper" <<END
#!/usr/bin/env bash
"$program" "\$@" | sed -E 's/^  (-.) \[ (--[^ ]+) \]( [^ ]+)? +/  \1, \2\3  /'
END
  chmod +x "$wrapper"
  "$help2man" --no-info --name "$description" --output="$manual" "$wrapper"
fi
