#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Compares a run of the robot arm with the arm of rigid bodies.

Torques of the drives by inverse dynamics and the path of the tip by kinematics, for the angles
that the run prescribes; masses, centres of mass and inertias are those that the program prints.
"""

import argparse
import csv
import math
import sys

GRAVITY = 9.81
UPPER, FOREARM = 0.6, 0.5               # lengths, m
SIDE = 0.065                            # of the forearm beside the upper arm, m
START = (0.0, math.radians(60), math.radians(-75))      # angles of base, shoulder, elbow
LOAD = 5.0                              # kg
# mass, centre of mass from the first joint, inertia xx, yy, zz about it in the axes of the body
COLUMN_INERTIA = 0.101449               # kg m^2, about the vertical axis
BODIES = ((3.3795, (0.346276, 0.0039431, 0.0), (0.00412725, 0.20496, 0.205107)),
          (1.31642, (0.197379, 0.0, 0.0), (0.00096372, 0.0472461, 0.047192)))


def add(*vectors):
    return [sum(parts) for parts in zip(*vectors)]


def scale(factor, vector):
    return [factor * part for part in vector]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(one * other for one, other in zip(a, b))


def axes(yaw, elevation):
    """Axes x, y, z of a body that is turned about z by yaw and then points up by elevation."""
    cos_yaw, sin_yaw = math.cos(yaw), math.sin(yaw)
    cos_up, sin_up = math.cos(elevation), math.sin(elevation)
    return ((cos_up * cos_yaw, cos_up * sin_yaw, sin_up), (-sin_yaw, cos_yaw, 0.0),
            (-sin_up * cos_yaw, -sin_up * sin_yaw, cos_up))


def combine(frame, parts):
    return add(*(scale(part, axis) for part, axis in zip(parts, frame)))


def rigid(angles, rates, accelerations):
    """Position of the tip, and torques of base, shoulder and elbow (Newton and Euler)."""
    yaw = START[0] + angles[0]
    raise_axis = scale(-1, axes(yaw, 0)[1])     # positive angles raise the arm
    up = (0.0, 0.0, 1.0)
    elevation = START[1] + angles[1]
    # motion of the body, and of its first joint
    spin = [add(scale(rates[0], up), scale(rates[1], raise_axis))]
    turn = [add(scale(accelerations[0], up), scale(accelerations[1], raise_axis),
                cross(scale(rates[0], up), scale(rates[1], raise_axis)))]
    spin.append(add(spin[0], scale(rates[2], raise_axis)))
    turn.append(add(turn[0], scale(accelerations[2], raise_axis),
                    cross(scale(rates[0], up), scale(rates[2], raise_axis))))
    frames = [axes(yaw, elevation), axes(yaw, elevation + START[2] + angles[2])]

    def accelerated(k, arm):
        return add(cross(turn[k], arm), cross(spin[k], cross(spin[k], arm)))

    elbow = combine(frames[0], (UPPER, SIDE, 0))
    tip = combine(frames[1], (FOREARM, 0, 0))
    joints = ([0, 0, 0], elbow)
    lift = accelerated(0, elbow)
    joint_accelerations = ([0, 0, 0], lift)

    forces, moments = [], []        # about the shoulder, without those of the other bodies
    for k, (mass, centre, inertia) in enumerate(BODIES):
        arm = combine(frames[k], centre)
        force = scale(mass, add(joint_accelerations[k], accelerated(k, arm), (0, 0, GRAVITY)))
        about = [dot(axis, turn[k]) * value for axis, value in zip(frames[k], inertia)]
        spins = [dot(axis, spin[k]) for axis in frames[k]]
        gyro = cross(spins, [value * part for value, part in zip(inertia, spins)])
        moment = add(cross(add(joints[k], arm), force),
                     combine(frames[k], [a + g for a, g in zip(about, gyro)]))
        forces.append(force)
        moments.append(moment)
    force = scale(LOAD, add(lift, accelerated(1, tip), (0, 0, GRAVITY)))
    forces[1] = add(forces[1], force)
    moments[1] = add(moments[1], cross(add(elbow, tip), force))
    at_elbow = add(moments[1], scale(-1, cross(elbow, forces[1])))
    at_shoulder = add(*moments)
    return add(elbow, tip), (dot(at_shoulder, up) + COLUMN_INERTIA * accelerations[0],
                             dot(at_shoulder, raise_axis), dot(at_elbow, raise_axis))


NAMES = ("base", "shoulder", "elbow")


def read(file):
    """Times, positions of the tip, torques; and both of the rigid arm."""
    with open(file, encoding="utf-8") as stream:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(stream)]
    result = {"time": [row["time [s]"] for row in rows],
              "tip": [[row[f"tip.{axis} [m]"] for axis in "xyz"] for row in rows],
              "torque": [[row[f"{name} reaction.moment z [N m]"] for name in NAMES] for row in rows],
              "rigid tip": [], "rigid torque": []}
    for k, row in enumerate(rows):
        # accelerations are differences of the prescribed rates
        before, after = rows[max(k - 1, 0)], rows[min(k + 1, len(rows) - 1)]
        angles = [row[f"{name}.angle [rad]"] for name in NAMES]
        rates = [row[f"{name}.rate [rad/s]"] for name in NAMES]
        accelerations = [0.0, 0.0, 0.0]     # at rest at the start; a jump may follow
        if k > 0:
            accelerations = [(after[f"{name}.rate [rad/s]"] - before[f"{name}.rate [rad/s]"])
                             / (after["time [s]"] - before["time [s]"]) for name in NAMES]
        tip, torque = rigid(angles, rates, accelerations)
        result["rigid tip"].append(tip)
        result["rigid torque"].append(torque)
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("probes", help="probes.csv of a run")
    parser.add_argument("--tolerance", type=float, metavar="X",
                        help="exit status 1 if a torque differs by more than this part of its largest value")
    arguments = parser.parse_args()

    run = read(arguments.probes)
    worst = 0.0
    overall = max(abs(other) for torque in run["rigid torque"] for other in torque)
    for k, name in enumerate(NAMES):
        pairs = [(one[k], other[k]) for one, other in zip(run["torque"], run["rigid torque"])]
        largest = max(abs(other) for _, other in pairs)
        if largest < 1e-9 * overall:
            largest = overall       # that of the base is zero in an arm at rest
        difference = math.sqrt(sum((one - other)**2 for one, other in pairs) / len(pairs))
        worst = max(worst, difference / largest)
        print(f"torque of the {name}, N m (in brackets: rigid arm): at the start {pairs[0][0]:.2f} ({pairs[0][1]:.2f}),"
              f" largest {max(abs(one) for one, _ in pairs):.2f} ({largest:.2f}), at the end {pairs[-1][0]:.2f}"
              f" ({pairs[-1][1]:.2f}); rms difference {difference:.2f}, {difference / largest:.1%}")
    distance = [math.dist(one, other) for one, other in zip(run["tip"], run["rigid tip"])]
    print(f"tip: distance to that of the rigid arm {1e3 * distance[0]:.2f} mm at the start,"
          f" at most {1e3 * max(distance):.2f} mm, {1e3 * distance[-1]:.2f} mm at the end")
    if arguments.tolerance is not None and worst > arguments.tolerance:
        sys.exit(f"a difference of {worst:.1%} is larger than {arguments.tolerance:.1%}")


if __name__ == "__main__":
    main()
