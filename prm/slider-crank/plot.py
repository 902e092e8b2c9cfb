#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Plots deflection and angle of the rod of the slider-crank.

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
                        help="curves with the columns of probes.csv; repeatable")
    parser.add_argument("--output", default="curves.png", help="default: %(default)s")
    parser.add_argument("--until", type=float, metavar="T", help="last time to plot, s")
    arguments = parser.parse_args()

    figure, (deflection, angle) = plt.subplots(
        2, 1, sharex=True, figsize=(7, 7), constrained_layout=True)
    curves = [(file, pathlib.Path(file).resolve().parent.name, {"lw": 1.2})
              for file in arguments.probes]
    curves += [(file, pathlib.Path(file).stem, {"color": "k", "lw": 0.9, "ls": style})
               for file, style in zip(arguments.reference, ["--", ":", "-."] * 9)]
    for file, label, style in curves:
        run = read(file)
        time = run["time [s]"]
        deflection.plot(time, 1e3 * run["rod.deflection [m]"], label=label, **style)
        angle.plot(time, run["rod.angle [rad]"], label=label, **style)

    deflection.set_ylabel("mid-span deflection of the rod [mm]")
    angle.set_ylabel("angle of the rod [rad]")
    angle.set_xlabel("time [s]")
    angle.set_xlim(0, arguments.until)
    for axes in (deflection, angle):
        axes.grid(alpha=0.3)
        axes.legend(fontsize="small")
    figure.savefig(arguments.output, dpi=90)


if __name__ == "__main__":
    main()
