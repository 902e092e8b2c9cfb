# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Files that a run of acf-dealii writes."""

import csv
import json
import math
import pathlib
import xml.etree.ElementTree

from acf_tools.command_line import InputError


class Snapshots:
    """Files with fields and their times, in this order.

    The argument is a folder of results, a list (.pvd) or a file (.vtu). If
    with_xdmf is true, the list may also be a .xdmf; the files are then objects
    of the class Step.
    """

    def __init__(self, name, with_xdmf=False):
        path = pathlib.Path(name)
        if path.is_dir():
            lists = [path / f"solution{end}" for end in (".pvd", ".xdmf")]
            found = [entry for entry in lists if entry.is_file()]
            if not found:
                raise InputError(f"{name}: the folder has no solution.pvd{' or .xdmf' * with_xdmf}; "
                                 "a run writes it if the entry 'Output/VTU interval' is not 0")
            path = found[0]
        elif not path.exists():
            raise InputError(f"{name}: there is no such file or folder")
        self.path = path
        self.folder = path.parent
        if path.suffix == ".vtu":
            self.times, self.files = [None], [path]
        elif path.suffix == ".pvd":
            self.times, self.files = read_list(path)
        elif path.suffix == ".xdmf" and with_xdmf:
            self.times, self.files = read_xdmf_list(path)
        elif path.suffix == ".xdmf":
            raise InputError(f"{path}: found results in XDMF, which only ParaView shows; allowed: "
                             "VTU files, which a run writes with the entry 'Output/Format = VTU'")
        else:
            raise InputError(f"{name}: allowed: a folder of results, a file .pvd or a file .vtu")

    def nearest(self, time):
        """Index of the file at this time, up to half an interval."""
        if self.times[0] is None:
            raise InputError(f"{self.path}: a single file has no times; give its solution.pvd")
        k = min(range(len(self.times)), key=lambda i: abs(self.times[i] - time))
        gaps = [b - a for a, b in zip(self.times, self.times[1:])]
        if abs(self.times[k] - time) > 0.5 * max(gaps, default=0) * (1 + 1e-9):
            raise InputError(f"{self.path}: found time {time:g}; allowed: {self.times[0]:g} to "
                             f"{self.times[-1]:g} s, with files every {max(gaps, default=0):g} s")
        return k


def read_list(path):
    """Times and files of a .pvd."""
    try:
        entries = list(xml.etree.ElementTree.parse(path).iter("DataSet"))
        pairs = [(float(e.attrib["timestep"]), path.parent / e.attrib["file"]) for e in entries]
    except (xml.etree.ElementTree.ParseError, KeyError, ValueError) as error:
        raise InputError(f"{path}: it is no list of files for ParaView ({error})") from error
    if not pairs:
        raise InputError(f"{path}: it names no file")
    for _, file in pairs:
        if not file.is_file():
            raise InputError(f"{path}: it names {file.name}, which is not there")
    return [time for time, _ in pairs], [file for _, file in pairs]


class Step:
    """A time of a list in XDMF: the elements Grid of its bodies, and the file of their fields."""

    def __init__(self, folder, bodies):
        self.bodies = bodies
        names = [item.text.strip().partition(":")[0] for body in bodies
                 for item in body.iter("DataItem")]
        self.files = [folder / name for name in dict.fromkeys(names)]

    def __str__(self):
        return str(self.files[-1])  # points and cells come first

    def arrays(self, centre):
        """Counts of components of the arrays at the centre 'Node' or 'Cell' by their names."""
        return {a.attrib["Name"]: int(a.find("DataItem").attrib["Dimensions"].split()[1])
                for a in self.bodies[0].findall("Attribute") if a.attrib["Center"] == centre}


def read_xdmf_list(path):
    """Times and steps of a solution.xdmf."""
    try:
        grids = xml.etree.ElementTree.parse(path).getroot().findall("Domain/Grid/Grid")
        times = [float(grid.find("Time").attrib["Value"]) for grid in grids]
        steps = [Step(path.parent, grid.findall("Grid")) for grid in grids]
        for step in steps:
            step.arrays("Node")
    except (xml.etree.ElementTree.ParseError, AttributeError, KeyError, ValueError,
            IndexError) as error:
        raise InputError(f"{path}: it is no list of acf-dealii in XDMF ({error})") from error
    if not steps:
        raise InputError(f"{path}: it names no file")
    for file in (file for step in steps for file in step.files):
        if not file.is_file():
            raise InputError(f"{path}: it names {file.name}, which is not there")
    return times, steps


def read_probes(path):
    """Columns of probes.csv by their names, in their order; lists of numbers."""
    with open(path, encoding="utf-8", newline="") as stream:
        rows = list(csv.reader(stream))
    if not rows or not rows[0] or rows[0][0] != "time [s]":
        raise InputError(f"{path}: the first column is not 'time [s]'")
    columns = {name: [] for name in rows[0]}
    for line, row in enumerate(rows[1:], 2):
        if len(row) != len(columns):
            raise InputError(f"{path}:{line}: found {len(row)} columns; allowed: {len(columns)}")
        for name, text in zip(columns, row):
            try:
                columns[name].append(float(text))
            except ValueError:
                raise InputError(f"{path}:{line}: found '{text}'; allowed: a number") from None
    return columns


def read_statistics(path):
    """statistics.json; its objects keep the order of the file."""
    try:
        with open(path, encoding="utf-8") as stream:
            return json.load(stream)
    except json.JSONDecodeError as error:
        raise InputError(f"{path}: it is no JSON ({error})") from error


def read_parameters(path):
    """Entries of a used_parameters.prm, by 'Section/Entry'; those that are not empty.

    The file is written by the program: one entry a line, comments after #, long
    lines continued by a backslash.
    """
    entries, sections = {}, []
    with open(path, encoding="utf-8") as stream:
        text = stream.read().replace("\\\n", " ")
    for line in text.splitlines():
        line = " ".join(line.split("#")[0].split())
        if line.startswith("subsection "):
            sections.append(line[len("subsection "):])
        elif line == "end" and sections:
            sections.pop()
        elif line.startswith("set ") and "=" in line:
            name, value = line[len("set "):].split("=", 1)
            if value.strip():
                entries["/".join(sections + [name.strip()])] = value.strip()
    return entries


def names(entries, section):
    """The names that a section of a model lists."""
    text = entries.get(f"{section}/Names", "")
    return [name.strip() for name in text.split(",") if name.strip()]


def split_column(name):
    """'tip.x [m]' -> ('tip', 'x', 'm')."""
    head, _, unit = name.rpartition(" [")
    if not head:
        return name, "", ""
    probe, _, component = head.rpartition(".")
    return (probe or component), (component if probe else ""), unit.rstrip("]")


def with_prefix(largest, unit):
    """A factor and a unit in which a value of this size has few digits: 1e-6, 'MPa'."""
    if unit not in ("Pa", "m", "N", "N m", "J", "W", "m/s") or not largest > 0 or \
            not math.isfinite(largest):
        return 1, unit
    table = {"Pa": "kMG", "N": "mkM", "N m": "mkM", "J": "mkM", "W": "mkM", "m": "mµ", "m/s": "m"}
    powers = {"µ": -6, "m": -3, "": 0, "k": 3, "M": 6, "G": 9}
    exponent = math.floor(math.log10(largest) + 1e-9)
    allowed = sorted([powers[p] for p in table[unit]] + [0])
    power = max([p for p in allowed if p <= exponent], default=allowed[0])
    prefix = next(p for p, e in powers.items() if e == power)
    return 10.0**-power, prefix + unit
