# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Programs of the test folder that print comma-separated values themselves."""

import csv
import io


def run(bench, name, options=()):
    """Stores what a program prints, and shows it."""
    options = list(options) + (["--quick"] if bench.quick else [])
    text = bench.execute([bench.build / "tests" / name, *options])
    (bench.output / f"{name}.csv").write_text(text, encoding="utf-8")
    for row in csv.DictReader(io.StringIO(text)):
        bench.say(f"{name}: " + ", ".join(f"{key} {value}" for key, value in row.items()))
