# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Curves over time as SVG."""

import io

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from acf_tools.results import with_prefix


def svg(figure):
    """The figure as text of an SVG file; closes the figure."""
    stream = io.StringIO()
    figure.savefig(stream, format="svg", metadata={"Date": None})
    plt.close(figure)
    return stream.getvalue()


def curves(time, lines, unit, width=7.0, height=2.8):
    """Curves over time with a common unit: lines is a list of name and values."""
    largest = max((abs(v) for _, values in lines for v in values), default=0)
    factor, shown = with_prefix(largest, unit)
    figure, axes = plt.subplots(figsize=(width, height), constrained_layout=True)
    for name, values in lines:
        # a run that was interrupted at the start has one row
        axes.plot(time, [factor * v for v in values], label=name, lw=1.2,
                  marker="o" if len(values) == 1 else None)
    axes.set_xlabel("time [s]")
    axes.set_ylabel(f"[{shown}]" if shown else "")
    axes.grid(alpha=0.3)
    axes.margins(x=0.01)
    axes.legend(fontsize="small", loc="center left", bbox_to_anchor=(1, 0.5))
    return svg(figure)


def steps(time, sizes, width=7.0, height=2.2):
    """Step sizes, each over its step."""
    figure, axes = plt.subplots(figsize=(width, height), constrained_layout=True)
    axes.stairs(sizes, time, lw=1.2)
    low, high = min(sizes), max(sizes)
    if high > 10 * low:
        axes.set_yscale("log")
    else:
        axes.set_ylim(0, 1.15 * high)
    axes.set_xlabel("time [s]")
    axes.set_ylabel("step size [s]")
    axes.grid(alpha=0.3)
    axes.margins(x=0.01)
    return svg(figure)
