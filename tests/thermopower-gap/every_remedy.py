#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""Every finding is raised by a small log, and what it says to type works behind the options in force.

    every_remedy.py PROGRAM FINDING_HEADER
"""

import json
import os
import re
import shlex
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import faulty_logs

BELIEVED, NOT_BELIEVED = 0, 4


def alternatives_in(mend):
    """The options among the words of a remedy: those that follow each other are one alternative."""
    option = r"--[a-z-]+ (?:'[^']*'|[^\s);']*[=0-9][^\s);']*)"
    return [shlex.split(one) for one in re.findall(rf"{option}(?: {option})*", mend)]


def check(program, folder, model, train, held_out, options):
    words = [program, "check", "--model", model, "--report", "report.json"]
    for one in train:
        words += ["--recording", one]
    for one in held_out:
        words += ["--heldout", one]
    ran = subprocess.run(words + options, cwd=folder, capture_output=True, text=True)
    if ran.returncode not in (BELIEVED, NOT_BELIEVED):
        return ran, []
    with open(os.path.join(folder, "report.json"), encoding="utf-8") as file:
        return ran, json.load(file)["findings"]


def main(program, header):
    program = os.path.abspath(program)
    with open(header, encoding="utf-8") as file:
        text = file.read()
    kinds = re.findall(r'return "([a-z_]+)";', text[text.index("to_string(FindingKind"):text.index("enum class Severity")])
    raised, wrong, pasted = set(), [], 0
    for kind, files, model, train, held_out, options in faulty_logs.cases():
        with tempfile.TemporaryDirectory() as folder:
            for name, content in files.items():
                with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                    file.write(content)
            ran, findings = check(program, folder, model, train, held_out, options)
            found = [one for one in findings if one["kind"] == kind]
            if not found:
                wrong.append(f"{kind}: not raised; {[one['kind'] for one in findings]}, status {ran.returncode} {ran.stderr}")
                continue
            raised.add(kind)

            def paste(finding, given):
                after, left = check(program, folder, model, train, held_out, options + given)
                said = f"{kind}: {finding['kind']}: {' '.join(given)}"
                if after.returncode not in (BELIEVED, NOT_BELIEVED):
                    return [f"{said}: does not run behind the options in force: {after.stderr}"]
                still = [other["message"] for other in left if (other["kind"], other["column"]) == (finding["kind"], finding["column"])]
                return [f"{said}: the finding is still there: {still}"] if still else []

            for one in findings:
                for given in alternatives_in(one["mend"]):
                    wrong += paste(one, given)
                    pasted += 1
            if os.environ.get("VERBOSE"):
                for one in findings:
                    print(f"{kind} <- {one['kind']} {one['column']}: {one['message'][:90]} => {one['mend']}")
    for kind in kinds:
        if kind not in raised:
            wrong.append(f"{kind}: no log of faulty_logs.py raises it")
    print(f"{len(raised)} of {len(kinds)} findings raised, {pasted} remedies pasted")
    print("\n".join(wrong))
    return 1 if wrong or pasted == 0 else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
