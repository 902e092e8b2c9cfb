#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Plots nodding and precession of the top against the rigid top.

Needs python3-numpy, python3-scipy and python3-matplotlib.
"""

import argparse

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import solve_ivp

# Of shaft and disc, as the program prints them.
MASS = np.array([0.0859135, 1.52735])        # kg
CENTRE = np.array([0.025, 0.06])             # m, above the ball joint
ACROSS = np.array([2.22595e-05, 0.0034965])  # kg m^2, about the centres
ALONG = np.array([8.72164e-06, 0.00689117])  # kg m^2
GRAVITY, TILT, SPIN = 9.81, np.radians(30), 50


def read(file):
    """Columns of a file of comma-separated values, by their names."""
    with open(file, encoding="utf-8") as stream:
        names = stream.readline().rstrip("\n").split(",")
        table = np.loadtxt(stream, delimiter=",", ndmin=2)
    return dict(zip(names, table.T))


def rigid_top(times):
    """Angle from the vertical, its rate and the angle of precession."""
    across, along = np.sum(ACROSS + MASS * CENTRE**2), np.sum(ALONG)
    axial = along * SPIN             # angular momentum along the axis of the top,
    vertical = axial * np.cos(TILT)  # and along the vertical
    weight_moment = GRAVITY * np.sum(MASS * CENTRE)

    def rate(_, y):
        sine, cosine = np.sin(y[0]), np.cos(y[0])
        turn = (vertical - axial * cosine) / (across * sine**2)
        return [y[1], sine * (turn**2 * cosine + (weight_moment - axial * turn) / across), turn]

    return solve_ivp(rate, (0, times[-1]), [TILT, 0, 0], t_eval=times, rtol=1e-11,
                     atol=1e-12).y


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("probes", help="probes.csv of a run")
    parser.add_argument("--output", default="curves.png", help="default: %(default)s")
    arguments = parser.parse_args()

    run = read(arguments.probes)
    time = run["time [s]"]
    x, y, z = (run[f"axis.{c} [m]"] for c in "xyz")
    tilt = np.arctan2(np.hypot(x, y), z)
    turn = np.unwrap(np.arctan2(-x, y))
    nodding, _, precession = rigid_top(time)
    print(f"largest differences to the rigid top: angle from the vertical "
          f"{np.abs(tilt - nodding).max():.2g} rad, precession "
          f"{np.abs(turn - precession).max():.2g} rad of {precession[-1]:.2f} rad")

    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4.4), constrained_layout=True)
    left.plot(x, y, label="run")
    left.plot(0.07 * np.sin(nodding) * -np.sin(precession),
              0.07 * np.sin(nodding) * np.cos(precession), "k--", lw=1, label="rigid top")
    left.set_aspect("equal")
    left.set_xlabel("x [m]")
    left.set_ylabel("y [m]")
    left.set_title("upper end of the axis, from above", fontsize="medium")
    right.plot(time, tilt, label="run")
    right.plot(time, nodding, "k--", lw=1, label="rigid top")
    right.set_xlabel("time [s]")
    right.set_ylabel("angle from the vertical [rad]")
    for axes in (left, right):
        axes.grid(alpha=0.3)
        axes.legend(fontsize="small", loc="upper right")
    figure.savefig(arguments.output, dpi=90)


if __name__ == "__main__":
    main()
