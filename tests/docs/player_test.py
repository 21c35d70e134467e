#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""The desktop player against controllers on a pseudo terminal: what it stores, and that it ends where it has to.

    player_test.py PLAYER
"""

import os
import pty
import select
import subprocess
import sys
import tempfile
import threading
import tty

PLAYER = sys.argv[1]


class Controller(threading.Thread):
    """Answers each line with what a function makes of it, until the player closes the line."""

    def __init__(self, answer):
        super().__init__(daemon=True)
        self.answer, self.heard = answer, []
        self.master, slave = pty.openpty()
        tty.setraw(slave)
        self.slave, self.port = slave, os.ttyname(slave)
        self.over = False

    def run(self):
        rest = b""
        while not self.over:
            if not select.select([self.master], [], [], 0.1)[0]:
                continue
            rest += os.read(self.master, 4096)
            if rest == b"s":
                rest = b"s\n"
            while b"\n" in rest:
                line, rest = rest.split(b"\n", 1)
                self.heard.append(line.decode())
                os.write(self.master, self.answer(self.heard[-1]).encode())


def play(answer, folder, *options):
    controller = Controller(answer)
    controller.start()
    log = os.path.join(folder, "log.csv")
    done = subprocess.run([sys.executable, PLAYER, "--port", controller.port, "--out", log, *options],
                          capture_output=True, text=True, timeout=60)
    controller.over = True
    controller.join()
    with open(log, encoding="ascii") as file:
        return done, file.read().split("\n"), controller.heard


def expect(condition, *what):
    if not condition:
        sys.exit(f"player_test: {what}")


with tempfile.TemporaryDirectory() as folder:
    schedule = os.path.join(folder, "schedule.csv")
    with open(schedule, "w", encoding="ascii") as file:
        file.write("t_s,drive_A\n0,0.5\n0.05,-0.25\n0.1,0\n")

    done, log, heard = play(lambda line: "angle_deg,rate_dps\r\n" if line == "?" else f"{line},7\r\n", folder, "--schedule", schedule)
    expect(done.returncode == 0, done.stderr)
    expect(log[0] == "t_s,drive_A,angle_deg,rate_dps", log)
    expect([line.split(",")[1:] for line in log[1:4]] == [["0.5", "0.5", "7"], ["-0.25", "-0.25", "7"], ["0", "0", "7"]], log)
    expect(0.09 < float(log[3].split(",")[0]) < 0.5, log)
    expect(heard == ["?", "0.5", "-0.25", "0", "0"], heard)  # at the end everything is at rest

    # A reading beyond its limit ends it, with the input at rest.
    done, log, heard = play(lambda line: "motor_C\n" if line == "?" else "81\n", folder, "--schedule", schedule, "--stop", "motor_C:80")
    expect(done.returncode != 0 and "motor_C is 81, beyond 80" in done.stderr, done.stderr)
    expect(heard == ["?", "0.5", "0"], heard)

    # A controller that falls silent, too.
    done, log, heard = play(lambda line: "motor_C\n" if line == "?" else "", folder, "--schedule", schedule)
    expect(done.returncode != 0 and "expected 1 readings, got None" in done.stderr, done.stderr)
    expect(heard[-1] == "0", heard)

    # A controller that holds the schedule itself.
    done, log, heard = play(lambda line: "t_s,power_param,motor_C\n0,200,22\n1,200,23\n# end\n", folder)
    expect(done.returncode == 0, done.stderr)
    expect(log == ["t_s,power_param,motor_C", "0,200,22", "1,200,23", ""], log)

    # One that stops says why.
    done, log, heard = play(lambda line: "t_s\n# stopped: too hot\n", folder)
    expect(done.returncode != 0 and "stopped: too hot" in done.stderr, done.stderr)
print("player_test: fine")
