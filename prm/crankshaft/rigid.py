#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Compares a run of the crankshaft with the mechanism of rigid bodies.

The rigid mechanism has the masses, centres of mass and inertias that the program prints, and the
area of the piston crown in the mesh. With --from the start, where the elastic bodies vibrate, is
left out.
"""

import argparse
import csv
import math
import sys

SPEED = 100 * math.pi         # of the crankshaft, rad/s
CRANK, ROD = 0.04, 0.14       # lengths, m
CRANK_MASS, CRANK_CENTRE = 4.54837, -0.00477904      # kg; m along the throw
ROD_MASS, ROD_CENTRE, ROD_INERTIA = 0.835702, 0.0505611, 0.00292346     # kg; m from the big end; kg m^2
PULLEY = 0.00811862           # inertia about the axis, kg m^2
PISTON_MASS = 0.498941        # kg
CROWN = 2 * 0.00287134        # m^2; a circle of this diameter has 0.0058088 m^2


def gas_pressure(time):
    """The load of the model, Pa."""
    if not 0.01 <= time <= 0.03:
        return 0.0
    angle = SPEED * time
    volume = 1 + 4.5 * (1 - math.cos(angle)
                        + ROD / CRANK * (1 - math.sqrt(1 - (CRANK / ROD * math.sin(angle))**2)))
    if time < 0.0197:
        burnt = 1.0
    elif time > 0.0217:
        burnt = 5.0
    else:
        burnt = 1 + 2 * (1 - math.cos(math.pi * (time - 0.0197) / 0.002))
    valve = 1.0 if time < 0.028 else 0.5 * (1 + math.cos(math.pi * (time - 0.028) / 0.002))
    return valve * 1e5 * (burnt * (10 / volume)**1.3 - 1)


def rigid(time):
    """Position of the piston pin and forces at a time, by the names of the probes."""
    angle = SPEED * time
    sine, cosine = math.sin(angle), math.cos(angle)
    # the rod leans by phi: sin(phi) = CRANK / ROD sin(angle)
    sin_phi = CRANK / ROD * sine
    cos_phi = math.sqrt(1 - sin_phi**2)
    phi_1 = CRANK / ROD * SPEED * cosine / cos_phi
    phi_2 = (-CRANK / ROD * SPEED**2 * sine + phi_1**2 * sin_phi) / cos_phi
    # crank pin, and the way from there to the piston pin, with second derivatives
    pin = (-CRANK * sine, CRANK * cosine)
    pin_2 = (CRANK * SPEED**2 * sine, -CRANK * SPEED**2 * cosine)
    way = (ROD * sin_phi, ROD * cos_phi)
    way_2 = (ROD * (phi_2 * cos_phi - phi_1**2 * sin_phi),
             -ROD * (phi_2 * sin_phi + phi_1**2 * cos_phi))
    centre = [ROD_CENTRE / ROD * part for part in way]      # from the crank pin
    inertia = [ROD_MASS * (a + ROD_CENTRE / ROD * b) for a, b in zip(pin_2, way_2)]

    # force on the rod at the piston pin, from the piston along z and the moments about the crank pin
    force_z = -PISTON_MASS * (pin_2[1] + way_2[1]) - gas_pressure(time) * CROWN
    moment = -ROD_INERTIA * phi_2 + centre[0] * inertia[1] - centre[1] * inertia[0]
    force_y = (way[0] * force_z - moment) / way[1]
    crank_force = (inertia[0] - force_y, inertia[1] - force_z)
    centrifugal = CRANK_MASS * SPEED**2 * CRANK_CENTRE
    bearings = (crank_force[0] + centrifugal * sine, crank_force[1] - centrifugal * cosine)
    # Bending in the middle of the crank pin, a beam on supports at the main bearings, 48 mm on
    # either side, under the force of the rod on 32 mm of it and the inertia of the webs at 25 mm;
    # with the radial parts of the forces, and positive where the side of the axis is pulled.
    radial_rod = -crank_force[0] * sine + crank_force[1] * cosine
    radial_bearings = -bearings[0] * sine + bearings[1] * cosine
    bending = 0.5 * (radial_bearings * 0.048 - radial_rod * 0.008 + centrifugal * 0.025)
    return {
        "piston.z [m]": pin[1] + way[1],
        "piston pin.force y [N]": force_y,
        "piston pin.force z [N]": force_z,
        "crank pin.force y [N]": crank_force[0],
        "crank pin.force z [N]": crank_force[1],
        "bearings.force y [N]": bearings[0],
        "bearings.force z [N]": bearings[1],
        "cylinder.force y [N]": force_y,
        "bending.xx [Pa]": bending * 0.018 / (math.pi / 4 * 0.02**4),    # 18 mm from the axis of the pin
        "drive.moment x [N m]": pin[0] * crank_force[1] - pin[1] * crank_force[0],
    }


def torsion_stiffness():
    """Between the flywheel and the throw, and between the throw and the pulley, N m/rad.

    W. Ker Wilson: Practical Solution of Torsional Vibration Problems; diameters, lengths and
    thicknesses of the model, half of the crank pin on either side, and the plate at the flywheel.
    """
    journal, pin, end = 0.044, 0.04, 0.036
    reduced = ((0.014 + 0.4 * journal) / journal**4 + (0.016 + 0.2 * pin) / pin**4
               + 0.5 * (CRANK - 0.2 * (journal + pin)) / (0.018 * 0.056**3)
               + 0.014 / journal**4 + 0.03 / end**4)
    half = 2.1e11 / 2.6 * math.pi / 32 / reduced
    return 1 / (1 / half + 1 / 1e6), half


def torsion(end, step=1e-6):
    """Two discs, throw and pulley, on a shaft whose other end is the flywheel.

    The throw carries the crankshaft, the rotating part of the rod and half of the reciprocating
    masses, whose torque at constant speed drives the vibration. Times, s, and torques of the
    flywheel on the shaft, N m.
    """
    stiffness_1, stiffness_2 = torsion_stiffness()
    rotating = ROD_MASS * (1 - ROD_CENTRE / ROD)
    throw = (0.00742615 + CRANK_MASS * CRANK_CENTRE**2
             + (rotating + 0.5 * (PISTON_MASS + ROD_MASS - rotating)) * CRANK**2)
    damping = 5e-6
    angle, rate, times, torques = [0.0, 0.0], [0.0, 0.0], [], []
    for number in range(round(end / step) + 1):
        times.append(number * step)
        torques.append(-stiffness_1 * angle[0])
        spring = stiffness_2 * (angle[0] - angle[1] + damping * (rate[0] - rate[1]))
        load = -rigid(number * step)["drive.moment x [N m]"]
        rate[0] += step * (load - stiffness_1 * (angle[0] + damping * rate[0]) - spring) / throw
        rate[1] += step * spring / PULLEY
        angle = [a + step * r for a, r in zip(angle, rate)]
    return times, torques


def frequencies():
    """Of the two discs, Hz, with the inertias at top dead centre, where the piston does not move."""
    stiffness_1, stiffness_2 = torsion_stiffness()
    throw = (0.00742615 + CRANK_MASS * CRANK_CENTRE**2 + ROD_MASS * (1 - ROD_CENTRE / ROD) * CRANK**2)
    trace = (stiffness_1 + stiffness_2) / throw + stiffness_2 / PULLEY
    product = stiffness_1 * stiffness_2 / throw / PULLEY
    root = math.sqrt(trace**2 / 4 - product)
    return [math.sqrt(trace / 2 + sign * root) / 2 / math.pi for sign in (-1, 1)]


def read(file):
    """The lines of probes.csv as dictionaries, with the sum of the main bearings."""
    with open(file, encoding="utf-8") as stream:
        rows = [{name: float(value) for name, value in row.items()}
                for row in csv.DictReader(stream)]
    for row in rows:
        for axis in "yz":
            row[f"bearings.force {axis} [N]"] = (row[f"rear bearing.force {axis} [N]"]
                                                 + row[f"front bearing.force {axis} [N]"])
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("probes", help="probes.csv of a run")
    parser.add_argument("--from", type=float, default=0, dest="start", metavar="T",
                        help="first time that is compared, s")
    parser.add_argument("--modes", metavar="FILE", help="modes.csv of a run")
    parser.add_argument("--tolerance", type=float, metavar="X",
                        help="exit status 1 if a mean difference is larger than this part of the largest"
                        " value, or the first torsional frequency differs by more than this part")
    arguments = parser.parse_args()

    rows = [row for row in read(arguments.probes) if row["time [s]"] >= arguments.start]
    values = [rigid(row["time [s]"]) for row in rows]
    print(f"{'':24} {'largest, rigid':>15} {'largest':>12} {'rms difference':>15} {'relative':>9}")
    # without torque and bending, in which vibrations are as large
    vibrating = ("drive.moment x [N m]", "bending.xx [Pa]")
    worst = 0.0
    for name in values[0]:
        largest = max(abs(value[name]) for value in values)
        difference = math.sqrt(sum((row[name] - value[name])**2
                                   for row, value in zip(rows, values)) / len(rows))
        if name not in vibrating:
            worst = max(worst, difference / largest)
        print(f"{name:24} {largest:15.6g} {max(abs(row[name]) for row in rows):12.6g}"
              f" {difference:15.3g} {difference / largest:9.2%}")
    times, torques = torsion(rows[-1]["time [s]"])
    step = times[1]
    pairs = [(row["drive.moment x [N m]"], torques[round(row["time [s]"] / step)]) for row in rows]
    largest = max(abs(torque) for _, torque in pairs)
    difference = math.sqrt(sum((a - b)**2 for a, b in pairs) / len(pairs))
    print(f"{'drive, with torsion':24} {largest:15.6g} {max(abs(a) for a, _ in pairs):12.6g}"
          f" {difference:15.3g} {difference / largest:9.2%}")
    print("torsional frequencies by hand:", ", ".join(f"{value:.1f} Hz" for value in frequencies()))
    if arguments.modes:
        with open(arguments.modes, encoding="utf-8") as stream:
            modes = [float(row["frequency [Hz]"]) for row in csv.DictReader(stream)]
        hand = frequencies()[0]
        nearest = min(modes, key=lambda mode: abs(mode - hand))
        print(f"nearest mode: {nearest:.1f} Hz, {nearest / hand - 1:.2%}")
        worst = max(worst, abs(nearest / hand - 1))
    if arguments.tolerance is not None and worst > arguments.tolerance:
        sys.exit(f"a difference of {worst:.2%} is larger than {arguments.tolerance:.2%}")


if __name__ == "__main__":
    main()
