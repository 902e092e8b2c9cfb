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
    """Files of VTK and their times, in this order.

    The argument is a folder of results, a list (.pvd) or a file (.vtu).
    """

    def __init__(self, name):
        path = pathlib.Path(name)
        if path.is_dir():
            if not (path / "solution.pvd").is_file():
                raise InputError(f"{name}: the folder has no solution.pvd; "
                                 "a run writes it if the entry 'Output/VTU interval' is not 0")
            path = path / "solution.pvd"
        elif not path.exists():
            raise InputError(f"{name}: there is no such file or folder")
        self.path = path
        self.folder = path.parent
        if path.suffix == ".vtu":
            self.times, self.files = [None], [path]
        elif path.suffix == ".pvd":
            self.times, self.files = read_list(path)
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
