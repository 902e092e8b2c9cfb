# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Runs of the program and of the baselines, and what they leave."""

import csv
import dataclasses
import json
import math
import os
import pathlib
import shutil
import statistics
import subprocess

TOP = pathlib.Path(__file__).resolve().parents[3]


class Unsupported(Exception):
    """The program does not know an entry or a value."""


class Failed(Exception):
    """A simulation does not converge, or a program is missing."""


@dataclasses.dataclass
class Result:
    """The median of the repetitions of a run."""

    statistics: dict
    probes: dict
    steps: float  # s, without assembly, start and (cached) factorisations
    total: float  # s, with them
    repetitions: int

    def count(self, *path):
        """A counter, 0 if there is none: count("solves", "complex")."""
        value = self.statistics
        for name in path:
            value = value.get(name, 0) if isinstance(value, dict) else 0
        return value

    def solves(self):
        return self.count("solves", "real") + self.count("solves", "complex")

    def factorizations(self):
        return self.count("factorisations", "real") + self.count("factorisations", "complex")

    def seconds(self, phase):
        return self.count("wall time [s]", phase)

    def unknowns(self):
        return sum(body["unknowns"] for body in self.statistics["bodies"].values())


class Bench:
    """Where the programs are, where results go, and how carefully to measure."""

    def __init__(self, build, output, threads=1, repetitions=3, quick=False, longest=600.,
                 models=(), methods=()):
        self.build = pathlib.Path(build)
        self.output = pathlib.Path(output)
        self.threads = threads
        self.repetitions = repetitions
        self.quick = quick
        self.longest = longest
        self.models = models
        self.methods = methods
        self.output.mkdir(parents=True, exist_ok=True)
        count = str(threads)
        self.environment = dict(os.environ, OPENBLAS_NUM_THREADS=count, OMP_NUM_THREADS=count,
                                DEAL_II_NUM_THREADS=count)

    def execute(self, command):
        """The standard output of a program of the build."""
        done = subprocess.run([str(word) for word in command], env=self.environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
        message = (done.stderr.strip().splitlines() or
                   [f"{command[0]} ended with the status {done.returncode}"])[-1]
        if done.returncode == 2:
            raise Unsupported(message)
        if done.returncode != 0:
            raise Failed(message)
        return done.stdout

    def simulate(self, name, model, settings, method="program", options=(), repetitions=None):
        """Runs a model, several times unless that takes longer than a minute.

        name: folder of the results; method: "program", "conventional",
        "explicit" or "calculix"; options: those of baselines.
        """
        folder = self.output / "runs" / name
        if method == "program":
            command = [self.build / "acf-dealii", "--threads", self.threads]
        else:
            command = [self.build / "tests" / "baselines", method, *options]
        for entry, value in settings.items():
            command += ["--set", f"{entry}={value}"]
        command += ["--quiet", "--output-directory", folder, TOP / model]

        runs = []
        wanted = repetitions or self.repetitions
        while len(runs) < wanted:
            shutil.rmtree(folder, ignore_errors=True)
            self.execute(command)
            runs.append(self.read(folder, method))
            if repetitions is None and runs[-1].total > 60:
                break
        runs.sort(key=lambda run: run.steps)
        result = runs[len(runs) // 2]
        result.repetitions = len(runs)
        result.steps = statistics.median(run.steps for run in runs)
        result.total = statistics.median(run.total for run in runs)
        return result

    @staticmethod
    def read(folder, method):
        with open(folder / "statistics.json", encoding="utf-8") as stream:
            counters = json.load(stream)
        times = counters["wall time [s]"]
        steps = times.get("time steps", 0.)
        setup = times.get("assembly", 0.) + times.get("start", 0.)
        total = steps + setup
        if method == "program":
            steps -= times.get("factorisation", 0.)
        return Result(counters, read_table(folder / "probes.csv"), steps, total, 1)

    def write_table(self, name, rows):
        """A file of comma-separated values; rows are dictionaries."""
        names = list(dict.fromkeys(key for row in rows for key in row))
        with open(self.output / name, "w", newline="", encoding="utf-8") as stream:
            writer = csv.DictWriter(stream, names)
            writer.writeheader()
            writer.writerows({key: short(value) for key, value in row.items()} for row in rows)

    @staticmethod
    def say(text):
        print(text, flush=True)


def short(value):
    return f"{value:.6g}" if isinstance(value, float) else value


def read_table(file):
    """Columns of a file of comma-separated values, by their names."""
    if not file.exists():
        return {}
    with open(file, encoding="utf-8", newline="") as stream:
        rows = list(csv.reader(stream))
    columns = zip(*[[number(word) for word in row] for row in rows[1:]])
    return dict(zip(rows[0], map(list, columns)))


def number(word):
    try:
        return float(word)
    except ValueError:
        return word


def distance(run, reference, columns):
    """Largest distance of a point from that of a reference, over all times."""
    times = {f"{t:.9g}": k for k, t in enumerate(reference["time [s]"])}
    largest = 0.
    for k, time in enumerate(run["time [s]"]):
        where = times.get(f"{time:.9g}")
        if where is None:
            raise Failed(f"the reference has no time {time}")
        largest = max(largest, math.dist([run[c][k] for c in columns],
                                         [reference[c][where] for c in columns]))
    return largest


def growth_exponent(sizes, values):
    """Slope of log(values) against log(sizes), by least squares."""
    x = [math.log(size) for size in sizes]
    y = [math.log(value) for value in values]
    mean_x, mean_y = statistics.fmean(x), statistics.fmean(y)
    return (sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) /
            sum((a - mean_x)**2 for a in x))
