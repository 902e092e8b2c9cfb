# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Cost against the number of unknowns, of slender and bulky bodies."""

from common import Failed, growth_exponent

STEP_SIZE = 1e-3  # s

# Counts of hexahedra, each cut into 24 tetrahedra: the blade of the pendulum
# (one cell across), the same with cells of one size and more of them along its
# length, and a cube.
SLENDER = ["1, 20, 1", "1, 40, 2", "1, 80, 4", "1, 152, 8", "1, 272, 14"]
LONGER = ["1, 20, 2", "1, 40, 2", "1, 160, 2", "1, 560, 2", "1, 1720, 2"]
CELL_LENGTH = 0.025  # m
BULKY = ["2, 2, 2", "4, 4, 4", "6, 6, 6", "9, 9, 9", "12, 12, 12"]


def length_settings(cells):
    length = CELL_LENGTH * int(cells.split(",")[1])
    return {"Bodies/pendulum/Box to": f"0.00125, {length}, 0.025",
            "Probes/chord/Point": f"0, {length / 2}, 0"}


def bodies(quick):
    """Kind, model file, body, counts of cells, and settings that belong to a count."""
    pendulum = ("prm/pendulum/pendulum.prm", "pendulum")
    yield ("slender", *pendulum, ["1, 4, 1", "1, 8, 1"] if quick else SLENDER, lambda cells: {})
    yield ("longer", *pendulum, ["1, 4, 1", "1, 8, 1"] if quick else LONGER, length_settings)
    yield ("bulky", "tests/performance/benchmarks/cube.prm", "cube",
           ["1, 1, 1", "2, 2, 2"] if quick else BULKY, lambda cells: {})


def run(bench):
    n_steps = 3 if bench.quick else 20
    rows, exponents = [], []
    for kind, model, body, meshes, more_settings in bodies(bench.quick):
        mine = []
        for cells in meshes:
            settings = {f"Bodies/{body}/Element": "tetrahedron", f"Bodies/{body}/Cells": cells,
                        "Time integration/Step size": STEP_SIZE,
                        "Time integration/End time": n_steps * STEP_SIZE,
                        "Output/VTU interval": 0, "Validity/Action": "ignore",
                        **more_settings(cells)}
            try:
                result = bench.simulate(f"mesh, {kind}, {cells}", model, settings)
            except Failed as error:
                bench.say(f"{kind}, {cells}: {error}")
                break
            steps = result.count("steps")
            mine.append({
                "body": kind, "cells": cells, "unknowns": result.unknowns(),
                "assembly [s]": result.seconds("assembly"),
                "factorisation [s]": result.seconds("factorisation"),
                "step [s]": result.steps / steps,
                "solves [s per step]": result.seconds("solves") / steps,
                "solves per step": result.solves() / steps,
                "factor entries": result.count("factor entries"),
                "factor memory [B]": result.count("factor memory [B]"),
                "peak memory [B]": result.count("peak memory [B]"),
                "repetitions": result.repetitions})
            bench.say(f"{kind}, {mine[-1]['unknowns']} unknowns: factorisation "
                      f"{mine[-1]['factorisation [s]']:.3g} s, step {mine[-1]['step [s]']:.3g} s")
        rows += mine
        for column in ("assembly [s]", "factorisation [s]", "step [s]", "solves [s per step]",
                       "factor memory [B]", "peak memory [B]"):
            for which, some in (("all", mine), ("last three", mine[-3:])):
                if len(some) > 1:
                    exponents.append({
                        "body": kind, "meshes": which, "quantity": column,
                        "growth exponent": growth_exponent([row["unknowns"] for row in some],
                                                           [row[column] for row in some])})
        bench.write_table("mesh_cost.csv", rows)
        bench.write_table("mesh_cost_exponents.csv", exponents)
