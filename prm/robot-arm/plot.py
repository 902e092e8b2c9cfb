#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Plots how far the tip of the robot arm is from that of rigid.py, and the torques of the drives.

Needs python3-numpy and python3-matplotlib.
"""

import argparse
import math
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import rigid


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("probes", nargs="+", help="probes.csv of one or more runs")
    parser.add_argument("--output", default="curves.png", help="default: %(default)s")
    arguments = parser.parse_args()

    figure, panels = plt.subplots(3, 1, sharex=True, figsize=(7, 8), constrained_layout=True)
    for file, colour in zip(arguments.probes, ("C0", "C1", "C2", "C3") * 9):
        label = pathlib.Path(file).resolve().parent.name
        run = rigid.read(file)
        panels[0].plot(run["time"], [1e3 * math.dist(one, other)
                                     for one, other in zip(run["tip"], run["rigid tip"])],
                       color=colour, lw=1, label=label)
        for axes, k in zip(panels[1:], (0, 1)):
            axes.plot(run["time"], [torque[k] for torque in run["torque"]], color=colour, lw=1, label=label)
            axes.plot(run["time"], [torque[k] for torque in run["rigid torque"]], color=colour, lw=1.2, ls=":",
                      label=f"{label}, rigid")
    panels[0].set_ylabel("tip, from the rigid arm's [mm]")
    panels[1].set_ylabel("torque of the base [N m]")
    panels[2].set_ylabel("torque of the shoulder [N m]")
    panels[2].set_xlabel("time [s]")
    for axes in panels:
        axes.grid(alpha=0.3)
        axes.legend(fontsize="small")
    figure.savefig(arguments.output, dpi=80)


if __name__ == "__main__":
    main()
