# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Pictures of deformed bodies, drawn by VTK without a window."""

import dataclasses
import math

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from acf_tools import display
from acf_tools.command_line import InputError
from acf_tools.fields import COMPONENTS, choose_field
from acf_tools.results import with_prefix

# ends, and the node between them, of the edges of VTK's quadratic cells
TETRAHEDRON_EDGES = ((0, 4, 1), (1, 5, 2), (2, 6, 0), (0, 7, 3), (1, 8, 3), (2, 9, 3))
HEXAHEDRON_EDGES = ((0, 8, 1), (1, 9, 2), (2, 10, 3), (3, 11, 0), (4, 12, 5), (5, 13, 6),
                    (6, 14, 7), (7, 15, 4), (0, 16, 4), (1, 17, 5), (2, 18, 6), (3, 19, 7))
CELL_EDGES = {24: (10, TETRAHEDRON_EDGES), 72: (27, HEXAHEDRON_EDGES)}

# viridis (S. van der Walt, N. Smith) without its darkest 15 %, at nine equal distances
SEQUENTIAL = (0x463480, 0x3A538B, 0x2E6F8E, 0x23898E, 0x1FA287, 0x3BBB75, 0x73D056, 0xB8DE29,
              0xFDE725)
DIVERGING = (0x2166AC, 0x67A9CF, 0xD1E5F0, 0xF7F7F7, 0xFDDBC7, 0xEF8A62, 0xB2182B)
CATEGORIES = (0x4E79A7, 0xF28E2B, 0x59A14F, 0xE15759, 0x76B7B2, 0xEDC948, 0xB07AA1, 0x9C755F)
LARGEST_LEGEND = 8


# errors of VTK are raised as exceptions here
messages = vtk.vtkStringOutputWindow()
vtk.vtkOutputWindow.SetInstance(messages)
vtk.vtkLogger.SetStderrVerbosity(vtk.vtkLogger.VERBOSITY_OFF)


def observe_errors(thing):
    """A list that gets an entry for each error of an object of VTK."""
    errors = []
    thing.AddObserver("ErrorEvent", lambda *_: errors.append(True))
    return errors


def rgb(colour):
    return tuple((colour >> shift & 255) / 255 for shift in (16, 8, 0))


@dataclasses.dataclass
class Options:
    """How bodies are shown; None: chosen from the results."""

    field: str = None
    range: tuple = None
    magnification: float = 1
    view: str = None
    up: str = None
    size: tuple = (1000, 700)
    edges: bool = True
    start: bool = False
    body_names: tuple = ()
    gravity: tuple = None


