#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Writes the model file of a Bennett linkage (see README.md) to standard output.

Usage: make.py > four-bar.prm. Needs python3-numpy.
"""
import numpy as np

A, ALPHA = 0.2, np.radians(30)   # crank and rocker: length in m, twist
B, BETA = 0.4, np.radians(90)    # coupler and ground; A / sin(ALPHA) = B / sin(BETA)
START = np.radians(120)          # angle of the crank at the start
SPEED = 2 * np.pi                # rad/s
SIDE = 0.02                      # of the square cross-sections, m


def turn(axis, angle):
    """Rotation matrix about a coordinate axis."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R = np.eye(3)
    R[i, i] = R[j, j] = np.cos(angle)
    R[j, i], R[i, j] = np.sin(angle), -np.sin(angle)
    return R


def other_angle(theta):
    """Angle between crank and coupler that belongs to the crank's angle."""
    ratio = np.sin((BETA + ALPHA) / 2) / np.sin((BETA - ALPHA) / 2)
    return 2 * np.arctan2(ratio * np.cos(theta / 2), np.sin(theta / 2))


def frames(theta):
    """Places (origin, axes) of crank, coupler and rocker.

    Each x axis is the common normal of a link's two joint axes; the joint at
    its origin has the z axis (Denavit and Hartenberg). Lengths, twists and
    angles of opposite joints repeat: theta, phi, -theta, -phi.
    """
    phi = other_angle(theta)
    result, p, R = [], np.zeros(3), np.eye(3)
    for angle, length, twist in ((theta, A, ALPHA), (phi, B, BETA), (-theta, A, ALPHA),
                                 (-phi, B, BETA)):
        R = R @ turn(2, angle)
        result.append((p, R))
        p = p + R[:, 0] * length
        R = R @ turn(0, twist)
    assert np.allclose(p, 0, atol=1e-12) and np.allclose(R, np.eye(3), atol=1e-12)
    return result


def rotation_vector(R):
    """Axis times angle of a rotation by less than a half turn."""
    w = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / 2
    sine = np.linalg.norm(w)
    return w / sine * np.arctan2(sine, (np.trace(R) - 1) / 2)


def text(vector):
    return ", ".join(f"{round(float(x), 15) + 0.:.15g}" for x in vector)


BODY = """
  subsection {name}
    set Mesh             = box
    set Element          = hexahedron
    set Box from         = 0, {low:g}, {low:g}          # m
    set Box to           = {length:g}, {high:g}, {high:g}
    set Cells            = {cells}, 1, 1
    set Young's modulus  = 2.1e11                   # Pa
    set Poisson's ratio  = 0.3
    set Density          = 7800                     # kg/m^3
    set Position         = {position}
    set Rotation         = {rotation}
    set Velocity         = {velocity}
    set Angular velocity = {spin}
  end
"""

JOINT = """
  subsection {name}
    set Type    = revolute
    set Between = {between}
    set Axis    = {axis}{drive}
  end
"""

names = ["crank", "coupler", "rocker"]
lengths = [A, B, A]
start = frames(START)

bodies = ""
step = 1e-5
for k, name in enumerate(names):
    p, R = start[k]
    centre = np.array([lengths[k] / 2, 0, 0])
    # central differences of order four with respect to the crank's angle
    around = [frames(START + m * step)[k] for m in (-2, -1, 1, 2)]
    weights = np.array([1, -8, 8, -1]) * SPEED / (12 * step)
    velocity = sum(w * (q + Q @ centre) for w, (q, Q) in zip(weights, around))
    S = sum(w * Q for w, (_, Q) in zip(weights, around)) @ R.T
    bodies += BODY.format(name=name, low=-SIDE / 2, high=SIDE / 2, length=lengths[k],
                          cells=round(lengths[k] / 0.05), position=text(p),
                          rotation=text(rotation_vector(R)),
                          velocity=text(np.round(velocity, 9)),
                          spin=text(np.round([S[2, 1], S[0, 2], S[1, 0]], 9)))

between = {"drive": "crank: x min, ground", "crank pin": "coupler: x min, crank: x max",
           "rocker pin": "rocker: x min, coupler: x max", "output": "rocker: x max, ground"}
axes = [R[:, 2] for _, R in start]
joints = ""
for k, (name, sides) in enumerate(between.items()):
    drive = f"\n    set Angular velocity = {SPEED:.15g}    # rad/s" if k == 0 else ""
    joints += JOINT.format(name=name, between=sides, axis=text(axes[k]), drive=drive)

print(f"""# A Bennett linkage (see README.md), written by make.py.

set Title = Bennett linkage

subsection Bodies
  set Names = {", ".join(names)}
{bodies}end

subsection Joints
  set Names = {", ".join(between)}
{joints}end

# The velocities are rounded.
subsection Start
  set Projection = velocities
end

subsection Time integration
  set Stages    = 2
  set End time  = 1                               # s, one turn
  set Step size = 5e-4
end

subsection Output
  set VTU interval = 0.02                         # s
end

subsection Probes
  set Names = drive, output, crank pin, drive reaction

  subsection drive
    set Type = joint angle
    set Of   = drive
  end

  subsection output
    set Type = joint angle
    set Of   = output
  end

  # moves on a circle of the crank's radius
  subsection crank pin
    set Type = mean position
    set Of   = crank: x max
  end

  subsection drive reaction
    set Type = reaction
    set Of   = drive
  end
end""")
