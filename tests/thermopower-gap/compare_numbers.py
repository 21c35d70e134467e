#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""Two reports of the same recording, as two compilers' programs write them: the same words, and numbers equal to a share.

    compare_numbers.py A.json B.json [SHARE]     SHARE is 1e-6 where none is given; prints each difference, and fails where there is one

A number may differ by that share of itself, or of the largest number beside it in its list: of a vector, the small entries are
differences of large numbers, and have fewer digits.
"""

import json
import sys


def numbers(value):
    return [abs(one) for one in value if isinstance(one, (int, float)) and not isinstance(one, bool)]


def differences(a, b, share, where="", scale=0.0):
    if isinstance(a, dict) and isinstance(b, dict):
        if list(a) != list(b):
            yield f"{where}: keys {sorted(set(a) ^ set(b))}"
            return
        for key in a:
            yield from differences(a[key], b[key], share, f"{where}/{key}")
    elif isinstance(a, list) and isinstance(b, list):
        if len(a) != len(b):
            yield f"{where}: {len(a)} and {len(b)} entries"
            return
        most = max(numbers(a), default=0.0)
        for i, (one, other) in enumerate(zip(a, b)):
            yield from differences(one, other, share, f"{where}/{i}", most)
    elif isinstance(a, (int, float)) and isinstance(b, (int, float)) and not isinstance(a, bool):
        if abs(a - b) > share * max(abs(a), abs(b), scale):
            yield f"{where}: {a!r} and {b!r}"
    elif a != b:
        yield f"{where}: {a!r} and {b!r}"


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    reports = []
    for path in sys.argv[1:3]:
        with open(path, encoding="utf-8") as file:
            reports.append(json.load(file))
    share = float(sys.argv[3]) if len(sys.argv) > 3 else 1e-6
    found = list(differences(*reports, share))
    for one in found[:40]:
        print(one)
    print(f"{len(found)} differences beyond {share:g}")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
