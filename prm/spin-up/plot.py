#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Plots, and prints the extremes of, the tip's displacement in the frame of the root.

Needs python3-numpy and python3-matplotlib.
"""

import argparse

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

LENGTH = 10  # m
SPIN_UP = 15  # s


def read(file):
    """Columns of a file of comma-separated values, by their names."""
    with open(file, encoding="utf-8") as stream:
        names = stream.readline().rstrip("\n").split(",")
        table = np.loadtxt(stream, delimiter=",", ndmin=2)
    return dict(zip(names, table.T))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("runs", nargs="+", help="LABEL=probes.csv of each run")
    parser.add_argument("--output", default="curves.png", help="default: %(default)s")
    arguments = parser.parse_args()

    figure, panels = plt.subplots(2, 1, sharex=True, figsize=(7, 6), constrained_layout=True)
    for argument in arguments.runs:
        label, file = argument.split("=", 1)
        run = read(file)
        time = run["time [s]"]
        cosine, sine = np.cos(run["root.angle [rad]"]), np.sin(run["root.angle [rad]"])
        x, y = run["tip.x [m]"], run["tip.y [m]"]
        along, across = cosine * x + sine * y - LENGTH, cosine * y - sine * x
        panels[0].plot(time, across, lw=1, label=label)
        panels[1].plot(time, 1e3 * along, lw=1, label=label)
        lowest, shortest = np.argmin(across), np.argmin(along)
        turning = along[time > SPIN_UP]
        print(
            f"{label}: across {across[lowest]:.4f} m at {time[lowest]:.2f} s, "
            f"along {1e3 * along[shortest]:.2f} mm at {time[shortest]:.2f} s, "
            f"after {SPIN_UP} s {1e3 * turning.mean():.4f} mm"
        )
    panels[0].set_ylabel("tip, across [m]")
    panels[1].set_ylabel("tip, along [mm]")
    panels[1].set_xlabel("time [s]")
    for axes in panels:
        axes.grid(alpha=0.3)
    panels[0].legend(fontsize="small")
    figure.savefig(arguments.output, dpi=90)


if __name__ == "__main__":
    main()
