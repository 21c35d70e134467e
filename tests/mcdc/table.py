# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""Tells from llvm-cov's export which decisions of the headers the tests have covered by MC/DC.

    python3 table.py COVERAGE.json INCLUDE EXPLAINED HEADER...

A decision of one condition is covered when it went both ways. In one of more, each condition needs a pair of
evaluations that differ in it and in the outcome, and in nothing else that was evaluated. A header's template counts
once: what one instantiation shows is shown. EXPLAINED is a page with lines "- `HEADER`, condition N of `CODE`: why":
what is not covered must stand there, and what stands there must not be covered. The exit status is 0 only when both hold.
With "-" for EXPLAINED the table is all.
"""
import json
import os
import re
import sys

BRANCH, DECISION, CONDITION = 4, 5, 6


def covered(functions, include):
    """Of each header, by its place: what each condition of a decision has been shown to do."""
    headers = {}
    for function in functions:
        name = os.path.relpath(function["filenames"][0], include)
        found = headers.setdefault(name, {})
        for record in function["mcdc_records"]:
            shown = found.setdefault(tuple(record[:4]), [False] * len(record[6]))
            for i, one in enumerate(record[6]):
                shown[i] = shown[i] or one
        for branch in function["branches"]:
            if branch[8] == BRANCH:
                ways = found.setdefault(tuple(branch[:4]), [False])
                once = found.setdefault(tuple(branch[:4]) + ("ways",), [0, 0])
                once[0] += branch[4]
                once[1] += branch[5]
                ways[0] = once[0] > 0 and once[1] > 0
    return headers


def text_at(lines, place):
    first, column, last, end = place[:4]
    taken = lines[first - 1:last]
    taken[-1] = taken[-1][:end - 1]
    taken[0] = taken[0][column - 1:]
    return re.sub(r"\s+", " ", " ".join(taken))


def main():
    coverage, include, page, wanted = sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:]
    with open(coverage, encoding="utf-8") as file:
        headers = covered(json.load(file)["data"][0]["functions"], os.path.realpath(include))
    print("| header | decisions | conditions | covered |\n| --- | ---: | ---: | ---: |")
    open_ones, sums = [], [0, 0, 0]
    for name in wanted:
        with open(os.path.join(include, name), encoding="utf-8") as file:
            lines = file.read().split("\n")
        decisions = {place: shown for place, shown in headers.get(name, {}).items() if len(place) == 4}
        row = [len(decisions), sum(map(len, decisions.values())), sum(map(sum, decisions.values()))]
        sums = [a + b for a, b in zip(sums, row)]
        if row[0]:
            print("| `%s` | %d | %d | %d |" % (name, *row))
        for place, shown in sorted(decisions.items()):
            missing = [str(i + 1) for i, one in enumerate(shown) if not one]
            if missing:
                open_ones.append((name, place[0], text_at(lines, place), ", ".join(missing)))
    print("| all | %d | %d | %d |" % tuple(sums))
    if page == "-":
        return 0
    with open(page, encoding="utf-8") as file:
        explained = set(re.findall(r"^- `([^`]+)`, condition ([0-9, ]+) of `([^`]+)`: ", file.read(), re.M))
    wrong = 0
    for name, line, code, conditions in open_ones:
        known = (name, conditions, code) in explained
        explained.discard((name, conditions, code))
        wrong += not known
        print("%s:%d: condition %s of `%s`: %s" %
              (name, line, conditions, code, "not covered, explained in uncovered.md" if known else "NOT COVERED"))
    for name, conditions, code in sorted(explained):
        wrong += 1
        print("%s: condition %s of `%s` is explained in uncovered.md, but covered or gone" % (name, conditions, code))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
