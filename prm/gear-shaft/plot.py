#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Plots the bearing forces of the gear shaft over the tooth frequency, with those of beam.py.

Needs python3-numpy and python3-matplotlib.
"""

import argparse

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import beam


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("probes", help="probes.csv of a run")
    parser.add_argument("--output", default="curves.png", help="default: %(default)s")
    arguments = parser.parse_args()

    tooth, forces = beam.run_up(arguments.probes)
    steady = np.arange(tooth[0], tooth[-1], 0.5)
    amplitudes = np.array([beam.response(frequency) for frequency in steady]).T
    figure, panels = plt.subplots(2, 1, sharex=True, figsize=(7, 6), constrained_layout=True)
    for number, (axes, mean, force, amplitude) in enumerate(
            zip(panels, beam.static(), forces, amplitudes), 1):
        axes.plot(tooth, 1e-3 * np.array(force), lw=0.5, label="run-up")
        for sign in (1, -1):
            axes.plot(steady, 1e-3 * (mean + sign * amplitude), "k--", lw=0.9,
                      label="beam at steady speed" if sign > 0 else None)
        axes.set_ylabel(f"bearing {number}, force along y [kN]")
        axes.grid(alpha=0.3)
        axes.legend(fontsize="small")
    panels[-1].set_xlabel("tooth frequency [Hz]")
    figure.savefig(arguments.output, dpi=90)


if __name__ == "__main__":
    main()
