#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""Plays an experiment over a serial line, and stores the log that thermopower-gap diagnose reads.

    player.py --port /dev/ttyUSB0 --out second.csv
        The controller holds the schedule itself (examples/nano_player): it gets an `s`, and its lines are stored up to `# end`.

    player.py --port /dev/ttyUSB0 --schedule schedule.csv --out second.csv [--stop motor_C:80]
        The controller is told each row at its time. It answers the line `?` with the names of what it measures
        (`angle_deg,rate_dps`), and a line of inputs (`0.25`) with a line of readings (`12.5,-3.1`). At the end, and when something
        goes wrong, it gets a line of the inputs at rest: zeros. An answer that is late by a second ends the experiment.

Needs Python 3 and nothing else. --stop NAME:VALUE ends the experiment as soon as that reading is beyond the value.
"""

import argparse
import csv
import os
import select
import sys
import termios
import time
import tty

BAUDS = {9600: termios.B9600, 19200: termios.B19200, 38400: termios.B38400, 57600: termios.B57600, 115200: termios.B115200,
         230400: termios.B230400}


class Line:
    """A serial line, read and written a line at a time."""

    def __init__(self, path, baud):
        self.file = os.open(path, os.O_RDWR | os.O_NOCTTY)
        if os.isatty(self.file):
            tty.setraw(self.file)
            attributes = termios.tcgetattr(self.file)
            attributes[4] = attributes[5] = BAUDS[baud]
            termios.tcsetattr(self.file, termios.TCSANOW, attributes)
        self.rest = b""

    def write(self, text):
        os.write(self.file, text.encode("ascii"))

    def read(self, patience_s):
        """The next line without its end; None where none comes in time."""
        until = time.monotonic() + patience_s
        while b"\n" not in self.rest:
            left = until - time.monotonic()
            if left <= 0.0 or not select.select([self.file], [], [], left)[0]:
                return None
            try:
                part = os.read(self.file, 4096)
            except OSError:
                return None
            if not part:
                return None
            self.rest += part
        line, self.rest = self.rest.split(b"\n", 1)
        return line.decode("ascii", "replace").strip()


def read_schedule(path):
    with open(path, newline="", encoding="ascii") as file:
        rows = list(csv.reader(file))
    if not rows or rows[0][0] != "t_s" or len(rows) < 2:
        sys.exit(f"{path}: expected a schedule with a header line that begins with t_s, as thermopower-gap design writes it")
    return rows[0][1:], [(float(row[0]), row[1:]) for row in rows[1:]]


def held_by_controller(line, out):
    line.write("s")
    while True:
        text = line.read(10.0)
        if text is None:
            return "the controller has been silent for 10 s"
        if text.startswith("# end"):
            return None
        if text.startswith("#"):
            return text[1:].strip()
        out.write(text + "\n")


def told_by_us(line, names, rows, stop, out):
    at_rest = ",".join("0" for _ in names) + "\n"
    try:
        line.write("?\n")
        header = line.read(5.0)
        if not header:
            return "the controller does not answer the line '?' with the names of what it measures"
        measured = header.split(",")
        out.write(",".join(["t_s", *names, *measured]) + "\n")
        begin = time.monotonic()
        for t_s, values in rows:
            time.sleep(max(0.0, begin + t_s - time.monotonic()))
            told_s = time.monotonic() - begin
            line.write(",".join(values) + "\n")
            answer = line.read(1.0)
            if answer is None or len(answer.split(",")) != len(measured):
                return f"at {told_s:.3f} s: expected {len(measured)} readings, got {answer!r}"
            out.write(",".join([f"{told_s:.6f}", *values, answer]) + "\n")
            for name, most in stop:
                reading = answer.split(",")[measured.index(name)] if name in measured else ""
                if reading and abs(float(reading)) > most:
                    return f"at {told_s:.3f} s: {name} is {reading}, beyond {most:g}"
        return None
    finally:
        line.write(at_rest)


def limit(text):
    name, _, value = text.partition(":")
    return name, float(value)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--port", required=True, help="serial device, such as /dev/ttyUSB0")
    parser.add_argument("--baud", type=int, choices=sorted(BAUDS), default=115200)
    parser.add_argument("--schedule", help="a schedule that the controller is told row by row")
    parser.add_argument("--out", required=True, help="where the log goes (CSV)")
    parser.add_argument("--stop", type=limit, action="append", default=[], metavar="NAME:VALUE",
                        help="end when a reading is beyond this; may be repeated")
    given = parser.parse_args()
    schedule = read_schedule(given.schedule) if given.schedule else None
    line = Line(given.port, given.baud)
    with open(given.out, "w", encoding="ascii", buffering=1) as out:
        problem = told_by_us(line, *schedule, given.stop, out) if schedule else held_by_controller(line, out)
    if problem:
        sys.exit(f"stopped: {problem}")
    print(f"{given.out}: done")


if __name__ == "__main__":
    main()
