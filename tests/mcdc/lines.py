# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""lines.py SUMMARY: lines and branches of the firmware headers that an `llvm-cov export -summary-only` counts, by folder."""
import collections
import json
import sys

UPSTAIRS = ("simulation", "plant", "gap", "io")
counts = collections.defaultdict(lambda: [0, 0, 0, 0])
with open(sys.argv[1], encoding="utf-8") as file:
    files = json.load(file)["data"][0]["files"]
for one in files:
    place = one["filename"].split("/include/thermopower/")
    if len(place) < 2 or place[1].split("/")[0] in UPSTAIRS:
        continue
    summary = one["summary"]
    folder = place[1].rsplit("/", 1)[0] if "/" in place[1] else "."
    for name in (folder, "all"):
        for at, what in ((0, "lines"), (2, "branches")):
            counts[name][at] += summary[what]["covered"]
            counts[name][at + 1] += summary[what]["count"]
print("| folder | lines run | of | branches run | of |\n|---|---:|---:|---:|---:|")
for name in sorted(counts, key=lambda one: (one == "all", one)):
    print("| %s | %d | %d | %d | %d |" % ((name,) + tuple(counts[name])))
