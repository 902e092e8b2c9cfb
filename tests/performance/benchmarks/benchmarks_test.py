#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Tests of what the benchmarks compute from their runs."""

import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from common import distance, growth_exponent
from work_precision import check_names, is_wanted, ratios, time_at_error


def row(method, error, time, strain="reduced", **more):
    return {"model": "pendulum", "method": method, "strain": strain, "value": 1e-3,
            "error [m]": error, "steps [s]": time, "with set-up [s]": time + 1, "note": "", **more}


class TimeAtError(unittest.TestCase):
    # time = error^(-1/3), as of a method of third order
    points = [(e, e**(-1 / 3)) for e in (1e-3, 1e-5, 1e-7)]

    def test_interpolates_powers_exactly(self):
        self.assertAlmostEqual(time_at_error(self.points, 3e-6), 3e-6**(-1 / 3), places=9)

    def test_does_not_extrapolate(self):
        self.assertIsNone(time_at_error(self.points, 9e-8))
        self.assertAlmostEqual(time_at_error(self.points, 1.), 10., places=9)

    def test_ignores_runs_that_others_beat(self):
        worse = self.points + [(1e-4, 1e3), (2e-5, 1e4)]
        self.assertEqual(time_at_error(worse, 3e-6), time_at_error(self.points, 3e-6))


class Ratios(unittest.TestCase):
    own = [row("2 stages", 1e-3, 1.), row("2 stages", 1e-5, 10.), row("3 stages", 1e-5, 5.)]

    def find(self, rows, program):
        return [r for r in ratios(rows) if r["program"] == program]

    def test_divides_by_the_time_at_the_same_error(self):
        rows = self.own + [row("one-step matrices", 1e-5, 80.)]
        [ratio] = self.find(rows, "2 stages")
        self.assertAlmostEqual(ratio["ratio of steps"], 8.)
        self.assertAlmostEqual(ratio["ratio with set-up"], 81 / 11)
        [ratio] = self.find(rows, "best")
        self.assertAlmostEqual(ratio["ratio of steps"], 16.)

    def test_baselines_are_no_part_of_the_best(self):
        rows = self.own + [row("one-step matrices", 1e-5, 1e-3), row("explicit", 1e-5, 50.)]
        [ratio] = [r for r in self.find(rows, "best") if r["baseline"] == "explicit"]
        self.assertAlmostEqual(ratio["ratio of steps"], 10.)

    def test_extrapolated_runs_take_the_error_of_another_model(self):
        rows = self.own + [row("explicit", 1e-5, 50.)]
        steel = [{**r, "model": "pendulum of steel"} for r in self.own]
        steel.append(row("explicit", "", 500., model="pendulum of steel"))
        [ratio] = [r for r in self.find(rows + steel, "2 stages")
                   if r["model"] == "pendulum of steel"]
        self.assertAlmostEqual(ratio["ratio of steps"], 50.)
        self.assertIn("error of the model 'pendulum'", ratio["note"])


class Names(unittest.TestCase):
    class Bench:
        quick = False
        models = ["slider-crank"]
        methods = ["2 stages Green-Lagrange", "explicit"]

    def test_methods_with_and_without_a_strain(self):
        check_names(self.Bench)
        self.assertTrue(is_wanted(self.Bench, "2 stages", "Green-Lagrange"))
        self.assertFalse(is_wanted(self.Bench, "2 stages", "reduced"))
        self.assertTrue(is_wanted(self.Bench, "explicit", "reduced"))
        self.assertFalse(is_wanted(self.Bench, "CalculiX", "Green-Lagrange"))

    def test_unknown_names_are_errors(self):
        class Wrong(self.Bench):
            methods = ["4 stages"]

        with self.assertRaises(SystemExit):
            check_names(Wrong)


class Numbers(unittest.TestCase):
    def test_growth_exponent(self):
        sizes = [10., 100., 500.]
        self.assertAlmostEqual(growth_exponent(sizes, [3 * n**1.15 for n in sizes]), 1.15)

    def test_distance_pairs_equal_times(self):
        reference = {"time [s]": [0., 0.1, 0.2], "x": [0., 1., 2.], "y": [0., 0., 0.]}
        run = {"time [s]": [0., 0.2], "x": [0., 2.3], "y": [0., 0.4]}
        self.assertAlmostEqual(distance(run, reference, ["x", "y"]), 0.5)


if __name__ == "__main__":
    unittest.main()
