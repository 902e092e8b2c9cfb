# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Pictures of the tables that the benchmarks write."""

import csv

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

# Methods keep their colour and marker in all pictures.
STYLES = {
    "2 stages": ("tab:blue", "o"),
    "3 stages": ("tab:cyan", "s"),
    "1 stage": ("tab:olive", "P"),
    "2 stages, double precision": ("navy", "o"),
    "2 stages, single precision": ("slateblue", "o"),
    "tolerance, 2 stages": ("tab:green", "^"),
    "tolerance, 3 stages": ("limegreen", "v"),
    "one-step matrices": ("tab:orange", "D"),
    "scheme of the paper": ("saddlebrown", "D"),
    "scheme of the paper, extrapolated": ("peru", "D"),
    "conventional": ("tab:red", "X"),
    "conventional, 1 iteration": ("lightcoral", "x"),
    "CalculiX": ("tab:purple", "*"),
    "explicit": ("black", "d"),
}


def read_rows(file):
    if not file.exists():
        return []
    with open(file, encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def number(text):
    return float(text) if text else None


def save(figure, file):
    figure.savefig(file, dpi=150)
    plt.close(figure)


def draw_work_precision(folder):
    rows = [row for row in read_rows(folder / "work_precision.csv") if row["error [m]"]]
    for model in dict.fromkeys(row["model"] for row in rows):
        figure, axes = plt.subplots(1, 2, sharex=True, sharey=True, figsize=(11, 6.8),
                                    constrained_layout=True)
        for axis, strain in zip(axes, ("reduced", "Green-Lagrange")):
            mine = [row for row in rows if row["model"] == model and row["strain"] == strain]
            for method in dict.fromkeys(row["method"] for row in mine):
                points = [(number(row["steps [s]"]), number(row["error [m]"]))
                          for row in mine if row["method"] == method]
                colour, marker = STYLES[method]
                axis.loglog(*zip(*points), color=colour, marker=marker, ms=7, lw=1.5,
                            label=method)
            axis.set_title(f"strain: {strain}")
            axis.set_xlabel("time in steps [s]")
            axis.grid(True, which="both", lw=0.3)
            if mine:
                axis.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.12), ncol=2)
        axes[0].set_ylabel("largest error of the position of a point [m]")
        unknowns = next(row["unknowns"] for row in rows if row["model"] == model)
        figure.suptitle(f"{model}, {unknowns} unknowns")
        save(figure, folder / f"work_precision-{model.replace(' ', '_')}.png")


def draw_mesh_cost(folder):
    rows = read_rows(folder / "mesh_cost.csv")
    if not rows:
        return
    figure, (times, memory) = plt.subplots(1, 2, figsize=(11, 5), constrained_layout=True)
    for body, marker, line in (("slender", "o", "-"), ("longer", "^", ":"), ("bulky", "s", "--")):
        mine = [row for row in rows if row["body"] == body]
        sizes = [number(row["unknowns"]) for row in mine]
        for axis, column, colour in ((times, "assembly [s]", "tab:green"),
                                     (times, "factorisation [s]", "tab:red"),
                                     (times, "step [s]", "tab:blue"),
                                     (memory, "factor memory [B]", "tab:orange"),
                                     (memory, "peak memory [B]", "tab:purple")):
            name = column.split(" [")[0]
            axis.loglog(sizes, [number(row[column]) for row in mine], color=colour,
                        marker=marker, ls=line, label=f"{name}, {body}")
    times.set_ylabel("time [s]")
    memory.set_ylabel("memory [B]")
    for axis in (times, memory):
        axis.set_xlabel("unknowns")
        axis.grid(True, which="both", lw=0.3)
        axis.legend(fontsize=8)
    save(figure, folder / "mesh_cost.png")


def draw_bodies_cost(folder):
    rows = read_rows(folder / "chain_cost.csv")
    if not rows:
        return
    figure, (steps, setup) = plt.subplots(1, 2, figsize=(11, 4.5), constrained_layout=True)
    for size in sorted({row["unknowns of a link"] for row in rows}, key=int):
        mine = [row for row in rows if row["unknowns of a link"] == size]
        links = [number(row["links"]) for row in mine]
        for column, style in (("per step and link", "o-"), ("per iteration and link", "s--")):
            times = [number(row[column + " [ms]"]) for row in mine]
            steps.loglog(links, [1e3 * time / number(size) for time in times], style,
                         label=f"{column} of {size} unknowns")
        setup.semilogx(links, [number(row["relative to one link"]) for row in mine], "o-",
                       label=f"assembly and factorisation, links of {size} unknowns")
    steps.set_ylabel("time per unknown [us]")
    setup.set_ylabel("time relative to one link")
    setup.set_ylim(bottom=0)
    for axis in (steps, setup):
        axis.set_xlabel("identical links of a chain")
        axis.grid(True, which="both", lw=0.3)
        axis.legend(fontsize=9)
    save(figure, folder / "bodies_cost.png")


def draw_solve_bandwidth(folder):
    rows = read_rows(folder / "solve_bandwidth.csv")
    if not rows:
        return
    figure, axis = plt.subplots(figsize=(7, 4.5), constrained_layout=True)
    for body, marker in (("slender", "o"), ("bulky", "s")):
        mine = [row for row in rows if row["body"] == body]
        axis.semilogx([1e-6 * number(row["factor memory [B]"]) for row in mine],
                      [100 * number(row["share"]) for row in mine], marker=marker, label=body)
    axis.axhline(60, color="grey", ls=":", label="60 %")
    axis.set_xlabel("memory of the factor [MB]")
    axis.set_ylabel("read by a solve, of the streaming bandwidth [%]")
    axis.set_ylim(bottom=0)
    axis.grid(True, which="both", lw=0.3)
    axis.legend()
    save(figure, folder / "solve_bandwidth.png")


def draw_all(folder):
    draw_work_precision(folder)
    draw_mesh_cost(folder)
    draw_bodies_cost(folder)
    draw_solve_bandwidth(folder)
