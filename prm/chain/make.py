#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Writes the model file of a chain of identical links to standard output.

Usage: make.py [number of links] > chain.prm
"""
import sys

n_links = int(sys.argv[1]) if len(sys.argv) > 1 else 50
length = 0.1  # m

LINK = """
  subsection link {k}
    set Mesh            = box
    set Element         = hexahedron
    set Box from        = 0,   -0.005, -0.005
    set Box to          = {length}, 0.005, 0.005
    set Cells           = 2, 1, 1
    set Young's modulus = 2e8
    set Poisson's ratio = 0.3
    set Density         = 1000
    set Position        = {x:g}, 0, 0
  end
"""

JOINT = """
  subsection joint {k}
    set Type    = spherical
    set Between = link {k}: x min, {other}
  end
"""


def names(what):
    lines, line = [], "  set Names = "
    for k in range(1, n_links + 1):
        item = f"{what} {k}" + (", " if k < n_links else "")
        if len(line + item) > 76:
            lines.append(line + "\\")
            line = "    "
        line += item
    return "\n".join(lines + [line.rstrip()])


bodies = "".join(LINK.format(k=k, length=length, x=length * (k - 1))
                 for k in range(1, n_links + 1))
joints = "".join(JOINT.format(k=k, other="ground" if k == 1 else f"link {k - 1}: x max")
                 for k in range(1, n_links + 1))

print(f"""# A chain of {n_links} identical elastic links (see README.md), written by make.py.

set Title = Chain of {n_links} links

subsection Bodies
{names("link")}
{bodies}end

subsection Joints
{names("joint")}
{joints}end

subsection Loads
  set Gravity = 0, 0, -9.81                       # m/s^2
end

subsection Time integration
  set Stages    = 2
  set End time  = 1                               # s
  set Step size = 2e-3
end

subsection Output
  set VTU interval = 0.02                         # s
end

subsection Probes
  set Names = end, energy, support

  subsection end
    set Type = mean position
    set Of   = link {n_links}: x max
  end

  subsection energy
    set Type = energy
  end

  subsection support
    set Type = reaction
    set Of   = joint 1
  end
end""")
