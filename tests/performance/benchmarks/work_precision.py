# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Run time against error, of the program and of the baselines."""

import math

from common import Failed, Unsupported, distance


def position(probe, components="xyz"):
    """Columns of a probe that are a position."""
    return [f"{probe}.{c} [m]" for c in components]


# In the plane only: with the reduced strain round-off grows out of it (see
# prm/pendulum/README.md), which is no error of the method.
def pendulum(cells, end_time, youngs_modulus="2.1e8", intervals=50):
    return {
        "file": "prm/pendulum/pendulum.prm",
        "bodies": ["pendulum"],
        "point": position("tip", "yz"),
        "end time": end_time,
        "interval": end_time / intervals,
        "settings": {"Bodies/pendulum/Element": "tetrahedron",
                     "Bodies/pendulum/Cells": cells,
                     "Bodies/pendulum/Young's modulus": youngs_modulus}}


def slider_crank(mesh_size, end_time):
    return {
        "file": "prm/slider-crank/slider-crank-tetrahedra.prm",
        "bodies": ["crank", "rod"],
        "point": position("middle"),
        "end time": end_time,
        "interval": end_time / 50,
        "settings": {"Bodies/crank/Mesh size": mesh_size,
                     "Bodies/rod/Mesh size": mesh_size,
                     "Probes/Names": "crank, rod, slider, middle",
                     "Probes/middle/Type": "point position",
                     "Probes/middle/Of": "rod",
                     "Probes/middle/Point": "0, 0.5, 0"}}


def ivp_slider_crank(end_time):
    return {
        "file": "prm/ivp-slider-crank/ivp-slider-crank.prm",
        "bodies": ["crank", "rod", "block"],
        "point": position("middle"),
        "end time": end_time,
        "interval": end_time / 50,
        "settings": {"Probes/Names": "rod, slider, block pin, drive, middle",
                     "Probes/middle/Type": "point position",
                     "Probes/middle/Of": "rod",
                     "Probes/middle/Point": "0.15, 0, 0"}}


TOLERANCES = ["1e-3", "1e-4", "1e-5", "1e-6", "1e-7"]


# Steps are fractions of the interval between the compared times, mostly the
# fiftieth of the end time.
# "errors of": the explicit method is too slow to be run to the end; its error
# is that of its lumped masses, so that of the model named here.
# "tolerances": all unless given; errors of the IVP slider-crank, 8e-9 m in its
# reference, do not fall below those with 1e-6.
def models(quick):
    if quick:
        return {"pendulum": dict(pendulum("1, 4, 1", 0.01, intervals=10), fractions=[2],
                                 reference=4, conventional=[2], calculix=[1], explicit=True)}
    return {
        "pendulum": dict(pendulum("1, 40, 2", 0.5), fractions=[0.5, 1, 2, 5, 10, 20],
                         reference=50, conventional=[2, 5, 10, 20],
                         calculix=[2, 5, 10], explicit=True),
        "pendulum of steel": dict(pendulum("1, 40, 2", 0.5, "2.1e11"),
                                  fractions=[1, 2, 5, 10, 20], reference=50,
                                  conventional=[], calculix=[], explicit=True,
                                  errors_of="pendulum"),
        "slider-crank": dict(slider_crank("0.025", 1.), fractions=[2, 4, 10, 20, 40],
                             reference=160, conventional=[4, 10, 20, 40], calculix=[],
                             explicit=True),
        "IVP slider-crank": dict(ivp_slider_crank(0.1), fractions=[4, 10, 20, 40, 100, 200],
                                 reference=400, conventional=[10, 20, 40],
                                 calculix=[], explicit=False, tolerances=TOLERANCES[:-1])}


STAGES = "Time integration/Stages"
STEP = "Time integration/Step size"
TOLERANCE = "Time integration/Tolerance"
NEWTON = "Time integration/Newton tolerance"


def variants(quick):
    """Name, strain, settings, and whether the tolerance takes the place of the step size."""
    matrices = "Time integration/Stage matrices"
    precision = "Time integration/Factor precision"
    paper = {matrices: "one-step", precision: "double", NEWTON: 1e-12}
    yield "2 stages", "reduced", {}, False
    yield "one-step matrices", "reduced", {matrices: "one-step"}, False
    yield ("scheme of the paper", "reduced",
           {**paper, "Time integration/Starting values": "zero"}, False)
    yield "scheme of the paper, extrapolated", "reduced", paper, False
    yield "2 stages", "Green-Lagrange", {}, False
    yield "tolerance, 2 stages", "reduced", {}, True
    if quick:
        return
    yield "1 stage", "reduced", {STAGES: 1}, False
    yield "3 stages", "reduced", {STAGES: 3}, False
    yield "3 stages", "Green-Lagrange", {STAGES: 3}, False
    yield "2 stages, double precision", "reduced", {precision: "double"}, False
    yield "2 stages, single precision", "reduced", {precision: "single"}, False
    yield "tolerance, 3 stages", "reduced", {STAGES: 3}, True
    yield "tolerance, 2 stages", "Green-Lagrange", {}, True
    yield "tolerance, 3 stages", "Green-Lagrange", {STAGES: 3}, True


