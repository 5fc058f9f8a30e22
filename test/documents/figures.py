#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the figures in the documents' sentences with the tables that they come from: figures.py ROOT [DOCUMENT...].

figures.txt lists the sentences. With --write, figures that differ are replaced, as evaluation.sh and suite.sh do after
they have rewritten tables; a sentence whose words are no longer true is reported. Exit code: 1 if anything differs.
"""

import math
import pathlib
import re
import sys


def short(value):
    """Three significant digits, as in the tables; words and whole numbers as they are."""
    if not isinstance(value, float):
        return str(value)
    return f"{value:.0f}" if value >= 100 else f"{value:.1f}" if value >= 10 else f"{value:.2f}"


class Document:
    """The tables and blocks between `<!-- NAME -->` and `<!-- end -->`."""

    def __init__(self, text):
        self.sections = {name: body for name, body in
                         re.findall(r"^<!-- ([^\n]*?) -->\n(.*?)^<!-- end -->$", text, re.M | re.S)}

    def table(self, section):
        """The rows of its first Markdown table, by the names of the columns."""
        lines = [line for line in self.sections[section].splitlines() if line.startswith("|")]
        head, _, *rows = ([cell.strip() for cell in line.strip("|").split("|")] for line in lines)
        return [dict(zip(head, row)) for row in rows]


def number(text):
    """The number at the beginning of a cell: 12.3 of "12.3 ± 0.1 *"."""
    return float(re.match(r"-?[\d.]+", text).group())


class Tables:
    """What the expressions of figures.txt may use, of one document and by its path of others."""

    def __init__(self, root, document):
        self.root, self.path = root, document
        self.documents = {}

    def document(self, path=None):
        path = path or self.path
        if path not in self.documents:
            self.documents[path] = Document((self.root / path).read_text())
        return self.documents[path]

    def rows(self, section, path=None, **conditions):
        rows = self.document(path).table(section)
        return [row for row in rows if all(row[name] == value for name, value in conditions.items())]

    def col(self, section, column, path=None, **conditions):
        """The numbers of a column, of rows whose other columns have these values."""
        return [number(row[column]) for row in self.rows(section, path, **conditions) if re.match(r"-?\d", row[column])]

    def cell(self, section, column, path=None, **conditions):
        (row,) = self.rows(section, path, **conditions)
        return number(row[column])

    def stars(self, section, column):
        """How many cells of a column are marked as not PCL's clusters."""
        return sum("*" in row[column] for row in self.rows(section))

    def find(self, section, pattern, path=None):
        """The number that a pattern's group matches in a section."""
        return float(re.search(pattern, self.document(path).sections[section]).group(1))

    def finds(self, section, pattern, path=None):
        """All such numbers."""
        return [float(one) for one in re.findall(pattern, self.document(path).sections[section])]

    def form(self, name):
        """The numbers of one form of clouds in the table of recordings: cases, then mean and lowest of both ratios."""
        table = self.document("doc/benchmarks.md").sections["recordings"]
        line = re.search(rf"^ *{re.escape(name)}  +(.*)$", table, re.M).group(1)
        return [float(cell) for cell in line.split()[:5]]

    def names(self):
        return {"rows": self.rows, "col": self.col, "cell": self.cell, "stars": self.stars, "find": self.find,
                "finds": self.finds, "form": self.form,
                "gmean": lambda values: math.exp(sum(map(math.log, values)) / len(values)),
                "ratio": lambda a, b: [x / y for x, y in zip(a, b)], "len": len, "min": min, "max": max, "sum": sum,
                "all": all, "any": any, "number": number, "round": round, "int": int, "zip": zip, "float": float}


def sentences(text):
    """Path, sentence and conditions of each entry of figures.txt."""
    path = None
    for entry in re.split(r"\n\s*\n", text):
        lines = [line for line in entry.splitlines() if line and not line.startswith("#")]
        if lines and lines[0].startswith("== "):
            path = lines.pop(0)[3:].strip()
        conditions = [line.strip()[2:] for line in lines if line.strip().startswith("? ")]
        sentence = " ".join(line.strip() for line in lines if not line.strip().startswith("? "))
        if sentence:
            yield path, sentence, conditions


def pattern_of(sentence):
    """A pattern with a group per {expression}, in which blanks match line breaks, and the expressions."""
    parts = re.split(r"\{([^{}]*)\}", sentence)
    words = [r"\s+".join(map(re.escape, re.split(r"\s+", part))) for part in parts[0::2]]
    return r"([\d.]+)".join(words), parts[1::2]


def check(root, path, sentence, conditions, write):
    """The errors in one sentence, after replacing its figures if they are to be written."""
    text = (root / path).read_text()
    pattern, expressions = pattern_of(sentence)
    found = list(re.finditer(pattern, text))
    if len(found) != 1:
        return [f"{path}: {len(found)} times in it, not once: {sentence}"]
    names = Tables(root, path).names()
    errors = [f"{path}: no longer true ({condition}): {sentence}" for condition in conditions
              if not eval(condition, {"__builtins__": {}, **names})]
    changed = text
    for group in range(len(expressions), 0, -1):
        expression, form = re.fullmatch(r"(.*?)(?:\|(\.\d+f))?", expressions[group - 1], re.S).groups()
        value = eval(expression, {"__builtins__": {}, **names})
        expected = format(value, form) if form else short(value)
        stated = found[0].group(group)
        if stated.rstrip(".") == expected:
            continue
        if not write:
            errors.append(f"{path}: states {stated} where {expression} gives {expected}: {sentence}")
        end = found[0].start(group) + len(stated.rstrip("."))
        changed = changed[:found[0].start(group)] + expected + changed[end:]
    if write and changed != text:
        (root / path).write_text(changed)
    return errors


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--write"]
    root = pathlib.Path(arguments[0])
    wanted = arguments[1:]
    errors, count = [], 0
    for path, sentence, conditions in sentences((pathlib.Path(__file__).parent / "figures.txt").read_text()):
        if wanted and path not in wanted:
            continue
        count += 1
        try:
            errors += check(root, path, sentence, conditions, "--write" in sys.argv)
        except (KeyError, ValueError, AttributeError, OSError) as error:
            errors.append(f"{path}: cannot be checked ({error!r}): {sentence}")
    for error in errors:
        print(error, file=sys.stderr)
    if not errors:
        print(f"{count} sentences agree with their tables")
    return 1 if errors or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