class Snapshot:
    """A file of VTK with the points at its positions."""

    def __init__(self, file, magnification):
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(file))
        errors = observe_errors(reader)
        reader.Update()
        self.grid = reader.GetOutput()
        if errors or not self.grid.GetNumberOfPoints():
            raise InputError(f"{file}: it is no file of VTK, or it is damaged")
        self.points = vtk_to_numpy(self.grid.GetPoints().GetData()).astype(float)
        self.bodies = self.bodies_of_points()
        self.positions = self.points.copy()
        if self.grid.GetPointData().HasArray("displacement"):
            self.positions += self.array("displacement", False)
            if magnification != 1:
                self.magnify(magnification)

    def array(self, name, is_cell_data):
        data = self.grid.GetCellData() if is_cell_data else self.grid.GetPointData()
        return vtk_to_numpy(data.GetArray(name)).astype(float)

    def arrays(self, is_cell_data):
        """Counts of components of the arrays by their names."""
        data = self.grid.GetCellData() if is_cell_data else self.grid.GetPointData()
        arrays = [data.GetArray(i) for i in range(data.GetNumberOfArrays())]
        return {a.GetName(): a.GetNumberOfComponents() for a in arrays}

    def cells(self):
        """Nodes of the cells of each type, a row per cell."""
        types = vtk_to_numpy(self.grid.GetCellTypesArray())
        connectivity = vtk_to_numpy(self.grid.GetCells().GetConnectivityArray())
        offsets = vtk_to_numpy(self.grid.GetCells().GetOffsetsArray())
        for kind in np.unique(types):
            if kind in CELL_EDGES:
                first = offsets[:-1][types == kind]
                yield kind, connectivity[first[:, None] + np.arange(CELL_EDGES[kind][0])]

    def bodies_of_points(self):
        bodies = np.zeros(self.grid.GetNumberOfPoints(), dtype=int)
        if self.grid.GetCellData().HasArray("body"):
            of_cells = vtk_to_numpy(self.grid.GetCellData().GetArray("body"))
            offsets = vtk_to_numpy(self.grid.GetCells().GetOffsetsArray())
            connectivity = vtk_to_numpy(self.grid.GetCells().GetConnectivityArray())
            bodies[connectivity] = np.repeat(of_cells, np.diff(offsets))
        return bodies

    def magnify(self, factor):
        """Enlarges the deformation of each body.

        The rigid motion that fits its nodes best (least squares; W. Kabsch, Acta
        Cryst. A32, 1976) stays as it is.
        """
        for body in np.unique(self.bodies):
            nodes = self.bodies == body
            start, now = self.points[nodes], self.positions[nodes]
            arms, places = start - start.mean(axis=0), now - now.mean(axis=0)
            u, _, vt = np.linalg.svd(arms.T @ places)
            sign = np.sign(np.linalg.det(u @ vt))
            rotation = u @ np.diag([1, 1, sign]) @ vt
            rigid = now.mean(axis=0) + arms @ rotation
            self.positions[nodes] = rigid + factor * (now - rigid)

    def values(self, field):
        """The values of a field at points or in cells."""
        values = self.array(field.array, field.is_cell_data)
        if values.ndim == 1:
            return values
        if not field.component:
            return np.linalg.norm(values, axis=1)
        return values[:, COMPONENTS[values.shape[1]].index(field.component)]

    def with_points(self, points):
        copy = vtk.vtkUnstructuredGrid()
        copy.ShallowCopy(self.grid)
        vtk_points = vtk.vtkPoints()
        vtk_points.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
        copy.SetPoints(vtk_points)
        return copy

    def surface(self, points, values=None, is_cell_data=False):
        """The curved surface, with the array 'shown'."""
        grid = self.with_points(points)
        grid.GetPointData().Initialize()
        grid.GetCellData().Initialize()
        if values is not None:
            array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
            array.SetName("shown")
            (grid.GetCellData() if is_cell_data else grid.GetPointData()).AddArray(array)
        surface = vtk.vtkDataSetSurfaceFilter()
        surface.SetInputData(grid)
        surface.SetNonlinearSubdivisionLevel(2)  # the elements are quadratic
        normals = vtk.vtkPolyDataNormals()
        normals.SetInputConnection(surface.GetOutputPort())
        normals.SetFeatureAngle(35)
        normals.Update()
        return normals.GetOutput()

    def edges(self, points):
        """The curved edges of the elements as lines of four pieces."""
        triples = [nodes[:, edges].reshape(-1, 3) for kind, nodes in self.cells()
                   for edges in [np.array(CELL_EDGES[kind][1])]]
        if not triples:
            return vtk.vtkPolyData()
        triples = np.concatenate(triples)
        _, first = np.unique(triples[:, 1], return_index=True)
        a, middle, b = (points[triples[first, i]] for i in range(3))
        s = np.linspace(0, 1, 5)[None, :, None]
        curves = ((1 - s) * (1 - 2 * s) * a[:, None] + 4 * s * (1 - s) * middle[:, None]
                  + s * (2 * s - 1) * b[:, None])
        lines = vtk.vtkPolyData()
        vtk_points = vtk.vtkPoints()
        vtk_points.SetData(numpy_to_vtk(curves.reshape(-1, 3), deep=True))
        lines.SetPoints(vtk_points)
        cells = vtk.vtkCellArray()
        ids = np.arange(5 * len(a), dtype=np.int64)
        offsets = np.arange(0, 5 * len(a) + 1, 5, dtype=np.int64)
        cells.SetData(numpy_to_vtk(offsets, deep=True, array_type=vtk.VTK_ID_TYPE),
                      numpy_to_vtk(ids, deep=True, array_type=vtk.VTK_ID_TYPE))
        lines.SetLines(cells)
        return lines


