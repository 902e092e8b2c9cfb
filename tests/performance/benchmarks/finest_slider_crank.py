# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""The slider-crank of the paper as it was published: 3200 steps of 0.5 ms."""

from common import Failed, Unsupported, distance

MODEL = "prm/slider-crank/slider-crank-finest.prm"
POINT = ["slider.y [m]"]


def run(bench):
    settings = {"Time integration/End time": 1.6, "Time integration/Step size": 5e-4,
                "Output/Probe interval": 0.02, "Output/VTU interval": 0}
    if bench.quick:
        settings.update({f"Bodies/{body}/Mesh size": 0.05 for body in ("crank", "rod")})
        settings["Time integration/End time"] = 0.04
    runs = [("steps of 0.5 ms", {})]
    runs += [(f"tolerance {tolerance}", {"Time integration/Tolerance": tolerance})
             for tolerance in ("1e-4", "1e-5", "1e-6")]
    rows, first = [], None
    for name, changes in runs:
        try:
            result = bench.simulate(f"finest slider-crank, {name}", MODEL,
                                    {**settings, **changes}, repetitions=1)
        except (Failed, Unsupported) as error:
            bench.say(f"finest slider-crank, {name}: left out: "
                      f"{str(error).split('; allowed')[0]}")
            continue
        first = first or result
        solves = result.seconds("solves")
        rows.append({"run": name, "unknowns": result.unknowns(), "steps": result.count("steps"),
                     "iterations": result.count("newton iterations"), "solves": result.solves(),
                     "solves per step and body":
                         result.solves() / result.count("steps") / len(result.statistics["bodies"]),
                     "factorisations": result.factorizations(), "steps [s]": result.steps,
                     "with set-up [s]": result.total, "solves [s]": solves,
                     "steps relative to solves": result.steps / solves,
                     "gain to steps of 0.5 ms": first.steps / result.steps,
                     "difference of the slider [m]":
                         distance(result.probes, first.probes, POINT),
                     "peak memory [B]": result.count("peak memory [B]")})
        bench.say(f"finest slider-crank, {name}: {result.steps:.4g} s in steps, "
                  f"{result.steps / solves:.3g} times the solves")
        bench.write_table("finest_slider_crank.csv", rows)
