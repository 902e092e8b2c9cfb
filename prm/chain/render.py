#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Draws positions of the falling chain into one picture.

Needs python3-numpy, python3-matplotlib and python3-vtk9.
"""

import argparse
import pathlib
import xml.etree.ElementTree

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import vtk
from vtk.util.numpy_support import vtk_to_numpy

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("record", help="solution.pvd of a run")
parser.add_argument("--output", default="fall.png", help="default: %(default)s")
parser.add_argument("--every", type=int, default=1, metavar="N", help="draw every Nth file")
arguments = parser.parse_args()

record = pathlib.Path(arguments.record)
entries = list(xml.etree.ElementTree.parse(record).iter("DataSet"))[::arguments.every]
figure, axes = plt.subplots(figsize=(8, 4), constrained_layout=True)
colours = plt.cm.viridis([k / len(entries) for k in range(len(entries))])
for entry, colour in zip(entries, colours):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(record.parent / entry.get("file")))
    reader.Update()
    grid = reader.GetOutput()
    start = vtk_to_numpy(grid.GetPoints().GetData())
    points = start + vtk_to_numpy(grid.GetPointData().GetArray("displacement"))
    # the axis of the chain, which is undeformed along x at the start
    middle = (abs(start[:, 1]) < 1e-6) & (abs(start[:, 2]) < 1e-6)
    order = start[middle, 0].argsort(kind="stable")
    x, z = points[middle, 0][order], points[middle, 2][order]
    axes.plot(x, z, ".-", ms=1.5, lw=1, color=colour,
              label=f"{float(entry.get('timestep')):.3g} s")
axes.set_aspect("equal")
axes.set_xlabel("x [m]")
axes.set_ylabel("z [m]")
axes.grid(alpha=0.3)
axes.legend(fontsize="x-small", ncol=2)
figure.savefig(arguments.output, dpi=90)
