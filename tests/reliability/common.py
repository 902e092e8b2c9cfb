# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""What the attacks of this folder share."""

import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

TOP = pathlib.Path(__file__).resolve().parents[2]

# Short runs that use much of the program: joints, restart of step sizes found
# by a tolerance with more factorisations than are kept, files for ParaView.
BASE = ["--quiet", "--threads", "1",
        "--set", "Bodies/pendulum/Element=tetrahedron",
        "--set", "Bodies/pendulum/Cells=1, 8, 1",
        "--set", "Time integration/End time=0.2",
        "--set", "Output/VTU interval=0.01",
        "--set", "Output/Checkpoint interval=0.005"]
MODELS = {
    "fixed steps": [*BASE, "--set", "Time integration/Step size=5e-4"],
    "tolerance": [*BASE, "--set", "Time integration/Tolerance=1e-6",
                  "--set", "Time integration/Factor memory=0.3",
                  "--set", "Output/Probe interval=0.0007"],
    "Green-Lagrange": [*BASE, "--set", "Time integration/Step size=2e-3",
                       "--set", "Bodies/pendulum/Strain=Green-Lagrange"],
}
MODEL_FILE = TOP / "prm" / "pendulum" / "pendulum.prm"


def arguments(description, default_number, what):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("program", type=pathlib.Path, help="acf-dealii")
    parser.add_argument("--number", type=int, default=default_number,
                        help=f"{what}; default: %(default)s")
    parser.add_argument("--seed", type=int, default=int(time.time()),
                        help="of the random numbers; default: the time")
    return parser.parse_args()


class Checks:
    """Counts checks and reports those that fail."""

    def __init__(self):
        self.number = 0
        self.failed = 0

    def __call__(self, holds, message):
        self.number += 1
        if not holds:
            self.failed += 1
            print("FAILED:", message)

    def finish(self):
        print(f"{self.number} checks, {self.failed} failed")
        sys.exit(1 if self.failed or not self.number else 0)


class Folder:
    """A folder for the results of one attack, removed at the end."""

    def __enter__(self):
        self.path = pathlib.Path(tempfile.mkdtemp(prefix="acf-dealii-"))
        return self.path

    def __exit__(self, *_):
        shutil.rmtree(self.path, ignore_errors=True)


def start(program, settings, directory, *options):
    return subprocess.Popen(
        [program, *settings, "--output-directory", directory, *options, MODEL_FILE],
        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def run(program, settings, directory, *options):
    """Exit status and messages."""
    process = start(program, settings, directory, *options)
    messages = process.communicate()[1]
    return process.returncode, messages


def statistics(directory):
    return json.loads((directory / "statistics.json").read_text(encoding="utf-8"))


def lines(file):
    return file.read_text(encoding="utf-8").splitlines() if file.exists() else []
