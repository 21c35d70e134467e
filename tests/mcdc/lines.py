# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""lines.py FOLDER [--open]: lines and branches of the firmware headers that the tests have run, by folder.

FOLDER holds one `llvm-cov export` of each test. --open prints what no test has run instead.

A function is counted once, wherever it is compiled; a template's, whichever instance has run. clang gives a function that a test
does not call a region as long as its body, with no branches: where another test calls it, that one says which of its lines there are.
(Of several programs `llvm-cov` itself keeps the first it meets, and may so call a function not run that is.)"""
import collections
import glob
import json
import sys

UPSTAIRS = ("simulation", "plant", "gap", "io")
CODE, SKIPPED, GAP = 0, 2, 3


def lines_of(regions):
    """Line by line: how often it was run, as LLVM counts: by the region that reaches into it, and those that begin in it."""
    counts = {}
    first, last = min(r[0] for r in regions), max(r[2] for r in regions)
    for line in range(first, last + 1):
        begun = [r[4] for r in regions if r[0] == line and r[7] == CODE]
        around = [r for r in regions if r[0] < line <= r[2]]
        inner = max(around, key=lambda r: (r[0], r[1], -r[2], -r[3])) if around else None
        if any(r[7] == SKIPPED and r[0] <= line <= r[2] for r in regions) and not begun:
            continue
        if begun or (inner and inner[7] != SKIPPED):
            counts[line] = max(begun + ([inner[4]] if inner and inner[7] != GAP or not begun else []))
    return counts


functions = collections.defaultdict(list)
for name in sorted(glob.glob(sys.argv[1] + "/*.json")):
    with open(name, encoding="utf-8") as file:
        for function in json.load(file)["data"][0]["functions"]:
            place = function["filenames"][0].split("/include/thermopower/")
            if len(place) == 2 and place[1].split("/")[0] not in UPSTAIRS:
                regions = [r for r in function["regions"] if r[5] == 0]
                branches = [b for b in function["branches"] if b[6] == 0]
                functions[place[1], regions[0][0], regions[0][1]].append((regions, branches))

lines, branches = collections.defaultdict(int), collections.defaultdict(int)
for (header, _, _), instances in functions.items():
    called = [one for one in instances if any(r[4] for r in one[0])]
    for regions, taken in called or instances:
        for line, count in lines_of(regions).items():
            lines[header, line] += count
        for b in taken:
            branches[(header,) + tuple(b[:4]) + (True,)] += b[4]
            branches[(header,) + tuple(b[:4]) + (False,)] += b[5]

if "--open" in sys.argv:
    for where in sorted(list(lines.items()) + list(branches.items())):
        if where[1] == 0:
            print(*where[0])
    sys.exit()
counts = collections.defaultdict(lambda: [0, 0, 0, 0])
for at, found in ((0, lines), (2, branches)):
    for where, count in found.items():
        folder = where[0].rsplit("/", 1)[0] if "/" in where[0] else "."
        for name in (folder, "all"):
            counts[name][at] += count > 0
            counts[name][at + 1] += 1
print("| folder | lines run | of | branches run | of |\n|---|---:|---:|---:|---:|")
for name in sorted(counts, key=lambda one: (one == "all", one)):
    print("| %s | %d | %d | %d | %d |" % ((name,) + tuple(counts[name])))
run, of, taken, ways = counts["all"]
print("%.1f %% of the lines, %.1f %% of the branches" % (100.0 * run / of, 100.0 * taken / ways))
