# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Fields of VTU files: names, units, components."""

import dataclasses

from acf_tools.command_line import InputError

UNITS = {
    "displacement": "m",
    "velocity": "m/s",
    "von_mises_stress": "Pa",
    "peak_von_mises_stress": "Pa",
    "largest_von_mises_stress": "Pa",
    "stress": "Pa",
    "cell_stress": "Pa",
    "strain": "",
    "joint_force": "N",
    "mode_shape": "kg^-1/2",
    "body": "",
}

COMPONENTS = {1: (), 3: ("x", "y", "z"), 6: ("xx", "yy", "zz", "xy", "yz", "xz")}

# what is shown if nobody asks for a field: the first that there is
PREFERRED = ("von_mises_stress", "displacement", "velocity", "body")


@dataclasses.dataclass
class Field:
    """A scalar: an array, or a component or the magnitude of one."""

    array: str
    component: str
    is_cell_data: bool

    @property
    def unit(self):
        return UNITS.get(self.array, "")

    @property
    def title(self):
        name = self.array.replace("_", " ").replace("von mises", "von Mises")
        return f"{name} {self.component}".rstrip()


def choose_field(text, point_arrays, cell_arrays):
    """The field that a text names: 'von Mises stress', 'velocity:x', 'stress:xx'.

    The dictionaries have the counts of components of all arrays. Without a text
    the first of the preferred fields.
    """
    arrays = {**cell_arrays, **point_arrays}
    if text is None:
        text = next((name for name in PREFERRED if name in arrays), None)
        if text is None:
            raise InputError("the files have no field that can be shown")
    name, _, component = text.partition(":")
    name = "_".join(name.split()).lower()
    component = component.strip()
    if name not in arrays:
        raise InputError(f"field: found '{text}'; allowed, as these are in the files: "
                         + ", ".join(sorted(arrays)))
    allowed = COMPONENTS.get(arrays[name], ())
    if component and component not in allowed:
        raise InputError(f"field: found component '{component}'; allowed for {name}: "
                         + (", ".join(allowed) or "none"))
    if not component and arrays[name] == 6:
        component = allowed[0]
    if not component and arrays[name] == 3:
        return Field(name, "", name not in point_arrays)
    return Field(name, component, name not in point_arrays)
