# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""Changes one place of a header at a time and tells whether a test notices.

    python3 mutation.py [--build DIR] [--jobs N] [--sample N --seed S] [--sanitizers] [--known] [GROUP or HEADER ...]

Each change is compiled into the tests that include the header, which are then run until one fails; changes in the bodies of
functions are compiled all at once and chosen when the tests run, others one at a time. What no test fails for is
compiled once more with optimisation, together with instances/GROUP.cpp, which instantiates all of the header: the same object code
as of the original is the same behaviour. With --sanitizers what is left of those compiled at once runs again under the address and
undefined-behaviour sanitizers. What still survives must be explained in tests/mutation/survivors.md by a line
"- `HEADER` `CODE` -> `CHANGED`", and what stands there must survive: the exit status is 0 only when both hold.

Results are kept in DIR/journal.jsonl under a hash of the group's headers, its tests and the compiler, so that a run that was stopped goes
on where it was. --known takes what was found before, whatever has changed since, but for what survived and is not explained: for writing
tests.
"""
import argparse
import concurrent.futures
import glob
import hashlib
import json
import os
import queue
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import threading
import time

import changes

HERE = os.path.dirname(os.path.realpath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
INCLUDE = os.path.join(ROOT, "include")
PAGE = os.path.join(HERE, "survivors.md")
# Of each group: its headers, and its tests in the order in which they are asked, those that take long last; those of one list are
# compiled as one.
GROUPS = {
    "codec": (["sbgc/*.hpp", "sbgc/detail/*.hpp"],
              [["sbgc/%s_test.cpp" % name for name in ("encode", "messages", "refusals", "receiver", "poller", "golden", "known_bugs", "damage")]]),
    "limiters": (["control/safety_limiter.hpp", "control/node_limiter.hpp", "control/sensor_limiter.hpp", "control/limiter_chain.hpp",
                  "control/limit_reason.hpp"],
                 [["control/safety_limiter_test.cpp"], ["control/sensor_limiter_test.cpp"], ["control/limiter_chain_test.cpp"],
                  ["control/nodes_and_laws_test.cpp"], ["control/protection_test.cpp"], ["control/decisions_test.cpp"],
                  ["control/failures_of_others_test.cpp"], ["control/axis_controller_test.cpp"], ["control/gimbal_controller_test.cpp"],
                  ["control/config_record_test.cpp"]]),
}
# Of the processor, so that a busy machine changes no result; the tests of one stage take below 2.
TEST_S, MEMORY_BYTES = 5, 4 << 30
PLAIN = ["-std=gnu++17", "-w", "-g0", '-DTHERMOPOWER_TEST_DATA="%s"' % os.path.join(ROOT, "tests", "data")]
SANITIZERS = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
KILLED, NOT_COMPILED, SAME, SURVIVED = "killed", "does not compile", "same code", "survived"


def run(command, seconds=1200, of_processor=None, memory=None):
    """Exit status, or None when it took too long, and what it printed."""
    def limit():
        for kind, most in ((resource.RLIMIT_CPU, of_processor), (resource.RLIMIT_AS, memory)):
            if most is not None:
                resource.setrlimit(kind, (most, most))
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=seconds, preexec_fn=limit, check=False)
    except subprocess.TimeoutExpired:
        return None, ""
    if of_processor and done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return None, ""
    return done.returncode, done.stdout.decode(errors="replace")


def must(command):
    status, output = run(command)
    if status != 0:
        sys.exit("%s\n%s" % (" ".join(command), output))


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def digest(*texts):
    return hashlib.sha256("\0".join(texts).encode()).hexdigest()[:16]


class Tools:
    """The compiler, and what is compiled once: Catch's main, and its header with those of the standard library."""

    def __init__(self, build, sanitize):
        self.sanitize = sanitize
        self.compiler = shutil.which("clang++") or shutil.which("g++") or sys.exit("SKIPPED: neither clang++ nor g++")
        self.clang = "clang" in os.path.basename(self.compiler)
        self.version = "; ".join(run([one, "--version"])[1].split("\n")[0] for one in dict.fromkeys([self.compiler, shutil.which("g++")]) if one)
        self.linker = ["-fuse-ld=lld"] if shutil.which("ld.lld") and self.clang else []
        # clang has no flag that keeps every inline function.
        self.keeps = shutil.which("g++")
        self.errors = ["-ferror-limit=0"] if self.clang else ["-fmax-errors=0"]
        self.before, self.main = {}, {}
        used = set()
        for test in glob.glob(os.path.join(ROOT, "tests", "*", "*_test.cpp")) + glob.glob(os.path.join(ROOT, "tests", "*", "*.hpp")):
            used.update(re.findall(r"^#include <(c?[a-z_]+)>$", read(test), re.M))
        for name, flags in (("plain", ["-O0"]), ("sanitized", ["-O1"] + SANITIZERS))[:2 if sanitize else 1]:
            directory = os.path.join(build, name)
            os.makedirs(directory, exist_ok=True)
            header = os.path.join(directory, "before.hpp")
            with open(header, "w", encoding="utf-8") as file:
                file.write('#include "%s"\n' % os.path.join(ROOT, "tests", "catch.hpp"))
                file.writelines("#include <%s>\n" % one for one in sorted(used))
            if self.clang:
                must([self.compiler, *PLAIN, *flags, "-fpch-instantiate-templates", "-x", "c++-header", header, "-o", header + ".pch"])
                self.before[name] = flags + ["-include-pch", header + ".pch"]
            else:
                must([self.compiler, *PLAIN, *flags, "-x", "c++-header", header, "-o", header + ".gch"])
                self.before[name] = flags + ["-include", header]
            self.main[name] = os.path.join(directory, "main.o")
            source = os.path.join(directory, "main.cpp")
            with open(source, "w", encoding="utf-8") as file:
                file.write('#include "%s"\n' % os.path.join(ROOT, "tests", "catch_main.cpp"))
                file.write('extern int mutation_number;\nint mutation_number;\n'
                           '__attribute__((constructor(101))) static void choose() { mutation_number = std::atoi(std::getenv("MUTATION")); }\n')
            must([self.compiler, *PLAIN, *flags, "-c", source, "-o", self.main[name]])


    def compile(self, include, source, output, flags):
        return run([self.compiler, *PLAIN, *flags, "-I", include, "-c", source, "-o", output])

    def program(self, include, source, output, kind):
        """Compiles one stage; exit status and what was said."""
        status, said = self.compile(include, source, output + ".o", self.before[kind] + self.errors)
        if status != 0:
            return status, said
        return run([self.compiler, *(SANITIZERS if kind == "sanitized" else []), *self.linker, self.main[kind], output + ".o", "-o", output])

    def answer(self, program, kind, number=0):
        """(result, which test) of one stage that is compiled."""
        plain = kind == "plain"
        status, output = run(["env", "MUTATION=%d" % number, program, "--abort"],
                             of_processor=TEST_S * (1 if plain else 6), memory=MEMORY_BYTES if plain else None)
        if status == 0:
            return SURVIVED, ""
        if status is None:
            return KILLED, "it took too long"
        failed = re.search(r"^-{60,}\n(.*?)\n", output, re.M)
        if not plain and ("runtime error" in output or "AddressSanitizer" in output):
            return KILLED, "a sanitizer"
        return KILLED, failed.group(1) if failed else "it broke off"


