#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Plots the chord's angle, the mid-span deflection and the energies of runs.

Needs python3-numpy and python3-matplotlib.
"""

import argparse
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def read(file):
    """Columns of a file of comma-separated values, by their names."""
    with open(file, encoding="utf-8") as stream:
        names = stream.readline().rstrip("\n").split(",")
        table = np.loadtxt(stream, delimiter=",", ndmin=2)
    return dict(zip(names, table.T))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("probes", nargs="+", help="probes.csv of one or more runs")
    parser.add_argument("--reference", action="append", default=[], metavar="FILE",
                        help="curves with the columns time [s], angle [rad], "
                        "deflection [m]; repeatable")
    parser.add_argument("--output", default="pendulum.png", help="default: %(default)s")
    parser.add_argument("--until", type=float, metavar="T", help="last time to plot, s")
    arguments = parser.parse_args()

    figure, (angle, deflection, energy) = plt.subplots(
        3, 1, sharex=True, figsize=(7, 8), constrained_layout=True)
    for file in arguments.probes:
        run = read(file)
        time = run["time [s]"]
        label = pathlib.Path(file).resolve().parent.name
        angle.plot(time, run["chord.angle [rad]"], label=label)
        deflection.plot(time, 1e3 * run["chord.deflection [m]"], label=label)

    # the energies of the first run only, to keep the lines apart
    run = read(arguments.probes[0])
    parts = {name: run[f"energy.{name} [J]"] for name in ("kinetic", "potential", "elastic")}
    parts["total"] = sum(parts.values())
    for name, values in parts.items():
        energy.plot(run["time [s]"], values, "k--" if name == "total" else "-", label=name)

    for file, style in zip(arguments.reference, ["--", ":", "-."] * len(arguments.reference)):
        reference = read(file)
        label = pathlib.Path(file).stem
        time = reference["time [s]"]
        angle.plot(time, reference["angle [rad]"], "k" + style, lw=1, label=label)
        deflection.plot(time, 1e3 * reference["deflection [m]"], "k" + style, lw=1, label=label)

    angle.set_ylabel("angle of the chord [rad]")
    deflection.set_ylabel("mid-span deflection [mm]")
    energy.set_ylabel("energy [J]")
    energy.set_xlabel("time [s]")
    energy.set_xlim(0, arguments.until)
    for axes in (angle, deflection, energy):
        axes.grid(alpha=0.3)
        axes.legend(fontsize="small")
    figure.savefig(arguments.output, dpi=100)


if __name__ == "__main__":
    main()
