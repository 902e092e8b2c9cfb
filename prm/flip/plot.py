#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Plots the turns of the free box against Euler's equations.

Needs python3-numpy, python3-scipy and python3-matplotlib.
"""

import argparse

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import solve_ivp
from scipy.special import ellipk

INERTIA = np.array([0.025, 0.05, 0.065])  # kg m^2, ascending
SPIN = np.array([0.2, 10, 0])             # rad/s, at the start


def read(file):
    """Columns of a file of comma-separated values, by their names."""
    with open(file, encoding="utf-8") as stream:
        names = stream.readline().rstrip("\n").split(",")
        table = np.loadtxt(stream, delimiter=",", ndmin=2)
    return dict(zip(names, table.T))


def period():
    """Period of the angular velocity (Landau and Lifshitz, Mechanics, Sec. 37)."""
    I1, I2, I3 = INERTIA
    M2, E2 = np.sum((INERTIA * SPIN)**2), np.sum(INERTIA * SPIN**2)
    if M2 < E2 * I2:
        I1, I3 = I3, I1
    a, b = (I3 - I2) * (M2 - E2 * I1), (I2 - I1) * (E2 * I3 - M2)
    return 4 * np.sqrt(I1 * I2 * I3 / a) * ellipk(b / a)


def euler(times):
    """Angular velocities of the rigid box in its axes."""
    def rate(_, w):
        return np.cross(INERTIA * w, w) / INERTIA
    return solve_ivp(rate, (0, times[-1]), SPIN, t_eval=times, rtol=1e-11, atol=1e-12).y


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("probes", help="probes.csv of a run")
    parser.add_argument("--output", default="curves.png", help="default: %(default)s")
    arguments = parser.parse_args()

    run = read(arguments.probes)
    time = run["time [s]"]
    axis = np.array([run[f"front.{x} [m]"] - run[f"back.{x} [m]"] for x in "xyz"])
    momentum = INERTIA * SPIN
    length = np.linalg.norm(momentum)
    along = momentum @ axis / np.linalg.norm(axis, axis=0) / length
    rigid = INERTIA[1] * euler(time)[1] / length

    k = np.flatnonzero(along[:-1] * along[1:] < 0)
    flips = time[k] - along[k] * (time[k + 1] - time[k]) / (along[k + 1] - along[k])
    print(f"half a period: {period() / 2:.6f} s; turns over at",
          ", ".join(f"{t:.6f} s" for t in flips))

    energy = run["energy.kinetic [J]"] + run["energy.elastic [J]"]
    L = np.array([run[f"angular momentum.{x} [kg m^2/s]"] for x in "xyz"]).T
    figure, panels = plt.subplots(2, 1, sharex=True, figsize=(7, 6), constrained_layout=True)
    panels[0].plot(time, along, label="box")
    panels[0].plot(time, rigid, "k--", lw=1, label="Euler's equations")
    panels[0].set_ylabel("cosine of intermediate axis\nand angular momentum")
    panels[1].semilogy(time[1:], np.abs(energy / energy[0] - 1)[1:], label="energy")
    panels[1].semilogy(time[1:], np.linalg.norm(L - L[0], axis=1)[1:] / length,
                       label="angular momentum")
    panels[1].set_ylabel("relative change")
    for axes in panels:
        axes.grid(alpha=0.3)
        axes.legend(fontsize="small")
    panels[-1].set_xlabel("time [s]")
    figure.savefig(arguments.output, dpi=90)


if __name__ == "__main__":
    main()