class Group:
    def __init__(self, name, build):
        self.name = name
        patterns, tests = GROUPS[name]
        self.headers = [os.path.relpath(path, os.path.join(INCLUDE, "thermopower")) for pattern in patterns
                        for path in sorted(glob.glob(os.path.join(INCLUDE, "thermopower", pattern)))]
        self.stages, sources = [], []
        os.makedirs(os.path.join(build, name), exist_ok=True)
        for number, stage in enumerate(tests):
            found = [path for pattern in stage for path in sorted(glob.glob(os.path.join(ROOT, "tests", pattern)))]
            sources += found
            source = os.path.join(build, name, "stage%d.cpp" % number)
            with open(source, "w", encoding="utf-8") as file:
                file.writelines('#include "%s"\n' % path for path in found)
            self.stages.append((source, found))
        self.instances = os.path.join(HERE, "instances", name + ".cpp")
        beside = {path for source in sources for path in glob.glob(os.path.join(os.path.dirname(source), "*.hpp"))}
        self.tests = digest(*map(read, sources + sorted(beside) + [self.instances]))
        self.state = digest(self.tests, *(read(os.path.join(INCLUDE, "thermopower", header)) for header in self.headers))
        self.included = {}

    def stages_of(self, header):
        """The tests that include the header, that of its own name first."""
        own = os.path.basename(header)[:-len(".hpp")] + "_test.cpp"
        stages = [stage for stage in self.stages if header in self.included[stage[0]]]
        return sorted(stages, key=lambda stage: own not in map(os.path.basename, stage[1]))


