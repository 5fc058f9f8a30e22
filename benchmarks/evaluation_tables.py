#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tables of doc/evaluation.md that tables.awk does not make: evaluation_tables.py NAME FILE..., Markdown to stdout.

Files are those of lisco_compare --csv, merge_cost, growing_subclusters and, for boards, lines of extractions with the
instructions in front. `rotations-data` writes the numbers that rotations.gp draws.
"""

import csv
import math
import re
import sys

NAMES = {"pcl": "PCL", "pcl-tutorial": "PCL, sorted", "pcl-octree": "PCL, octree", "flann": "FLANN",
         "nanoflann": "nanoflann", "grid": "grid", "paper": "paper's Lisco", "lisco": "Lisco"}


def rows_of(files):
    """The rows of CSV files with a header."""
    for name in files:
        with open(name, newline="") as file:
            yield from csv.DictReader(file)


def short(value):
    """Three significant digits."""
    return f"{value:.0f}" if value >= 100 else f"{value:.1f}" if value >= 10 else f"{value:.2f}"


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values))


def student_quantile(degrees, share=0.995):
    """The quantile of Student's distribution, by Simpson's rule and bisection."""
    scale = math.exp(math.lgamma((degrees + 1) / 2) - math.lgamma(degrees / 2)) / math.sqrt(degrees * math.pi)

    def below(limit, steps=2000):
        width = limit / steps
        density = [scale * (1 + (i * width) ** 2 / degrees) ** (-(degrees + 1) / 2) for i in range(steps + 1)]
        return 0.5 + width / 3 * (density[0] + density[-1] + 4 * sum(density[1:-1:2]) + 2 * sum(density[2:-1:2]))

    low, high = 0.0, 100.0
    while high - low > 1e-6:
        middle = (low + high) / 2
        low, high = (middle, high) if below(middle) < share else (low, middle)
    return low


def mean_with_confidence(values):
    """The mean, and half the width of its 99 % confidence interval; None for one value."""
    mean = sum(values) / len(values)
    if len(values) < 2:
        return mean, None
    deviation = math.sqrt(sum((value - mean) ** 2 for value in values) / (len(values) - 1))
    return mean, student_quantile(len(values) - 1) * deviation / math.sqrt(len(values))


def timed(values):
    mean, error = mean_with_confidence(values)
    return short(mean) if error is None else f"{short(mean)} ± {short(error)}"


def print_table(head, rows):
    print("| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(map(str, row)) + " |")


class Rotations:
    """Rotations of recordings and scans as lisco_compare names them: SOURCE_NUMBER_TIME, or the name of a file."""

    def __init__(self, files):
        rows = list(rows_of(files))
        columns = {}
        for row in rows:
            row["source"] = re.sub(r"_\d{6}(_.*)?$", "", row["input"])
            columns[row["source"]] = max(columns.get(row["source"], 0), int(row["columns"]))
        # The first and the last rotation of a recording may be parts of one.
        self.rows = [row for row in rows if int(row["columns"]) >= 0.95 * columns[row["source"]]]
        self.partial = len({row["input"] for row in rows}) - len({row["input"] for row in self.rows})
        self.sources = list(dict.fromkeys(row["source"] for row in self.rows))
        self.tolerances = sorted({float(row["tolerance"]) for row in self.rows})
        self.methods = [key for key in NAMES if any(row["baseline"] == key for row in self.rows)]

    def of(self, source=None, tolerance=None, method=None):
        return [row for row in self.rows if source in (None, row["source"]) and method in (None, row["baseline"]) and
                tolerance in (None, float(row["tolerance"]))]

    def returns(self, source=None):
        counts = {row["input"]: int(row["returns"]) for row in self.of(source)}
        return list(counts.values())

    def times(self, method, tolerance, source=None):
        return {row["input"]: float(row["mean_ms"]) for row in self.of(source, tolerance, method) if row["mean_ms"]}


def returns_table(files):
    rotations = Rotations(files)
    rows = [["Ford Campus (the paper's)", 2280, 5000, 50225, 75550]]
    for source in [None, *rotations.sources]:
        counts = rotations.returns(source)
        rows.append([source or "all here", len(counts), min(counts), round(sum(counts) / len(counts)), max(counts)])
    print_table(["rotations of", "rotations", "least returns", "mean", "most returns"], rows)
    if rotations.partial:
        print(f"\nLeft out: {rotations.partial} parts of rotations at the ends of recordings.")


def rotations_table(files):
    rotations = Rotations(files)
    others = [key for key in rotations.methods if key != "pcl"]
    rows = []
    for source in [None, *rotations.sources]:
        for tolerance in rotations.tolerances:
            times = {key: rotations.times(key, tolerance, source) for key in rotations.methods}
            row = [source or "all", len(times["pcl"]), f"{tolerance:g}"]
            row += [timed(list(times[key].values())) if times[key] else "-" for key in rotations.methods]
            for key in others:
                ratios = [times["pcl"][one] / times[key][one] for one in times[key]]
                row.append(short(geometric_mean(ratios)) if ratios else "-")
            rows.append(row)
        if source is None and len(rotations.sources) == 1:
            break
    print_table(["rotations of", "rotations", "ε", *(NAMES[key] for key in rotations.methods),
                 *(f"PCL / {NAMES[key].removesuffix(' Lisco')}" for key in others)], rows)


def identical_table(files):
    """In how many cases the clusters are PCL's (claim 1)."""
    tables = {}
    for row in rows_of(files):
        if row["baseline"] != "pcl" and row["identical"]:
            kind = "simulated" if row["input"].startswith(("SCEN", "rotation_")) else "real"
            cell = tables.setdefault(row["baseline"], {}).setdefault(kind, [0, 0, 0])
            cell[0] += row["identical"] == "yes"
            cell[1] += 1
            cell[2] = max(cell[2], int(row["mislabelled"]))
    kinds = sorted({kind for cells in tables.values() for kind in cells}, reverse=True)
    rows = []
    for key in NAMES:
        if key in tables:
            cells = [tables[key].get(kind, [0, 0, 0]) for kind in kinds]
            shares = [f"{same} of {cases}" if cases else "-" for same, cases, _ in cells]
            rows.append([NAMES[key], *shares, max(most for _, _, most in cells)])
    print_table(["clusters of", *(f"as PCL's, {kind}" for kind in kinds), "most points with another label"], rows)


