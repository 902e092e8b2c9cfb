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
import xml.etree.ElementTree

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
    "XDMF": [*BASE, "--set", "Time integration/Step size=5e-4",
             "--set", "Output/VTU fields=velocity, peak von Mises stress",
             "--set", "Output/Format=XDMF"],
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


def list_of_fields(directory):
    """The file for ParaView that lists the others, if there is one."""
    return next((directory / name for name in ("solution.pvd", "solution.xdmf")
                 if (directory / name).exists()), None)


def field_files(directory):
    """The files that are listed there, and others of this kind."""
    return sorted([*directory.glob("solution*.vtu"), *directory.glob("solution*.h5")])


def entries(directory):
    """What is listed for each time, without the date that solution.pvd has in a comment, and the
    names of the files."""
    file = list_of_fields(directory)
    if file is None:
        return []
    root = xml.etree.ElementTree.parse(file).getroot()
    if file.suffix == ".pvd":
        return [(xml.etree.ElementTree.tostring(entry).strip(), {entry.get("file")})
                for entry in root.iter("DataSet")]
    return [(xml.etree.ElementTree.tostring(entry),
             {item.text.split(":")[0] for item in entry.iter("DataItem")})
            for entry in root.findall("Domain/Grid/Grid")]


def check_fields(check, what, directory, reference):
    """Whatever has happened: each file under its name is that of the whole run, and all that are
    listed are there. Returns what is listed."""
    listed = entries(directory)
    for name in sorted(set().union(*(names for _, names in listed))):
        check((directory / name).exists(), f"{what}: {name} is listed, but not there")
    for file in field_files(directory):
        check(file.read_bytes() == (reference / file.name).read_bytes(),
              f"{what}: {file.name} is something else")
    return listed
