#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Puts plausible bugs into a copy of the engine, one at a time, and runs the engine's tests, which must fail.

    test/mutations.py                   all of test/mutations.txt
    test/mutations.py seam "late re"    those whose names contain one of these

Prints `killed` and the first failing test, or `SURVIVED`, for each. Exits with 1 if one survives, or no longer fits
the source. The copy stays in build/mutations, so that a second run builds less.
"""
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "mutations"
# Each program and its tests: first those that take the least time or kill the most.
RUNS = [
    ("lisco_core_tests", "-*Seeds*:Larger*:*Threads*"),
    ("lisco_core_tests", "*RandomScans*/0:WindowClusterer*:Endless*:Stream*"),
    ("lisco_allocation_tests", "*"),
    ("lisco_core_tests", "*"),
    ("lisco_exception_tests", "*"),
]
TIMEOUT = 600  # seconds; an endless bug counts as killed


def read_list(path):
    """Reads the bugs: `= name`, `file`, then `- line` to be replaced and `+ line` that replaces it."""
    mutations = []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if not line or line.startswith("#"):
            continue
        kind, rest = line[0], line[2:]
        if kind == "=":
            mutations.append({"name": rest, "file": None, "old": [], "new": []})
        elif kind == "@":
            mutations[-1]["file"] = rest
        elif kind == "-":
            mutations[-1]["old"].append(rest)
        elif kind == "+":
            mutations[-1]["new"].append(rest)
        else:
            sys.exit(f"{path}:{number}: not a line of a bug: {line}")
    return mutations


def mutate(source, mutation):
    """Returns the source with the bug, None if it does not fit exactly once."""
    old, new = ("\n".join(mutation[key]) for key in ("old", "new"))
    return source.replace(old, new) if source.count(old) == 1 else None


def copy_tree():
    tree = WORK / "tree"
    for name in ("CMakeLists.txt", "LICENSE", "README.md", "cmake", "include", "src", "test", "doc"):
        source, target = ROOT / name, tree / name
        target.parent.mkdir(parents=True, exist_ok=True)
        for file in [source] if source.is_file() else source.rglob("*"):
            if not file.is_file():
                continue
            copy = tree / file.relative_to(ROOT)
            if not copy.exists() or copy.read_bytes() != file.read_bytes():  # equal files are not rebuilt
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_bytes(file.read_bytes())
    return tree


def run(command, timeout=None):
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                              stdin=subprocess.DEVNULL, timeout=timeout, check=False)
    except subprocess.TimeoutExpired:
        return 1, "timed out"
    return done.returncode, done.stdout


def build(programs):
    return run(["cmake", "--build", str(WORK / "build"), "--target", *programs, "-j1"])


def killer():
    """Returns the first failing test, None if all pass."""
    for program, tests in RUNS:
        path = WORK / "build" / "test" / program
        status, output = run([str(path), f"--gtest_filter={tests}", "--gtest_fail_fast", "--gtest_brief=1"], TIMEOUT)
        if status != 0:
            failed = re.search(r"\[  FAILED  \] (\S+?)(,|\s)", output)
            return failed.group(1) if failed else output.strip().splitlines()[-1] if output.strip() else "a crash"
    return None


def main():
    mutations = read_list(pathlib.Path(__file__).with_suffix(".txt"))
    wanted = sys.argv[1:]
    if wanted:
        mutations = [m for m in mutations if any(word in m["name"] for word in wanted)]
    tree = copy_tree()
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    status, output = run(["cmake", "-G", "Ninja", "-S", str(tree), "-B", str(WORK / "build"), "-DLISCO_BUILD_APPS=OFF",
                          "-DCMAKE_BUILD_TYPE=Release", *launcher])
    programs = sorted({program for program, _ in RUNS})
    if status == 0:
        status, output = build(programs)
    if status != 0:
        sys.exit(output + "\nthe tests cannot be built")
    if killer() is not None:
        sys.exit("the tests fail without any bug")

    bad = 0
    for mutation in mutations:
        path = tree / mutation["file"]
        right = path.read_text()
        wrong = mutate(right, mutation)
        if wrong is None:
            verdict = "NO LONGER FITS"
        else:
            path.write_text(wrong)
            try:
                status, output = build(programs)
                by = killer() if status == 0 else None
            finally:
                path.write_text(right)
            verdict = f"killed    by {by}" if by else "SURVIVED" if status == 0 else "DOES NOT COMPILE"
        bad += not verdict.startswith("killed")
        print(f"{mutation['name']:60} {verdict}", flush=True)
    print(f"{len(mutations) - bad} of {len(mutations)} killed")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
