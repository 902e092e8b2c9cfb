#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Plots bearing forces, torque and twist of the crankshaft, beside the models of rigid.py.

Needs python3-numpy and python3-matplotlib.
"""

import argparse

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import rigid


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("probes", help="probes.csv of a run")
    parser.add_argument("--output", default="curves.png", help="default: %(default)s")
    arguments = parser.parse_args()

    rows = rigid.read(arguments.probes)
    time = np.array([row["time [s]"] for row in rows])
    values = [rigid.rigid(t) for t in time]
    angle = np.degrees(rigid.SPEED * time)
    figure, panels = plt.subplots(3, 1, sharex=True, figsize=(7, 8), constrained_layout=True)

    name = "bearings.force z [N]"
    panels[0].plot(angle, [1e-3 * row[name] for row in rows], label="both main bearings")
    panels[0].plot(angle, [1e-3 * row["front bearing.force z [N]"] for row in rows], lw=0.8, label="front bearing")
    panels[0].plot(angle, [1e-3 * value[name] for value in values], "k--", lw=0.9, label="rigid bodies")
    panels[0].set_ylabel("force along the cylinder [kN]")
    # the lines at the start are extrapolated from the first step
    panels[0].set_ylim(-12, 35)

    name = "drive.moment x [N m]"
    times, torques = rigid.torsion(time[-1])
    panels[1].plot(angle, [row[name] for row in rows], label="flywheel")
    panels[1].plot(np.degrees(rigid.SPEED * np.array(times)), torques, "k:", lw=1, label="two discs")
    panels[1].plot(angle, [value[name] for value in values], "k--", lw=0.9, label="rigid bodies")
    panels[1].set_ylabel("torque on the crankshaft [N m]")

    panels[2].plot(angle, [1e3 * (row["front.angle [rad]"] - row["crank.angle [rad]"]) for row in rows],
                   label="front bearing against flywheel")
    panels[2].set_ylabel("twist [mrad]")
    panels[2].set_xlabel("crank angle [degrees], firing at 360")
    panels[2].set_xticks(range(0, 721, 90))
    for axes in panels:
        axes.grid(alpha=0.3)
        axes.legend(fontsize="small", loc="upper left")
    figure.savefig(arguments.output, dpi=90)


if __name__ == "__main__":
    main()