class Worker:
    """A copy of the headers, one of which is changed."""

    def __init__(self, tools, directory):
        self.tools, self.directory = tools, directory
        self.include = os.path.join(directory, "include")
        shutil.rmtree(directory, ignore_errors=True)
        shutil.copytree(INCLUDE, self.include)
        self.original_code = {}

    def compile(self, source, output, flags):
        return self.tools.compile(self.include, source, output, flags)

    def code(self, group):
        output = os.path.join(self.directory, "instances.o")
        command = [self.tools.keeps, *PLAIN, "-O1", "-fkeep-inline-functions", "-I", self.include, "-c", group.instances, "-o", output]
        if run(command)[0] != 0:
            return None
        with open(output, "rb") as file:
            return file.read()

    def ask(self, stage, kind):
        """(result, which test) of one stage, compiled for this change alone."""
        program = os.path.join(self.directory, "test")
        status, output = self.tools.program(self.include, stage[0], program, kind)
        return self.tools.answer(program, kind) if status == 0 else (NOT_COMPILED, output)

    def original(self, group):
        """The tests of what is not changed pass; what they include; the object code."""
        for stage in group.stages:
            status, output = run([self.tools.compiler, *PLAIN, "-I", self.include, "-MM", stage[0]])
            group.included[stage[0]] = {os.path.relpath(path, os.path.join(self.include, "thermopower"))
                                        for path in re.findall(r"[^\s\\]+\.hpp", output)}
            for kind in self.tools.before:
                result, output = self.ask(stage, kind)
                if result != SURVIVED:
                    sys.exit("the unchanged tests fail: %s %s\n%s" % (stage[1], result, output))
        if self.tools.keeps and self.code(group) is None:
            sys.exit("%s does not compile" % group.instances)

    def changed(self, header, text):
        with open(os.path.join(self.include, "thermopower", header), "w", encoding="utf-8") as file:
            file.write(text)

    def result(self, group, header, text, change, together):
        """(result, by which test) of one change; `together` answers for those that were compiled together."""
        asked = together.ask if together else lambda stage, kind: self.ask(stage, kind)
        try:
            for kind in ("plain", "sanitized") if self.tools.sanitize and together else ("plain",):
                self.changed(header, change.applied(text))
                for stage in group.stages_of(header):
                    result, by = asked(stage, kind)
                    if result != SURVIVED:
                        return result, by if result == KILLED else ""
                if kind == "plain":
                    code = self.code(group) if self.tools.keeps else None
                    self.changed(header, text)
                    if code is not None and group.name not in self.original_code:
                        self.original_code[group.name] = self.code(group)
                    if code is not None and code == self.original_code[group.name]:
                        return SAME, ""
            return SURVIVED, ""
        finally:
            self.changed(header, text)


