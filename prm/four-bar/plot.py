#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Plots the output angle of the Bennett linkage against the closed form.

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
    alpha, beta, start = np.radians([30, 90, 120])
    ratio = np.sin((beta + alpha) / 2) / np.sin((beta - alpha) / 2)
    output = run["output.angle [rad]"]
    theta = start + run["drive.angle [rad]"]
    phi = np.unwrap(2 * np.arctan2(ratio * np.cos(theta / 2), np.sin(theta / 2)))
    exact = phi - phi[0]
    print(f"largest difference to the closed form: {np.abs(output - exact).max():.2g} rad")

    figure, panels = plt.subplots(3, 1, sharex=True, figsize=(7, 8), constrained_layout=True)
    panels[0].plot(time, run["drive.angle [rad]"], label="drive")
    panels[0].plot(time, output, label="output")
    panels[0].plot(time, exact, "k--", lw=1, label="output, closed form")
    panels[0].set_ylabel("angle [rad]")
    panels[1].plot(time, 1e6 * (output - exact), lw=0.8, label="output minus closed form")
    panels[1].set_ylabel("difference [1e-6 rad]")
    panels[2].plot(time, run["drive reaction.moment z [N m]"], lw=0.8, label="driving torque")
    panels[2].set_ylabel("torque [N m]")
    for axes in panels:
        axes.grid(alpha=0.3)
        axes.legend(fontsize="small")
    panels[-1].set_xlabel("time [s]")
    figure.savefig(arguments.output, dpi=90)


if __name__ == "__main__":
    main()
