#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""What a fleet costs beside its diagnoses, and how it grows.

    cost.py GENERATE PROGRAM DIR [--logs 1000] [--pairs 5] [--most 10000]

1. Handing out: logs too short for a diagnosis, one worker and two in turns.
2. Two workers: the same with logs whose diagnosis is short but a real one; and two ranks under mpirun.
3. Results that are there: reports of real diagnoses, copied for as many logs as are asked for, read, pooled and written
   again by the same command; by logs, and by logs of one unit.
4. Rows: logs in which nothing is driven, which are read and checked and no more.

Medians of turns, as others may work on the machine. `busy` is the share of the workers' time in which they had a log in
hand; `cpu` the processor time of everything, of children too, so that neither hangs on who else is there.
"""

import argparse
import csv
import os
import re
import shutil
import statistics
import subprocess
import sys
import time

HEADER = "t_s,power_param,ambient_C,motor_C,current_A\n"


class Run:
    """One command: wall and processor time in seconds, memory in MB, and what it printed."""

    def __init__(self, *command):
        began = time.monotonic()
        child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.text = child.stdout.read()
        _, status, used = os.wait4(child.pid, 0)
        self.wall = time.monotonic() - began
        self.cpu = used.ru_utime + used.ru_stime
        self.megabytes = used.ru_maxrss / 1024.0
        if os.waitstatus_to_exitcode(status) not in (0, 3):
            sys.exit(f"{' '.join(command)} failed:\n{self.text}")
        told = re.search(r"(\d+) diagnos[ei]s in ([\d.]+) s with (\d+) at a time: ([\d.]+) ms of work each, workers busy ([\d.]+) %", self.text)
        self.handing, self.busy = (float(told[2]), float(told[5])) if told else (0.0, 0.0)
        self.lost = 10.0 * float(told[2]) * float(told[3]) * (100.0 - self.busy) / float(told[1]) if told else 0.0  # ms a log


def fleet(program, manifest, out, workers=1, under=()):
    return Run(*under, program, "fleet", manifest, "--out", out, "--workers", str(workers), "--no-pages")


def write_logs(folder, model, count, rows, logs_of_unit=1):
    """Logs in which nothing is driven, of so many rows, and their manifest."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(os.path.join(folder, "logs"))
    shutil.copy(model, folder)
    body = HEADER + "".join(f"{2 * i},0,25,25.{i % 3},0\n" for i in range(rows))
    with open(os.path.join(folder, "manifest.csv"), "w", encoding="utf-8") as manifest:
        manifest.write("log,model,unit,time\n")
        for i in range(count):
            with open(os.path.join(folder, "logs", f"t{i:06d}.csv"), "w", encoding="utf-8") as log:
                log.write(body)
            manifest.write(f"logs/t{i:06d}.csv,model.json,u{i // logs_of_unit},{20000 + 30 * (i % logs_of_unit)}\n")
    return os.path.join(folder, "manifest.csv")