class Together:
    """The changes of one header in one program: compiled once, asked one after the other."""

    def __init__(self, tools, directory, group, header, numbered):
        self.tools, self.directory, self.group, self.header = tools, directory, group, header
        self.include = os.path.join(directory, "include")
        self.lock, self.programs = threading.Lock(), {}
        self.text = read(os.path.join(INCLUDE, "thermopower", header))
        self.numbered = numbered
        self.held = self.refused = None

    def prepare(self):
        """Leaves out what does not compile: the compiler's errors name the lines."""
        with self.lock:
            if self.held is not None:
                return
            shutil.rmtree(self.directory, ignore_errors=True)
            shutil.copytree(INCLUDE, self.include)
            left, self.refused, status = self.numbered, set(), 0
            while True:
                text, owner, held = changes.all_in_one(self.text, left)
                path = os.path.join(self.include, "thermopower", self.header)
                with open(path, "w", encoding="utf-8") as file:
                    file.write(text)
                wrong = set()
                for stage in self.group.stages_of(self.header):
                    status, said = self.build(stage, "plain")
                    if status != 0:
                        for error in re.split(r"^(?=\S+:\d+:\d+: (?:fatal )?error: )", said, flags=re.M)[1:]:
                            lines = [int(line) for line in re.findall(r"^%s:(\d+):" % re.escape(path), error, re.M)]
                            wrong.update([owner[line] for line in lines if line in owner][:1])
                        break
                if status == 0 or not wrong:
                    self.held = set(held) if status == 0 else set()
                    return
                self.refused |= wrong
                left = [one for one in left if one[0] not in wrong]

    def build(self, stage, kind):
        program = os.path.join(self.directory, os.path.basename(stage[0])[:-len(".cpp")] + "_" + kind)
        done = self.tools.program(self.include, stage[0], program, kind)
        self.programs[stage[0], kind] = program
        return done

    def of(self, number):
        """Something to ask for this change, or None when it has to be compiled alone."""
        self.prepare()
        return Asked(self, number) if number in self.held else None


class Asked:
    def __init__(self, together, number):
        self.together, self.number = together, number

    def ask(self, stage, kind):
        with self.together.lock:
            if (stage[0], kind) not in self.together.programs:
                status, said = self.together.build(stage, kind)
                if status != 0:
                    sys.exit(said)
        return self.together.tools.answer(self.together.programs[stage[0], kind], kind, self.number)


