#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""The commands that README.md, CONTRIBUTING.md and docs/ print.

    commands.py check ROOT BUILD PROGRAM   each command can work: its script, target, test and option exist, and the page says
                                           what builds the program that it runs
    commands.py run ROOT [--chroot DEBIAN] runs README's commands in the order printed, in a copy of the last commit; with
                                           --chroot inside a folder that debootstrap made (needs root)

A command is an indented line of a page that begins with a program's name. One with a placeholder (<build>, DIR, ...) is
checked and not run.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

PROGRAMS = ("sh", "cmake", "ctest", "python3", "pip", "thermopower-gap", "node")
# Pages whose lines describe a form, and pages that a program writes.
FORMS = ("docs/reference/gap-files.md",)


def pages(root):
    yield from (one for one in ("README.md", "CONTRIBUTING.md"))
    for folder, _, names in sorted(os.walk(os.path.join(root, "docs"))):
        for name in sorted(names):
            if name.endswith(".md"):
                yield os.path.relpath(os.path.join(folder, name), root)


def commands(text):
    """(line number, command) of each indented command, continuation lines joined, comments left out."""
    lines, number, fenced = text.split("\n"), 0, False
    while number < len(lines):
        line = lines[number]
        first = number + 1
        number += 1
        if line.lstrip().startswith("```"):
            fenced = not fenced
        if not re.match(r"^ {4,}\S", line) or fenced:
            continue
        line = line.strip()
        while line.endswith("\\") and number < len(lines):
            line = line[:-1].rstrip() + " " + lines[number].strip()
            number += 1
        line = re.sub(r"\s+# .*$", "", line)
        if line.startswith("$ "):
            line = line[2:]
        word = line.split(" ")[0]
        if word in PROGRAMS or word.startswith(("build/", "../bin/")):
            for part in line.split(" && "):
                yield first, part.strip()


def is_form(command):
    return bool(re.search(r"<[^<>|&]+>|\bDIR\b|\bOTHER\b|\bYOUR_|\.\.\.|\$[A-Z_]|\[--", command))


def output(words):
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


class Checker:
    def __init__(self, root, build, program):
        self.root, self.wrong = root, []
        self.targets = {line.split(":")[0] for line in output(["ninja", "-C", build, "-t", "targets", "all"]).split("\n")}
        self.tests = re.findall(r"Test +#\d+: (\S+)", output(["ctest", "--test-dir", build, "-N"]))
        self.options, self.subcommands = {}, []
        for name in re.findall(r"^  ([a-z]+) ", output([program, "--help"]).split("Subcommands:")[1], re.M):
            self.subcommands.append(name)
            self.options[name] = set(re.findall(r"--[a-z-]+", output([program, name, "--help"])))
        with open(os.path.join(root, "CMakePresets.json"), encoding="utf-8") as file:
            self.presets = set(re.findall(r'"name": "([a-z0-9-]+)"', file.read()))

    def fail(self, place, what):
        self.wrong.append(f"{place}: {what}")

    def check_target(self, place, target):
        if "<" not in target and not any(one == target or one.endswith("/" + target) for one in self.targets):
            self.fail(place, f"there is no target {target} in the release build")

    def check(self, page, number, command, text):
        place = f"{page}:{number}"
        words = shlex.split(command.replace("[", "").replace("]", ""), comments=True)
        name = words[0]
        for i, word in enumerate(words):
            if word == "--preset" and i + 1 < len(words) and words[i + 1] not in self.presets:
                self.fail(place, f"there is no preset {words[i + 1]}")
        if name in ("sh", "python3") and len(words) > 1:
            script = next((one for one in words[1:] if not one.startswith("-")), "")
            if "/" in script and not os.path.exists(os.path.join(self.root, script)):
                self.fail(place, f"there is no file {script}")
        elif name == "cmake":
            is_release = "--preset" not in words or words[words.index("--preset") + 1] in ("release",)
            for i, word in enumerate(words):
                if word == "--target" and is_release and "THERMOPOWER_BENCHMARKS" not in text:
                    for target in words[i + 1:]:
                        if target.startswith("-"):
                            break
                        self.check_target(place, target)
        elif name == "ctest" and "-R" in words and ("--preset" not in words or words[words.index("--preset") + 1] in ("release", "dev")):
            wanted = words[words.index("-R") + 1]
            if not any(re.search(wanted, one) for one in self.tests):
                self.fail(place, f"no test matches {wanted}")
        elif name.endswith("thermopower-gap"):
            self.check_gap(place, words[1:])
        if "release/bin/" in name:
            program = os.path.basename(name)
            if "THERMOPOWER_BENCHMARKS" not in text and program not in {os.path.basename(one) for one in self.targets}:
                self.fail(place, f"no target builds {name}")
            if not re.search(rf"--target [a-z0-9_ -]*\b{re.escape(program)}\b", text):
                self.fail(place, f"the page does not say what builds {program} (cmake --build --preset release --target {program})")

    def check_gap(self, place, words):
        if not words or words[0] not in self.subcommands:
            self.fail(place, f"'{' '.join(words[:1])}' is not a subcommand of thermopower-gap")
            return
        for word in words[1:]:
            if word.startswith("--") and word.split("=")[0] not in self.options[words[0]]:
                self.fail(place, f"thermopower-gap {words[0]} has no option {word}")


def check(root, build, program):
    checker, count = Checker(root, build, program), 0
    for page in pages(root):
        if page in FORMS:
            continue
        with open(os.path.join(root, page), encoding="utf-8") as file:
            text = file.read()
        for number, command in commands(text):
            count += 1
            checker.check(page, number, command, text)
    for one in checker.wrong:
        print(one)
    print(f"{count} commands, {len(checker.wrong)} that cannot work")
    return 1 if checker.wrong or count < 20 else 0


def run(root, chroot):
    with open(os.path.join(root, "README.md"), encoding="utf-8") as file:
        wanted = [command for _, command in commands(file.read()) if not is_form(command)]
    place = tempfile.mkdtemp(prefix="thermopower_readme_", dir=os.path.join(chroot, "tmp") if chroot else None)
    subprocess.run(["git", "clone", "-q", root, os.path.join(place, "thermopower")], check=True)
    inside = "/" + os.path.relpath(place, chroot) if chroot else place
    failed = 0
    for command in wanted:
        # cmake/test.sh --all is a test of its own.
        print(f"== {command}", flush=True)
        script = f"cd {shlex.quote(inside)}/thermopower && {command}"
        words = ["sh", "-c", script]
        status = subprocess.run(["chroot", chroot] + words if chroot else words).returncode
        if status != 0:
            print(f"failed with {status}: {command}", flush=True)
            failed += 1
    shutil.rmtree(place)
    print(f"{len(wanted)} commands of README.md, {failed} failed")
    return 1 if failed else 0


def main():
    if len(sys.argv) == 5 and sys.argv[1] == "check":
        return check(*sys.argv[2:])
    if len(sys.argv) in (3, 5) and sys.argv[1] == "run":
        return run(sys.argv[2], sys.argv[4] if len(sys.argv) == 5 else None)
    print(__doc__, file=sys.stderr)
    return 2


sys.exit(main())