def short_logs(folder, real, count, rows):
    """The first rows of real logs, in turns."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(os.path.join(folder, "logs"))
    shutil.copy(os.path.join(real, "model.json"), folder)
    sources = sorted(os.listdir(os.path.join(real, "logs")))
    with open(os.path.join(folder, "manifest.csv"), "w", encoding="utf-8") as manifest:
        manifest.write("log,model,unit\n")
        for i in range(count):
            with open(os.path.join(real, "logs", sources[i % len(sources)]), encoding="utf-8") as log:
                head = log.readlines()[: rows + 1]
            with open(os.path.join(folder, "logs", f"s{i:06d}.csv"), "w", encoding="utf-8") as log:
                log.writelines(head)
            manifest.write(f"logs/s{i:06d}.csv,model.json,u{i}\n")
    return os.path.join(folder, "manifest.csv")


def in_turns(program, manifest, out, pairs):
    """One worker and two, in turns: lists of runs."""
    runs = {1: [], 2: []}
    for _ in range(pairs):
        for workers in runs:
            shutil.rmtree(out, ignore_errors=True)
            runs[workers].append(fleet(program, manifest, out, workers))
    return runs


def median(runs, of):
    return statistics.median(of(one) for one in runs)


def tell_turns(runs, count):
    print("| workers | wall, s | busy, % | lost, ms a log | cpu, ms a log |\n| --- | --- | --- | --- | --- |")
    for workers, of in runs.items():
        print(f"| {workers} | {median(of, lambda r: r.wall):.2f} | {median(of, lambda r: r.busy):.1f} | "
              f"{median(of, lambda r: r.lost):.2f} | {1e3 * median(of, lambda r: r.cpu) / count:.2f} |")
    walls = [one.handing / (2.0 * two.handing) for one, two in zip(runs[1], runs[2])]
    cpus = [one.cpu / two.cpu for one, two in zip(runs[1], runs[2])]
    print(f"\none worker's wall over twice two workers', median of {len(walls)} pairs: {statistics.median(walls):.3f} "
          f"({min(walls):.3f} to {max(walls):.3f})")
    print(f"two workers' busy share times one's processor time over two's: "
          f"{median(runs[2], lambda r: r.busy) / 100.0 * statistics.median(cpus):.3f}\n", flush=True)


def tell_ranks(program, manifest, out, mpirun, pairs):
    """One worker, and two ranks of one worker each, in turns: by the clock, from the command to its end."""
    under = [mpirun, "-n", "2", "--oversubscribe"] + (["--allow-run-as-root"] if os.getuid() == 0 else [])
    shares = []
    for _ in range(pairs):
        shutil.rmtree(out, ignore_errors=True)
        one = fleet(program, manifest, out)
        shutil.rmtree(out, ignore_errors=True)
        shares.append(one.wall / (2.0 * fleet(program, manifest, out, 1, under).wall))
    print(f"one worker's wall over twice two ranks' under mpirun, its start and end included, median of {pairs} pairs: "
          f"{statistics.median(shares):.3f} ({min(shares):.3f} to {max(shares):.3f})\n", flush=True)


def copied_reports(program, folder, manifest, reports):
    """Has the fleet make reports of nothing, and puts real ones in their places."""
    out = os.path.join(folder, "out")
    fleet(program, manifest, out, 2)
    with open(os.path.join(out, "logs.csv"), newline="", encoding="utf-8") as table:
        names = [row["report"] for row in csv.DictReader(table)]
    for i, name in enumerate(names):
        with open(os.path.join(out, name), "wb") as file:
            file.write(reports[i % len(reports)])
    return out


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("generate")
    parser.add_argument("program")
    parser.add_argument("directory")
    parser.add_argument("--logs", type=int, default=1000, help="handed out in turns")
    parser.add_argument("--short", type=int, default=1000, help="short diagnoses in turns")
    parser.add_argument("--pairs", type=int, default=5, help="turns of one worker and two")
    parser.add_argument("--most", type=int, default=10000, help="logs whose reports are there")
    parser.add_argument("--mpirun", default=shutil.which("mpirun"), help="Open MPI's; without it no ranks are measured")
    asked = parser.parse_args()
    shutil.rmtree(asked.directory, ignore_errors=True)
    real, some = os.path.join(asked.directory, "real"), os.path.join(asked.directory, "some")
    Run(asked.generate, "--out", real, "--units", "24", "--seed", "7")
    model = os.path.join(real, "model.json")

    print(f"## Handing out: {asked.logs} logs of 3 rows\n")
    tell_turns(in_turns(asked.program, write_logs(some, model, asked.logs, 3), os.path.join(some, "out"), asked.pairs), asked.logs)

    rows = 100
    print(f"## Two workers: {asked.short} diagnoses of {rows} rows\n")
    manifest, out = short_logs(some, real, asked.short, rows), os.path.join(some, "out")
    tell_turns(in_turns(asked.program, manifest, out, asked.pairs), asked.short)
    if asked.mpirun:
        tell_ranks(asked.program, manifest, out, asked.mpirun, asked.pairs)

    fleet(asked.program, os.path.join(real, "manifest.csv"), os.path.join(real, "out"), 2)
    reports = []
    for name in sorted(os.listdir(os.path.join(real, "out", "reports"))):
        if name.endswith(".json"):
            with open(os.path.join(real, "out", "reports", name), "rb") as file:
                reports.append(file.read())
    print(f"## Results that are there: read, pooled, written (reports of {sum(map(len, reports)) / len(reports) / 1e3:.0f} kB)\n")
    print("| logs | units | wall, s | cpu, ms a log | memory, MB | database, MB | page, MB |\n| --- | --- | --- | --- | --- | --- | --- |")
    count = 100
    while count <= asked.most:
        for logs_of_unit in (1, 8):
            manifest = write_logs(some, model, count, 3, logs_of_unit)
            out = copied_reports(asked.program, some, manifest, reports)
            run = fleet(asked.program, manifest, out)
            size = lambda name: os.path.getsize(os.path.join(out, name)) / 1e6
            print(f"| {count} | {-(-count // logs_of_unit)} | {run.wall:.2f} | {1e3 * run.cpu / count:.2f} | {run.megabytes:.0f} | "
                  f"{size('fleet.sqlite'):.1f} | {size('fleet.html'):.1f} |", flush=True)
        count *= 10

    print("\n## Rows: 20 logs in which nothing is driven\n\n| rows | cpu, ms a log | of a row, us |\n| --- | --- | --- |")
    for rows in (3, 1000, 10000, 100000):
        manifest = write_logs(some, model, 20, rows)
        run = fleet(asked.program, manifest, os.path.join(some, "out"), 1)
        print(f"| {rows} | {1e3 * run.cpu / 20:.1f} | {1e6 * run.cpu / 20 / rows:.2f} |", flush=True)
    shutil.rmtree(asked.directory, ignore_errors=True)


if __name__ == "__main__":
    main()
