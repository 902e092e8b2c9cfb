#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Plots the angle of the door and the forces of its hinges.

Needs python3-numpy and python3-matplotlib.
"""

import argparse

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
    arguments = parser.parse_args()

    run = read(arguments.probes)
    time = run["time [s]"]
    figure, panels = plt.subplots(3, 1, sharex=True, figsize=(7, 8), constrained_layout=True)
    panels[0].plot(time, np.degrees(run["hinge.angle [rad]"]), label="door")
    panels[0].set_ylabel("angle [degrees]")
    total = 0
    for name in ("lower", "middle", "upper"):
        panels[1].plot(time, run[f"{name}.force z [N]"], label=name)
        panels[2].plot(time, run[f"{name}.force x [N]"], label=name)
        total = total + run[f"{name}.force z [N]"]
    panels[1].plot(time, total, "k--", lw=1, label="sum")
    panels[1].set_ylabel("vertical force [N]")
    panels[2].set_ylabel("force along x [N]")
    for axes in panels:
        axes.grid(alpha=0.3)
        axes.legend(fontsize="small")
    panels[-1].set_xlabel("time [s]")
    figure.savefig(arguments.output, dpi=90)


if __name__ == "__main__":
    main()
