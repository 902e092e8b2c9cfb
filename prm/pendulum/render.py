#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Draws positions of a swing into one picture, coloured by von Mises stress.

Needs python3-vtk9 and files with "VTU fields = von Mises stress"; without a display, start it
with xvfb-run.
"""

import argparse
import pathlib
import xml.etree.ElementTree

import vtk

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("record", help="solution.pvd of a run")
parser.add_argument("--output", default="swing.png", help="default: %(default)s")
parser.add_argument("--every", type=int, default=1, metavar="N", help="draw every Nth file")
parser.add_argument("--until", type=float, default=1e9, metavar="T", help="last time, s")
parser.add_argument("--maximum", type=float, default=0, metavar="S",
                    help="upper end of the colours, Pa; default: the largest stress")
arguments = parser.parse_args()

record = pathlib.Path(arguments.record)
entries = xml.etree.ElementTree.parse(record).iter("DataSet")
names = [e.get("file") for e in entries if float(e.get("timestep")) <= arguments.until]

surfaces = []
for name in names[::arguments.every]:
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(record.parent / name))
    reader.Update()
    reader.GetOutput().GetPointData().SetActiveVectors("displacement")
    warp = vtk.vtkWarpVector()
    warp.SetInputData(reader.GetOutput())
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputConnection(warp.GetOutputPort())
    surface.SetNonlinearSubdivisionLevel(2)  # the elements are quadratic
    surface.Update()
    surfaces.append(surface.GetOutput())

ranges = [s.GetPointData().GetArray("von_mises_stress").GetRange() for s in surfaces]
maximum = arguments.maximum or max(upper for _, upper in ranges)
colours = vtk.vtkLookupTable()
colours.SetHueRange(0.66, 0)
colours.SetTableRange(0, maximum / 1e6)
colours.Build()

renderer = vtk.vtkRenderer()
renderer.SetBackground(1, 1, 1)
for surface in surfaces:
    stress = vtk.vtkArrayCalculator()  # in MPa
    stress.SetInputData(surface)
    stress.AddScalarArrayName("von_mises_stress")
    stress.SetFunction("von_mises_stress / 1e6")
    stress.SetResultArrayName("MPa")
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(stress.GetOutputPort())
    mapper.SelectColorArray("MPa")
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SetLookupTable(colours)
    mapper.UseLookupTableScalarRangeOn()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    renderer.AddActor(actor)

bar = vtk.vtkScalarBarActor()
bar.SetLookupTable(colours)
bar.SetTitle("von Mises stress [MPa]")
bar.SetNumberOfLabels(4)
bar.SetLabelFormat("%.2f")
bar.SetOrientationToHorizontal()
bar.SetPosition(0.15, 0.86)
bar.SetWidth(0.7)
bar.SetHeight(0.12)
bar.SetUnconstrainedFontSize(True)
bar.SetVerticalTitleSeparation(8)
bar.SetMaximumNumberOfColors(256)
for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
    text.SetColor(0, 0, 0)
    text.SetFontSize(15)
    text.ItalicOff()
    text.BoldOff()
    text.ShadowOff()
renderer.AddActor2D(bar)

# the plane of motion, y to the right and z up
camera = renderer.GetActiveCamera()
camera.ParallelProjectionOn()
camera.SetFocalPoint(0, 0, -0.38)
camera.SetPosition(5, 0, -0.38)
camera.SetViewUp(0, 0, 1)
camera.SetParallelScale(0.68)
renderer.ResetCameraClippingRange()

window = vtk.vtkRenderWindow()
window.SetOffScreenRendering(True)
window.SetMultiSamples(8)
window.SetSize(1000, 620)
window.AddRenderer(renderer)
window.Render()
image = vtk.vtkWindowToImageFilter()
image.SetInput(window)
writer = vtk.vtkPNGWriter()
writer.SetFileName(arguments.output)
writer.SetInputConnection(image.GetOutputPort())
writer.Write()
