#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Plots the deflection of the rod and the multipliers of the IVP slider-crank.

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
    parser.add_argument("probes", help="probes.csv of a run")
    parser.add_argument("--output", default="curves.png", help="default: %(default)s")
    parser.add_argument("--reference", action="append", default=[], metavar="FILE",
                        help="curves of a beam model; repeatable")
    arguments = parser.parse_args()

    run = read(arguments.probes)
    time = run["time [s]"]
    columns = [("rod.deflection [m]", "deflection [mm]", 1e3 * run["rod.deflection [m]"], 1e3),
               ("lambda 1 [N]", "lambda 1 [N]", run["block pin.force y [N]"], 1),
               ("lambda 2 [N]", "lambda 2 [N]", -run["block pin.force x [N]"], 1),
               ("lambda 3 [N m]", "lambda 3 [N m]", -run["drive.moment z [N m]"], 1)]
    figure, panels = plt.subplots(4, 1, sharex=True, figsize=(7, 9), constrained_layout=True)
    for axes, (name, label, values, factor) in zip(panels, columns):
        axes.plot(time, values, lw=1.2, label="solid")
        for file, style in zip(arguments.reference, ["k--", "r:", "k-."] * 9):
            reference = read(file)
            axes.plot(reference["time [s]"], factor * reference[name], style, lw=0.9,
                      label=pathlib.Path(file).stem)
        axes.set_ylabel(label)
    for axes in panels:
        axes.grid(alpha=0.3)
        axes.legend(fontsize="small")
    panels[-1].set_xlabel("time [s]")
    figure.savefig(arguments.output, dpi=90)


if __name__ == "__main__":
    main()