def shown(header, text, change):
    """The changed line as it is named in the page; a number tells equal ones apart."""
    first = text.rfind("\n", 0, change.at) + 1
    last = (text + "\n").index("\n", change.end)
    squeeze = lambda code: re.sub(r"\s+", " ", re.sub(r"\s*//.*", "", code, flags=re.M)).strip()
    return "`%s` `%s` -> `%s`" % (header, squeeze(text[first:last]), squeeze(text[first:change.at] + change.new + text[change.end:last]))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", default=os.path.join(ROOT, "build", "mutation"))
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--sample", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--known", action="store_true")
    parser.add_argument("--sanitizers", action="store_true")
    parser.add_argument("--list", action="store_true", help="only what would be changed")
    parser.add_argument("wanted", nargs="*")
    options = parser.parse_args()
    build = os.path.realpath(options.build)
    os.makedirs(build, exist_ok=True)
    groups = [Group(name, build) for name in GROUPS
              if not options.wanted or name in options.wanted or any(header in options.wanted for header in Group(name, build).headers)]
    work = []
    for group in groups:
        for header in group.headers:
            if options.wanted and group.name not in options.wanted and header not in options.wanted:
                continue
            text = read(os.path.join(INCLUDE, "thermopower", header))
            seen = {}
            for change in changes.changes(text):
                name = shown(header, text, change)
                seen[name] = seen.get(name, 0) + 1
                work.append((group, header, text, change, name + (" (%d)" % seen[name] if seen[name] > 1 else ""), len(work) + 1))
    all_of_it = len(work)
    if options.sample and options.sample < len(work):
        work = sorted(random.Random(options.seed).sample(work, options.sample), key=lambda one: one[4])
    if options.list:
        for _, header, text, change, name, _ in work:
            print("%s:%d: %s: %s" % (header, text.count("\n", 0, change.at) + 1, change.what, name))
        return 0

    tools = Tools(build, options.sanitizers)
    journal = os.path.join(build, "journal.jsonl")
    known, before, explained = {}, {}, explanations()
    if os.path.exists(journal):
        for line in read(journal).splitlines():
            entry = json.loads(line)
            known[entry["key"], entry["name"]] = entry
            before[entry["name"]] = entry
    started = time.time()
    workers = queue.Queue()
    for number in range(options.jobs):
        workers.put(Worker(tools, os.path.join(build, "worker%d" % number)))
    first = workers.get()
    for group in groups:
        first.original(group)
    workers.put(first)
    results = []
    key_of = {group.name: digest(group.state, tools.version, "sanitized" * tools.sanitize) for group in groups}
    together = {}
    for group, header, _, change, name, number in work:
        together.setdefault(header, Together(tools, os.path.join(build, "together", digest(header)), group, header, []))
        if (key_of[group.name], name) not in known:
            together[header].numbered.append((number, change))

    def one(item):
        group, header, text, change, name, number = item
        key = key_of[group.name]
        entry = known.get((key, name))
        if entry is None and options.known and name in before and (before[name]["result"] != SURVIVED or name in explained):
            entry = before[name]
        if entry is None:
            worker = workers.get()
            try:
                began = time.time()
                asked = together[header].of(number)
                result, by = (NOT_COMPILED, "") if number in together[header].refused else worker.result(group, header, text, change, asked)
            finally:
                workers.put(worker)
            entry = {"key": key, "name": name, "header": header, "what": change.what, "line": text.count("\n", 0, change.at) + 1,
                     "result": result, "by": by, "seconds": round(time.time() - began, 2)}
            with open(journal, "a", encoding="utf-8") as file:
                file.write(json.dumps(entry) + "\n")
        return entry

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for entry in pool.map(one, work):
            results.append(entry)
            if sys.stderr.isatty():
                print("\r%d of %d" % (len(results), len(work)), end="", file=sys.stderr)
    return report(results, all_of_it, tools, time.time() - started)


def explanations():
    page = read(PAGE) if os.path.exists(PAGE) else ""
    return set(re.findall(r"^- (`\S+` `.+?` -> `.*?`(?: \(\d+\))?)(?=: |$)", page, re.M))


def report(results, all_of_it, tools, seconds):
    print("%s; %d of %d changes; %.0f s in this run" % (tools.version, len(results), all_of_it, seconds))
    print("| header | changes | do not compile | same code | fail a test | survive |\n| --- | ---: | ---: | ---: | ---: | ---: |")
    order = (NOT_COMPILED, SAME, KILLED, SURVIVED)
    for header in list(dict.fromkeys(entry["header"] for entry in results)) + ["all"]:
        of = [entry["result"] for entry in results if header in ("all", entry["header"])]
        print("| %s | %d | %s |" % (header if header == "all" else "`%s`" % header, len(of), " | ".join(str(of.count(one)) for one in order)))
    explained = explanations()
    wrong = 0
    for entry in results:
        if entry["result"] == SURVIVED:
            wrong += entry["name"] not in explained
            print("%s:%d: %s: %s" % (entry["header"], entry["line"], entry["name"],
                                     "survives, explained in survivors.md" if entry["name"] in explained else "SURVIVES"))
        elif entry["name"] in explained:
            wrong += 1
            print("%s is explained in survivors.md, but is: %s" % (entry["name"], entry["result"]))
    if len(results) == all_of_it:
        asked = {entry["header"] for entry in results}
        for name in sorted(explained - {entry["name"] for entry in results}):
            if name.split("`")[1] in asked:
                wrong += 1
                print("%s is explained in survivors.md, but gone" % name)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
