# SPDX-License-Identifier: BSD-3-Clause
# Shared by the scripts, which source it.

# quietly LOG COMMAND...: runs a command and shows its output only if it fails.
quietly() {
  local log=$1
  shift
  if ! "$@" >"$log" 2>&1 </dev/null; then
    cat "$log" >&2
    echo "failed: $*" >&2
    return 1
  fi
}

# build_quietly SOURCE BUILD [--target TARGET --] CMAKE-OPTION...: configures and builds all, or a target. Prints a line
# before the first build, which takes minutes.
build_quietly() {
  local source=$1 build=$2 target=all
  shift 2
  if [ "${1:-}" = --target ]; then
    target=$2
    shift 3
  fi
  [ -f "$build/build.ninja" ] || echo "building in $build (minutes; progress: $build/build.log)"
  mkdir -p "$build"
  if command -v ccache >/dev/null; then
    set -- "$@" -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
  fi
  quietly "$build/configure.log" cmake -S "$source" -B "$build" -G Ninja "$@"
  quietly "$build/build.log" cmake --build "$build" --target "$target"
}