class Scene:
    """Pictures with the same camera and the same colours.

    They are chosen such that all the given files fit into them.
    """

    def __init__(self, files, options):
        self.options = options
        low, high, corners = math.inf, -math.inf, []
        self.field = None
        for file in files:
            snapshot = Snapshot(file, options.magnification)
            if self.field is None:
                self.field = choose_field(options.field, snapshot.arrays(False),
                                          snapshot.arrays(True))
                self.check(snapshot, file)
            values = self.values(snapshot, file)
            low, high = min(low, values.min()), max(high, values.max())
            corners.append(snapshot.positions)
            if options.start:
                corners.append(snapshot.points)
        if not np.isfinite([low, high]).all():
            raise InputError(f"field '{self.field.title}': not all values are finite")
        self.found = (low, high)
        self.range = self.choose_range(low, high)
        self.factor, self.unit = with_prefix(max(map(abs, self.range)), self.field.unit)
        self.choose_camera(np.concatenate(corners))

    def check(self, snapshot, file):
        if self.options.magnification != 1 and not snapshot.arrays(False).get("displacement"):
            raise InputError(f"{file}: it has no displacement to be magnified")

    def values(self, snapshot, file):
        if self.field.array not in snapshot.arrays(self.field.is_cell_data):
            raise InputError(f"{file}: it has no field '{self.field.array}', as the first file has")
        return snapshot.values(self.field)

    def choose_range(self, low, high):
        if self.options.range:
            return self.options.range
        if low < 0 < high:
            high = max(-low, high)
            return (-high, high)
        if 0 < low < 0.5 * high:
            low = 0
        return (low, high) if high > low else (low, low + (abs(low) or 1))

    # --- camera ---

    def choose_camera(self, positions):
        """The direction of view, and a frame into which all positions fit."""
        extent = positions.max(axis=0) - positions.min(axis=0)
        up = self.choose_up()
        view = self.options.view
        if view is None:
            # against the axis, across the vertical, in which least is to be seen
            axes = [i for i in range(3) if abs(up[i]) < 0.9]
            axis = min(axes, key=lambda i: extent[i] + 1e-6 * i)
            toward = np.zeros(3)
            toward[axis] = -1 if axis == 1 else 1
            side = np.cross(up, toward)
            toward = toward + 0.45 * side + 0.35 * up
        else:
            toward = parse_direction(view)
        toward = toward / np.linalg.norm(toward)
        if abs(toward @ up) > 0.999:
            up = np.eye(3)[1] if abs(toward[1]) < 0.9 else np.eye(3)[2]
        right = np.cross(up, toward)
        right /= np.linalg.norm(right)
        up = np.cross(toward, right)
        frame = positions @ np.column_stack([right, up, toward])
        low, high = frame.min(axis=0), frame.max(axis=0)
        self.centre = (low + high) / 2 @ np.array([right, up, toward])
        self.toward, self.up = toward, up
        self.extent = high - low

    def choose_up(self):
        if self.options.up:
            return parse_direction(self.options.up)
        gravity = np.array(self.options.gravity or (0, 0, 0), dtype=float)
        if np.linalg.norm(gravity) > 0:
            axis = np.argmax(abs(gravity))
            return -np.sign(gravity[axis]) * np.eye(3)[axis]
        return np.eye(3)[2]

    def set_camera(self, renderer, width, height):
        camera = renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        distance = 2 * np.linalg.norm(self.extent) or 1
        camera.SetFocalPoint(self.centre)
        camera.SetPosition(self.centre + distance * self.toward)
        camera.SetViewUp(self.up)
        half = max(self.extent[1] / 2, self.extent[0] / 2 * height / width)
        camera.SetParallelScale(1.08 * half or 1)
        renderer.ResetCameraClippingRange()

    # --- colours ---

    def is_categorical(self):
        return self.field.array == "body" and not self.options.range

    def colours(self):
        if self.is_categorical():
            table = vtk.vtkLookupTable()
            table.SetNumberOfTableValues(int(self.found[1]) + 1)
            table.SetTableRange(-0.5, int(self.found[1]) + 0.5)
            for i in range(table.GetNumberOfTableValues()):
                table.SetTableValue(i, *rgb(CATEGORIES[i % len(CATEGORIES)]), 1)
            return table
        low, high = (self.factor * value for value in self.range)
        anchors = DIVERGING if low < 0 < high else SEQUENTIAL
        colours = vtk.vtkColorTransferFunction()
        for s, colour in zip(np.linspace(low, high, len(anchors)), anchors):
            colours.AddRGBPoint(s, *rgb(colour))
        return colours

    def scale(self):
        """Size of letters and lines against that in a picture of 800 pixels."""
        width, height = self.options.size
        return max(0.5, min(width / 800, height / 500))

    def set_text(self, text, size):
        text.SetColor(0, 0, 0)
        text.SetFontFamilyToArial()
        text.SetFontSize(round(size * self.scale()))
        text.ItalicOff()
        text.BoldOff()
        text.ShadowOff()

    def legend(self, colours):
        """The colour bar, or for bodies their colours and names."""
        title = f"{self.field.title} [{self.unit}]" if self.unit else self.field.title
        if not self.is_categorical():
            bar = vtk.vtkScalarBarActor()
            bar.SetLookupTable(colours)
            bar.SetTitle(title)
            bar.SetNumberOfLabels(5)
            bar.SetLabelFormat("%.3g")
            bar.SetOrientationToHorizontal()
            bar.SetPosition(0.2, 0.04)
            bar.SetWidth(0.6)
            bar.SetHeight(0.92)
            bar.SetUnconstrainedFontSize(True)
            bar.SetVerticalTitleSeparation(round(6 * self.scale()))
            bar.SetMaximumNumberOfColors(256)
            bar.SetTextPositionToPrecedeScalarBar()
            self.set_text(bar.GetTitleTextProperty(), 15)
            self.set_text(bar.GetLabelTextProperty(), 14)
            return [bar]
        count = int(self.found[1]) + 1
        names = list(self.options.body_names) or [f"body {i}" for i in range(count)]
        if len(names) < count or count > LARGEST_LEGEND:
            return []
        actors = []
        for i in range(count):
            actor = vtk.vtkTextActor()
            actor.SetInput(names[i])
            self.set_text(actor.GetTextProperty(), 15)
            actor.GetTextProperty().SetColor(rgb(CATEGORIES[i]))
            actor.GetTextProperty().BoldOn()
            actor.GetTextProperty().SetJustificationToCentered()
            actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
            actor.SetPosition((i + 0.5) / count, 0.4)
            actors.append(actor)
        return actors

    # --- pictures ---

    def actors(self, snapshot, file, colours):
        values = self.values(snapshot, file) * (1 if self.is_categorical() else self.factor)
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputData(
            snapshot.surface(snapshot.positions, values, self.field.is_cell_data))
        if self.field.is_cell_data:
            mapper.SetScalarModeToUseCellFieldData()
        else:
            mapper.SetScalarModeToUsePointFieldData()
            mapper.InterpolateScalarsBeforeMappingOn()
        mapper.SelectColorArray("shown")
        mapper.SetLookupTable(colours)
        mapper.UseLookupTableScalarRangeOn()
        # behind the edges, which lie in the surface
        mapper.SetResolveCoincidentTopologyToPolygonOffset()
        mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(4, 40)
        surface = vtk.vtkActor()
        surface.SetMapper(mapper)
        self.set_material(surface)
        yield surface
        if self.options.edges:
            yield self.line_actor(snapshot.edges(snapshot.positions), 0.5)

    @staticmethod
    def set_material(actor):
        actor.GetProperty().SetAmbient(0.6)
        actor.GetProperty().SetDiffuse(0.42)
        actor.GetProperty().SetInterpolationToPhong()

    def line_actor(self, lines, opacity):
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputData(lines)
        mapper.ScalarVisibilityOff()
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(0, 0, 0)
        actor.GetProperty().SetOpacity(opacity)
        actor.GetProperty().LightingOff()
        actor.GetProperty().SetLineWidth(self.scale())
        return actor

    def start_actors(self, snapshot):
        """The bodies at the start, as through frosted glass."""
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputData(snapshot.surface(snapshot.points))
        mapper.ScalarVisibilityOff()
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        self.set_material(actor)
        actor.GetProperty().SetColor(0.6, 0.6, 0.6)
        actor.GetProperty().SetOpacity(0.25)
        yield actor
        if self.options.edges:
            yield self.line_actor(snapshot.edges(snapshot.points), 0.15)

    def axes_renderer(self, window):
        """The world axes, in the corner at the lower left."""
        axes = vtk.vtkAxesActor()
        axes.SetShaftTypeToCylinder()
        for caption in (axes.GetXAxisCaptionActor2D(), axes.GetYAxisCaptionActor2D(),
                        axes.GetZAxisCaptionActor2D()):
            caption.GetTextActor().SetTextScaleModeToNone()
            self.set_text(caption.GetCaptionTextProperty(), 14)
        renderer = vtk.vtkRenderer()
        width, height = self.options.size
        side = 85 * self.scale()
        renderer.SetViewport(0, 0, side / width, side / height)
        renderer.SetLayer(1)
        renderer.AddActor(axes)
        camera = renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetPosition(10 * self.toward)
        camera.SetFocalPoint(0, 0, 0)
        camera.SetViewUp(self.up)
        camera.SetParallelScale(1.5)
        renderer.ResetCameraClippingRange()
        window.AddRenderer(renderer)

    def draw(self, files, caption, picture):
        """Draws the given files into one picture."""
        display.open_display()
        width, height = self.options.size
        bar_height = 75 * self.scale() / height

        window = vtk.vtkRenderWindow()
        window.SetOffScreenRendering(True)
        window.SetMultiSamples(8)
        window.SetSize(width, height)
        window.SetNumberOfLayers(2)
        colours = self.colours()

        renderer = vtk.vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        renderer.SetViewport(0, bar_height, 1, 1)
        for file in files:
            snapshot = Snapshot(file, self.options.magnification)
            for actor in self.actors(snapshot, file, colours):
                renderer.AddActor(actor)
            if self.options.start and file is files[0]:
                for actor in self.start_actors(snapshot):
                    renderer.AddActor(actor)
        window.AddRenderer(renderer)
        self.set_camera(renderer, width, height * (1 - bar_height))

        if caption:
            text = vtk.vtkTextActor()
            text.SetInput(caption)
            self.set_text(text.GetTextProperty(), 15)
            text.GetTextProperty().SetVerticalJustificationToTop()
            text.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
            text.SetPosition(0.012, 0.985)
            renderer.AddActor2D(text)

        below = vtk.vtkRenderer()
        below.SetBackground(1, 1, 1)
        below.SetViewport(0, 0, 1, bar_height)
        for actor in self.legend(colours):
            below.AddActor2D(actor)
        window.AddRenderer(below)
        self.axes_renderer(window)

        window.Render()
        image = vtk.vtkWindowToImageFilter()
        image.SetInput(window)
        image.SetInputBufferTypeToRGB()
        image.ReadFrontBufferOff()
        writer = vtk.vtkPNGWriter()
        writer.SetCompressionLevel(9)
        writer.SetFileName(str(picture))
        writer.SetInputConnection(image.GetOutputPort())
        errors = observe_errors(writer)
        writer.Write()
        if errors:
            raise OSError(f"{picture}: the picture cannot be written")


def parse_direction(text):
    """'x', '-y' or '1,-2,0.5' as a unit vector."""
    name = text.lstrip("+-")
    if name in ("x", "y", "z") and len(text) - len(name) <= 1:
        return (-1 if text.startswith("-") else 1) * np.eye(3)["xyz".index(name)]
    try:
        vector = np.array([float(item) for item in text.split(",")])
    except ValueError:
        vector = np.zeros(0)
    if vector.shape != (3,) or not np.isfinite(vector).all() or not np.linalg.norm(vector) > 0:
        raise InputError(f"direction: found '{text}'; allowed: x, -x, y, -y, z, -z, or three "
                         "numbers, not all 0, separated by commas")
    return vector / np.linalg.norm(vector)