def rotations_data(files):
    """For rotations.gp: mean and confidence per tolerance, then returns and time of each rotation at 0.4 m."""
    rotations = Rotations(files)
    for key in rotations.methods:
        for tolerance in rotations.tolerances:
            mean, error = mean_with_confidence(list(rotations.times(key, tolerance).values()))
            print("mean", key, tolerance, mean, error or 0)
        times = rotations.times(key, 0.4)
        counts = {row["input"]: row["returns"] for row in rotations.of(method=key)}
        for name, time in times.items():
            print("each", key, counts[name], time, 0)


def rivals_table(files):
    """All methods at the same scans and tolerances."""
    cases = {}
    for row in rows_of(files):
        if row["mean_ms"]:
            case = cases.setdefault((row["input"], row["returns"], float(row["tolerance"])), {})
            star = "" if row["identical"] == "yes" else " *"
            case[row["baseline"]] = (float(row["mean_ms"]), float(row["confidence99_ms"] or 0), int(row["runs"]), star)
    keys = [key for key in NAMES if any(key in case for case in cases.values())]
    rows = []
    for (scan, returns, tolerance), case in cases.items():
        cells = [f"{short(case[key][0])} ± {short(case[key][1])}{case[key][3]}" if key in case else "-" for key in keys]
        rows.append([scan, returns, f"{tolerance:g}", *cells])
    means = {key: geometric_mean([case["pcl"][0] / case[key][0] for case in cases.values() if key in case])
             for key in keys}
    rows.append(["times as fast as PCL", "", "", *(short(means[key]) for key in keys)])
    fewest = {NAMES[key]: min(case[key][2] for case in cases.values() if key in case) for key in keys}
    print_table(["scan", "returns", "ε", *(NAMES[key] for key in keys)], rows)
    most = max(fewest.values())
    slow = [f"{name} {runs}" for name, runs in fewest.items() if runs < most]
    print(f"\n{most} runs of each" + (f"; at least, of those that take long: {', '.join(slow)}." if slow else "."))


def subclusters_table(files):
    scans = {}
    for row in rows_of(files):
        scans.setdefault(row["input"] if "input" in row else row["scan"], []).append(row)
    rows = []
    for scan, looks in scans.items():
        columns = int(looks[0]["columns"])
        at = [next(look for look in looks if int(look["received"]) >= share * columns)
              for share in (0.25, 0.5, 0.75, 1)]
        numbers = [int(look["subclusters"]) for look in looks]
        falls = sum(before > after for before, after in zip(numbers, numbers[1:]))
        rows.append([scan, looks[0]["returns"], columns, *(look["subclusters"] for look in at), max(numbers), falls,
                     at[-1]["clusters"]])
    print_table(["scan", "returns", "columns", "after a quarter", "half", "three quarters", "all", "most",
                 "times it fell", "clusters of 10 or more"], rows)


def merges_table(files):
    rows = []
    for row in rows_of(files):
        returns, pairs, merges = int(row["returns"]), int(row["pairs"]), int(row["merges"])
        name = row["scan"].replace("comb_", "worst case, rows: ")
        rows.append([name, returns, row["tolerance"], f"{2 * pairs / returns:.1f}", merges,
                     f"{pairs / max(merges, 1):.0f}", row["relabelled"], f"{float(row['over_n_log_n']):.4f}"])
    print_table(["scan", "returns n", "ε", "getH per return", "merges", "pairs per merge", "points relabelled",
                 "of n log₂ n"], rows)


BOARDS = [("Raspberry Pi 4, Cortex-A72", 1.8), ("Raspberry Pi 5, Cortex-A76", 2.4), ("Jetson Orin Nano, A78AE", 1.7)]


def boards_table(files):
    """Instructions of an extraction, and what they take at half to one and a half instructions per cycle."""
    rows = []
    for name in files:
        with open(name) as file:
            for line in file:
                count, scan, returns, tolerance, key, level, *_ = line.strip().split(",")
                millions = float(count) / 1e6
                spans = [f"{short(millions / ghz / 1.5)} to {short(millions / ghz / 0.5)}" for _, ghz in BOARDS]
                rows.append([scan, returns, tolerance, NAMES[key], level, short(millions), *spans])
    print_table(["scan", "returns", "ε", "method", "vectors", "million instructions",
                 *(f"{board}, {ghz} GHz: ms (estimate)" for board, ghz in BOARDS)], rows)


TABLES = {"returns": returns_table, "rotations": rotations_table, "rotations-data": rotations_data,
          "identical": identical_table, "rivals": rivals_table, "subclusters": subclusters_table,
          "merges": merges_table, "boards": boards_table}

if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] not in TABLES:
        sys.exit(f"evaluation_tables.py: takes a name, one of {', '.join(TABLES)}, and files")
    TABLES[sys.argv[1]](sys.argv[2:])
