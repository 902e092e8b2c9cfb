#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""The gear shaft as a Timoshenko beam with a rigid wheel on two springs.

Prints static bearing forces and natural frequencies of bending; with probes.csv of a run, compares
them with its start, and the bearing forces of its run-up with those of the beam at steady speed.
"""

import argparse
import csv
import math
import sys

YOUNG, POISSON, DENSITY = 2.1e11, 0.3, 7850.0
BORE = 0.008
# end and outer radius of the parts of the shaft, the hub counted to the shaft, m
PARTS = ((0.03, 0.02), (0.11, 0.025), (0.15, 0.035), (0.25, 0.025), (0.32, 0.02))
# inner and outer radius and width of the web and the rim, rigid, with their centre at WHEEL
RINGS = ((0.035, 0.08, 0.014), (0.08, 0.1, 0.04))
BEARINGS, WHEEL = (0.015, 0.265), 0.13
STIFFNESS, DAMPING = 1e8, 1000.0        # of a bearing, N/m, N s/m
TEETH, VARIATION = 50, 0.05
FORCE = (4000.0, 4000.0 * math.tan(math.pi / 9))
ELEMENT = 0.005                         # length of the elements, m


def solve(matrix, vector):
    """Gauss elimination of a band matrix of half width 3, without pivoting."""
    matrix = [row[:] for row in matrix]
    vector = vector[:]
    size = len(vector)
    for k in range(size):
        for i in range(k + 1, min(k + 4, size)):
            factor = matrix[i][k] / matrix[k][k]
            if factor:
                for j in range(k, min(k + 4, size)):
                    matrix[i][j] -= factor * matrix[k][j]
                vector[i] -= factor * vector[k]
    for k in reversed(range(size)):
        vector[k] = (vector[k] - sum(matrix[k][j] * vector[j]
                                     for j in range(k + 1, min(k + 4, size)))) / matrix[k][k]
    return vector


def assemble():
    """Stiffness with the bearings, diagonal masses: deflection and slope at every node."""
    nodes = round(PARTS[-1][0] / ELEMENT) + 1
    stiffness = [[0.0] * (2 * nodes) for _ in range(2 * nodes)]
    mass = [0.0] * (2 * nodes)
    for element in range(nodes - 1):
        radius = next(r for end, r in PARTS if (element + 0.5) * ELEMENT < end)
        area = math.pi * (radius**2 - BORE**2)
        inertia = math.pi / 4 * (radius**4 - BORE**4)
        ratio = (1 + (BORE / radius)**2)**2
        # shear correction of a hollow circle (G. R. Cowper, 1966)
        shear = 6 * (1 + POISSON) * ratio / ((7 + 6 * POISSON) * ratio
                                             + (20 + 12 * POISSON) * (BORE / radius)**2)
        phi = 12 * YOUNG * inertia / (shear * YOUNG / 2 / (1 + POISSON) * area * ELEMENT**2)
        factor = YOUNG * inertia / ELEMENT**3 / (1 + phi)
        length = ELEMENT
        block = ((12, 6 * length, -12, 6 * length),
                 (6 * length, (4 + phi) * length**2, -6 * length, (2 - phi) * length**2),
                 (-12, -6 * length, 12, -6 * length),
                 (6 * length, (2 - phi) * length**2, -6 * length, (4 + phi) * length**2))
        for i in range(4):
            for j in range(4):
                stiffness[2 * element + i][2 * element + j] += factor * block[i][j]
            mass[2 * element + i] += DENSITY * ELEMENT / 2 * (inertia if i % 2 else area)
    for inner, outer, width in RINGS:
        ring = DENSITY * math.pi * (outer**2 - inner**2) * width
        node = 2 * round(WHEEL / ELEMENT)
        mass[node] += ring
        mass[node + 1] += ring * ((inner**2 + outer**2) / 4 + width**2 / 12)
    for place in BEARINGS:
        node = 2 * round(place / ELEMENT)
        stiffness[node][node] += STIFFNESS
    return stiffness, mass


def frequencies(number):
    """The lowest natural frequencies of bending, Hz, by inverse iteration."""
    stiffness, mass = assemble()
    modes = []
    for count in range(number):
        shape = [math.sin(0.1 * (k + 1) * (count + 1)) for k in range(len(mass))]
        for _ in range(60):
            for mode in modes:
                part = sum(m * a * b for m, a, b in zip(mass, mode[1], shape))
                shape = [a - part * b for a, b in zip(shape, mode[1])]
            norm = math.sqrt(sum(m * a * a for m, a in zip(mass, shape)))
            shape = [a / norm for a in shape]
            previous, shape = shape, solve(stiffness, [m * a for m, a in zip(mass, shape)])
            eigenvalue = 1 / sum(m * a * b for m, a, b in zip(mass, previous, shape))
        modes.append((eigenvalue, previous))
    return [math.sqrt(value) / 2 / math.pi for value, _ in modes]


def static():
    """Forces of the bearings along y under the constant tooth force, N."""
    stiffness, mass = assemble()
    load = [0.0] * len(mass)
    load[2 * round(WHEEL / ELEMENT)] = FORCE[0]
    shape = solve(stiffness, load)
    return [STIFFNESS * shape[2 * round(place / ELEMENT)] for place in BEARINGS]


def response(frequency):
    """Amplitudes of the bearing forces along y under the varying tooth force, N."""
    stiffness, mass = assemble()
    omega = 2 * math.pi * frequency
    for k, value in enumerate(mass):
        stiffness[k][k] -= omega**2 * value
    for place in BEARINGS:
        node = 2 * round(place / ELEMENT)
        stiffness[node][node] += 1j * omega * DAMPING
    load = [0.0] * len(mass)
    load[2 * round(WHEEL / ELEMENT)] = VARIATION * FORCE[0]
    shape = solve(stiffness, load)
    return [abs(shape[2 * round(place / ELEMENT)]) * abs(STIFFNESS + 1j * omega * DAMPING)
            for place in BEARINGS]


def run_up(file):
    """Tooth frequency, Hz, and bearing forces along y, N, of a run."""
    with open(file, encoding="utf-8") as stream:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(stream)]
    tooth = [TEETH * row["motor.rate [rad/s]"] / 2 / math.pi for row in rows]
    forces = []
    for name in ("bearing 1", "bearing 2"):
        place = [row[f"{name}.y [m]"] for row in rows]
        force = []
        for k, row in enumerate(rows):
            before, after = max(k - 1, 0), min(k + 1, len(rows) - 1)
            time = rows[after]["time [s]"] - rows[before]["time [s]"]
            rate = (place[after] - place[before]) / time if time and k else 0.0     # at rest at the start
            force.append(STIFFNESS * place[k] + DAMPING * rate)
        forces.append(force)
    return tooth, forces


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("probes", nargs="?", help="probes.csv of a run")
    parser.add_argument("--modes", metavar="FILE", help="modes.csv of a run")
    parser.add_argument("--tolerance", type=float, metavar="X",
                        help="exit status 1 if a force at the start or the first frequency differs by more"
                        " than this part")
    arguments = parser.parse_args()

    worst = 0.0

    def compare(name, unit, beam, solid, counts=True):
        nonlocal worst
        if counts:
            worst = max(worst, abs(solid / beam - 1))
        print(f"{name:28} beam {beam:9.2f} {unit:2}  solid {solid:9.2f} {unit:2}  difference {solid / beam - 1:7.2%}")

    bending = frequencies(3)
    if arguments.modes:
        with open(arguments.modes, encoding="utf-8") as stream:
            solid = [float(row["frequency [Hz]"]) for row in csv.DictReader(stream)]
        # bending in two planes: frequencies that occur twice
        pairs = [a for a, b in zip(solid, solid[1:]) if abs(b / a - 1) < 1e-4]
        if not pairs:
            sys.exit(f"{arguments.modes}: no frequency occurs twice, as those of bending do")
        # the rigid wheel of the beam spoils its higher frequencies
        for number, (one, other) in enumerate(zip(bending, pairs), 1):
            compare(f"bending mode {number}", "Hz", one, other, number == 1)
    else:
        for number, frequency in enumerate(bending, 1):
            print(f"bending mode {number}: {frequency:.2f} Hz")
    if arguments.probes:
        tooth, forces = run_up(arguments.probes)
        for number, (one, force) in enumerate(zip(static(), forces), 1):
            compare(f"bearing {number} at the start", "N", one, force[0])
        if tooth[-1] > bending[0]:
            steady = [response(520 + 0.5 * k) for k in range(201)]
            for number, (one, force) in enumerate(zip(static(), forces)):
                peak = max(range(len(force)), key=lambda k, f=force, s=one: abs(f[k] - s))
                best = max(range(len(steady)), key=lambda k, n=number: steady[k][n])
                print(f"bearing {number + 1}, largest vibration: beam {steady[best][number]:.0f} N at"
                      f" {520 + 0.5 * best:.0f} Hz, solid {abs(force[peak] - one):.0f} N at {tooth[peak]:.0f} Hz")
    if arguments.tolerance is not None and worst > arguments.tolerance:
        sys.exit(f"a difference of {worst:.2%} is larger than {arguments.tolerance:.2%}")


if __name__ == "__main__":
    main()
