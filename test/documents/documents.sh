#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# documents.sh ROOT PROGRAMS: checks README.md and doc/*.md: relative links; paths in `backticks`; scripts, programs and
# options in ```sh blocks; quoted code, after <!-- FILE --> in the file of that name; the README's diff in the example;
# at most 120 columns outside of tables and code; at most 150 lines of README. Lines of code are compared without
# blanks. And of all other tracked files of text: at most 120 columns, but for generated lists and charts, inputs of
# fuzzers and lines of code that test/mutations.txt quotes. Prints all errors.
set -euo pipefail
cd "$1"
programs=$2
failures=$(mktemp)
scratch=$(mktemp -d)
trap 'rm -rf "$failures" "$scratch"' EXIT
wrong() { echo "$*" | tee -a "$failures" >&2; }

# in_order FILE < LINES: prints the first line that is not in the file after the line before.
in_order() {
  awk 'function bare(line) { gsub(/[ \t]/, "", line); return line }
       FILENAME != "-" { lines[++count] = bare($0); next }
       bare($0) == "" || bare($0) == "..." { next }
       { while (++at <= count && lines[at] != bare($0)); if (at > count) { print; exit } }' "$1" -
}

documents=(README.md doc/*.md)
for document in "${documents[@]}"; do
  folder=$(dirname "$document")

  # Links outside of comments
  while IFS= read -r link; do
    [ -z "$link" ] || [ -e "$folder/$link" ] || wrong "$document: link to $link, which does not exist"
  done < <(awk '/^<!--/ { hidden = 1 } !hidden; /-->$/ { hidden = 0 }' "$document" | grep -o '](\([^)]*\))' |
    sed 's/^](//; s/)$//; s/#.*//' | grep -v '^[a-z]*://' || true)

  # Paths
  while IFS= read -r path; do
    [ -e "$path" ] || wrong "$document: \`$path\` does not exist"
  done < <(grep -oE '`(\.ci|apps|benchmarks|cmake|doc|include|python|src|test)/[A-Za-z0-9_./-]*[ `]' "$document" |
    tr -d '` ' || true)

  # Commands
  while IFS= read -r line; do
    read -ra words <<<"${line%%#*}"
    command=${words[0]:-}
    case $command in
      lisco_*)
        if [ ! -x "$programs/$command" ]; then
          wrong "$document: there is no program $command"
          continue
        fi
        help=$("$programs/$command" --help)
        for word in "${words[@]:1}"; do
          case $word in
            --*) grep -q -e "$word\b" <<<"$help" || wrong "$document: $command has no option $word" ;;
          esac
        done
        ;;
      python3)
        [ "${words[1]} ${words[2]}" = "-m lisco.archive" ] || wrong "$document: unknown command ${words[*]:0:3}"
        for word in "${words[@]:3}"; do
          case $word in
            --*) grep -q "\"$word\"" python/lisco/archive/__main__.py ||
              wrong "$document: lisco.archive has no option $word" ;;
          esac
        done
        ;;
      */*) [ -x "$command" ] || wrong "$document: there is no script $command" ;;
      "" | cmake | ctest) ;;
      *) wrong "$document: unknown command $command" ;;
    esac
  done < <(awk '/^```sh$/ { inside = 1; next } /^```/ { inside = 0 } inside' "$document")

  # Width
  while IFS= read -r line; do
    wrong "$document: more than 120 columns: $line"
  done < <(awk '/^```/ { inside = !inside } { print inside || /^\|/ ? "" : $0 }' "$document" |
    LC_ALL=C.UTF-8 grep -nE '^.{121}' || true)

  # Quoted code
  for file in $(sed -n 's/^<!-- \(examples\/[^ ]*\) -->$/\1/p' "$document" | sort -u); do
    missing=$(awk -v mark="<!-- $file -->" '$0 == mark { found = 1; next }
      found && /^```/ { inside = !inside; if (!inside) found = 0; next } inside' "$document" | in_order "$folder/$file")
    [ -z "$missing" ] || wrong "$document: not in this order in $file: $missing"
  done
done

# The diff
for document in README.md doc/migration.md; do
  awk '/^```diff$/ { inside = 1; next } /^```/ { inside = 0 } inside' "$document" >"$scratch/diff"
  [ -s "$scratch/diff" ] || wrong "$document: no diff"
  for side in "before -" "after +"; do
    read -r name sign <<<"$side"
    missing=$(grep "^[$sign ]" "$scratch/diff" | cut -c2- | in_order "doc/examples/$name.cpp")
    [ -z "$missing" ] || wrong "$document: the diff's line is not in this order in $name.cpp: $missing"
  done
  grep '^-' "$scratch/diff" | cut -c2- | while IFS= read -r line; do
    [ -n "$(in_order doc/examples/after.cpp <<<"$line")" ] ||
      wrong "$document: the diff's line is still in after.cpp: $line"
  done
done

# Width of all other files; a source package has no list of tracked ones
while IFS= read -r line; do
  wrong "more than 120 columns: $line"
done < <(git ls-files -z -- ':!README.md' ':!doc/*.md' ':!doc/images/*.svg' ':!test/fuzz/corpus' \
  ':!test/package/abi_list.txt' ':!test/mutations.txt' 2>/dev/null |
  LC_ALL=C.UTF-8 xargs -0r grep -InE '^.{121}' /dev/null | cut -c1-150 || true)

[ "$(wc -l <README.md)" -le 150 ] || wrong "README.md: $(wc -l <README.md) lines, more than 150"
[ ! -s "$failures" ]
