#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Kills runs at random times, again and again, and restarts them: the results must be those of
a run that nobody has killed, to the last bit.

One kill in four is SIGTERM, which leaves a checkpoint; the others are SIGKILL.
"""

import random
import signal
import subprocess
import time

from common import MODELS, Checks, Folder, arguments, lines, run, start, statistics


def restart_options(directory):
    """From the newest checkpoint, or from the beginning if there is none."""
    newest = directory / "checkpoint.h5"
    return ["--restart", newest] if newest.exists() else ["--overwrite"]


def entries(directory):
    """The list of the files for ParaView, without its date."""
    return [line for line in lines(directory / "solution.pvd") if "DataSet" in line]


def check_log(check, directory, reference):
    """The file of the probes is readable at any time, and so far the same."""
    found = (directory / "probes.csv").read_bytes() if (directory / "probes.csv").exists() else b""
    check(reference.startswith(found),
          f"probes.csv is something else after a kill, {len(found)} bytes")


def attack(program, name, settings, n_kills, check, rng):
    """Runs until the given number of kills are done. Returns the kills that met a run."""
    with Folder() as top:
        before = time.monotonic()
        status, messages = run(program, settings, top / "whole")
        seconds = time.monotonic() - before
        check(status == 0, f"{name}: the run without kills fails: {messages}")
        reference = (top / "whole" / "probes.csv").read_bytes()
        n_hits = n_done = n_restarts = 0
        while n_hits < n_kills:
            directory = top / "killed"
            options = ["--overwrite"]
            # until the run is done, at most ten kills
            for _ in range(10):
                process = start(program, settings, directory, *options)
                by_term = rng.random() < 0.25
                try:
                    process.wait(rng.uniform(0.2, 1.) * seconds if n_hits < n_kills else None)
                except subprocess.TimeoutExpired:
                    process.send_signal(signal.SIGTERM if by_term else signal.SIGKILL)
                messages = process.communicate()[1]
                if process.returncode == 0:
                    break
                n_hits += 1
                check(process.returncode in (-signal.SIGKILL, -signal.SIGTERM) or
                      (by_term and process.returncode == 1 and "--restart" in messages),
                      f"{name}: exit status {process.returncode}: {messages}")
                check_log(check, directory, reference)
                options = restart_options(directory)
                n_restarts += options[0] == "--restart"
            else:
                status, messages = run(program, settings, directory, *options)
                check(status == 0, f"{name}: the last restart fails: {messages}")
            n_done += 1
            check((directory / "probes.csv").read_bytes() == reference,
                  f"{name}: other probes after kills")
            check(entries(directory) == entries(top / "whole"),
                  f"{name}: another solution.pvd after kills")
            for file in sorted((top / "whole").glob("*.vtu")):
                check((directory / file.name).read_bytes() == file.read_bytes(),
                      f"{name}: another {file.name} after kills")
            check(not list(directory.glob("*.tmp")), f"{name}: temporary files are left")
            for entry in ("steps", "newton iterations", "rejected steps", "probe rows"):
                check(statistics(directory)[entry] == statistics(top / "whole")[entry],
                      f"{name}: other {entry} in statistics.json after kills")
        print(f"{name}: {n_hits} kills of {n_done} runs, {n_restarts} restarts from checkpoints")


def main():
    options = arguments(__doc__.splitlines()[0], 200, "kills of all models together")
    rng = random.Random(options.seed)
    print("seed", options.seed)
    check = Checks()
    for name, settings in MODELS.items():
        attack(options.program, name, settings, -(-options.number // len(MODELS)), check, rng)
    check.finish()


if __name__ == "__main__":
    main()