IMPLICIT_BASELINES = (("conventional", "conventional", []),
                      ("conventional, 1 iteration", "conventional", ["--least-iterations", 1]),
                      ("CalculiX", "calculix", []))

BASELINES = ("one-step matrices", "scheme of the paper", "scheme of the paper, extrapolated",
             *(name for name, _, _ in IMPLICIT_BASELINES), "explicit")


def check_names(bench):
    """Methods and models that are asked for exist."""
    names = {name for name, _, _, _ in variants(False)} | set(BASELINES)
    names |= {f"{name} {strain}" for name in names for strain in ("reduced", "Green-Lagrange")}
    for some, known in ((bench.models, models(bench.quick)), (bench.methods, names)):
        for name in some:
            if name not in known:
                raise SystemExit(f"unknown name '{name}'; names are {', '.join(sorted(known))}")


def is_wanted(bench, name, strain):
    return not bench.methods or name in bench.methods or f"{name} {strain}" in bench.methods


class Study:
    """The runs of one model; rows of the table, which is written after each run."""

    def __init__(self, bench, name, model, rows):
        self.bench = bench
        self.name = name
        self.model = model
        self.references = {}
        self.rows = rows

    def settings(self, strain, step_size):
        common = {"Time integration/End time": self.model["end time"],
                  "Output/Probe interval": self.model["interval"],
                  "Output/VTU interval": 0,
                  "Validity/Action": "ignore",
                  STEP: f"{step_size:.9g}"}
        common.update({f"Bodies/{body}/Strain": strain for body in self.model["bodies"]})
        return {**self.model["settings"], **common}

    def step_size(self, fraction):
        return self.model["interval"] / fraction

    def reference(self, strain):
        """3 stages, small steps; twice the step size shows the error."""
        if strain not in self.references:
            runs = []
            for divisor in (1, 2):
                settings = self.settings(strain, self.step_size(
                    self.model["reference"] / divisor))
                settings.update({STAGES: 3, NEWTON: 1e-12})
                runs.append(self.bench.simulate(f"{self.name}, reference, {strain}, {divisor}",
                                                self.model["file"], settings, repetitions=1))
            self.references[strain] = runs[0].probes
            error = distance(runs[1].probes, runs[0].probes, self.model["point"])
            self.bench.say(f"{self.name}, {strain}: reference with steps of "
                           f"{self.step_size(self.model['reference']):.3g} s; twice as long ones "
                           f"change it by {error:.2g} m")
        return self.references[strain]

    def add(self, method, strain, control, value, run, **more):
        """A row; the error is missing for runs that were not to the end."""
        row = {"model": self.name, "unknowns": run.unknowns(), "method": method,
               "strain": strain, "control": control, "value": value,
               "error [m]": more.get("error", ""), "steps [s]": more.get("steps", run.steps),
               "with set-up [s]": more.get("total", run.total), "steps": run.count("steps"),
               "rejected steps": run.count("rejected steps"),
               "iterations": run.count("newton iterations"), "solves": run.solves(),
               "factorisations": run.factorizations(), "repetitions": run.repetitions,
               "note": more.get("note", "")}
        self.rows.append(row)
        self.bench.write_table("work_precision.csv", self.rows)
        self.bench.write_table("work_precision_ratios.csv", ratios(self.rows))
        self.bench.say(f"{self.name}, {strain}, {method}, {control} {value:.3g}: "
                       f"{row['error [m]'] or math.nan:.2g} m, {row['steps [s]']:.3g} s")

    def measure(self, method, strain, control, value, settings, program="program", options=()):
        run = self.bench.simulate(f"{self.name}, {strain}, {method}, {control} {value:.3g}",
                                  self.model["file"], settings, program, options)
        self.add(method, strain, control, value, run,
                 error=distance(run.probes, self.reference(strain), self.model["point"]))

    def run_program(self):
        for name, strain, changes, by_tolerance in variants(self.bench.quick):
            if not is_wanted(self.bench, name, strain):
                continue
            tolerances = self.model.get("tolerances", TOLERANCES)
            values = ([("tolerance", t) for t in tolerances] if by_tolerance else
                      [("step size", f) for f in self.model["fractions"]])
            for control, value in values:
                settings = self.settings(strain, self.step_size(
                    self.model["fractions"][len(self.model["fractions"]) // 2]
                    if by_tolerance else value))
                settings.update(changes)
                if by_tolerance:
                    settings[TOLERANCE] = value
                try:
                    self.measure(name, strain, control,
                                 float(value if by_tolerance else settings[STEP]), settings)
                except Unsupported as error:
                    self.bench.say(f"{self.name}, {name}: left out: "
                                   f"{str(error).split('; allowed')[0]}")
                    break
                except Failed as error:
                    self.bench.say(f"{self.name}, {name}, {control} {value}: {error}")

    def run_implicit_baselines(self):
        for name, program, options in IMPLICIT_BASELINES:
            if not is_wanted(self.bench, name, "Green-Lagrange"):
                continue
            for fraction in self.model[program]:
                settings = self.settings("Green-Lagrange", self.step_size(fraction))
                settings[NEWTON] = 1e-8
                try:
                    self.measure(name, "Green-Lagrange", "step size", float(settings[STEP]),
                                 settings, program, options)
                except Failed as error:
                    self.bench.say(f"{self.name}, {name}, step size {settings[STEP]}: {error}")

    def run_explicit(self):
        """To the end if that does not take too long, else a fiftieth of the time."""
        for strain in ("reduced", "Green-Lagrange"):
            if not is_wanted(self.bench, "explicit", strain):
                continue
            part = 0.02 if not self.bench.quick else 0.5
            settings = self.settings(strain, self.step_size(1))
            short = dict(settings)
            short["Time integration/End time"] = part * self.model["end time"]
            run = self.bench.simulate(f"{self.name}, {strain}, explicit, part",
                                      self.model["file"], short, "explicit")
            step_size = part * self.model["end time"] / run.count("steps")
            seconds = run.steps / part
            if seconds <= self.bench.longest and "errors_of" not in self.model:
                self.measure("explicit", strain, "step size", step_size, settings, "explicit")
            else:
                self.add("explicit", strain, "step size", step_size, run, steps=seconds,
                         total=seconds + run.total - run.steps,
                         note=f"time of {part:g} of the run, extrapolated")


def envelope(points):
    """Of (error, time): those that no other one beats in both, by falling time."""
    best = []
    for error, time in sorted(points):
        if not best or time < best[-1][1]:
            best.append((error, time))
    return best


def time_at_error(points, error):
    """By log-log interpolation of the envelope: nothing below its smallest error, and above
    the largest one the time of that."""
    best = envelope(points)
    if not best or error < best[0][0]:
        return None
    for (e0, t0), (e1, t1) in zip(best, best[1:]):
        if e0 <= error <= e1:
            part = math.log(error / e0) / math.log(e1 / e0)
            return math.exp((1 - part) * math.log(t0) + part * math.log(t1))
    return best[-1][1]


def ratios(rows):
    """Times of the baselines relative to the program at the same error."""
    result = []
    errors = {(row["model"], row["method"], row["strain"]): row["error [m]"] for row in rows}
    for row in rows:
        if row["method"] not in BASELINES:
            continue
        error, note = row["error [m]"], row["note"]
        if error == "":
            source = models(False)[row["model"]].get("errors_of", row["model"])
            error = errors.get((source, row["method"], row["strain"]), "")
            note += f"; error of the model '{source}'"
        if error == "":
            continue
        # who does not need the full strain may also take the reduced one
        for strain in dict.fromkeys(("reduced", row["strain"])):
            own = [other for other in rows if other["model"] == row["model"] and
                   other["strain"] == strain and other["method"] not in BASELINES]
            for name, some in (("2 stages", [o for o in own if o["method"] == "2 stages"]),
                               ("best", own)):
                times = {}
                for column in ("steps [s]", "with set-up [s]"):
                    time = time_at_error([(o["error [m]"], o[column]) for o in some], error)
                    times[column] = row[column] / time if time else ""
                if times["steps [s]"] != "":
                    result.append({"model": row["model"], "baseline": row["method"],
                                   "its strain": row["strain"], "its step size": row["value"],
                                   "error [m]": error, "its steps [s]": row["steps [s]"],
                                   "program": name, "strain": strain,
                                   "ratio of steps": times["steps [s]"],
                                   "ratio with set-up": times["with set-up [s]"],
                                   "note": note})
    return result


def run(bench):
    rows = []
    for name, model in models(bench.quick).items():
        if bench.models and name not in bench.models:
            continue
        study = Study(bench, name, model, rows)
        study.run_program()
        study.run_implicit_baselines()
        if model["explicit"]:
            try:
                study.run_explicit()
            except Failed as error:
                bench.say(f"{name}, explicit: {error}")
