#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Changes CAD files at random places and lets the program validate a model with them.

Each must be accepted, or rejected with exit status 2 and one line that names the file: whatever
gmsh and the CAD kernel do with it, crashes included.
"""

import os
import random
import re
import subprocess
import time

from common import TOP, Checks, Folder, arguments

GEOMETRY = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 0.1, 0.05, 0.05};
Cylinder(2) = {0.05, 0.025, 0, 0, 0, 0.05, 0.01};
BooleanDifference{ Volume{1}; Delete; }{ Volume{2}; Delete; }
"""

MODEL = """subsection Bodies
  set Names = part
  subsection part
    set Mesh = {file}
    set Element = tetrahedron
    set Young's modulus = 2.1e11
    set Poisson's ratio = 0.3
    set Density = 7800
  end
end
subsection Time integration
  set End time = 1
  set Step size = 0.01
end
"""

# Longer than this is a hang, s; sanitizers make the program slower.
PATIENCE = 60 * int(os.environ.get("ACF_TEST_SLOWNESS", "1"))

TROUBLE = (b"0", b"-1", b"1e308", b"nan", b"2147483648", b"99999999999999999999", b"")
NUMBER = re.compile(rb"-?\d+(\.\d*)?([eE][-+]?\d+)?")


def changed(content, chance):
    """One change: a line repeated, dropped or moved, a number replaced, a byte, or the end cut."""
    kind = chance.choice(("line", "number", "number", "number", "byte", "end"))
    if kind == "line":
        lines = content.splitlines(keepends=True)
        line = lines.pop(chance.randrange(len(lines)))
        for _ in range(chance.randrange(3)):
            lines.insert(chance.randrange(len(lines) + 1), line)
        return b"".join(lines)
    if kind == "number":
        old = chance.choice(list(NUMBER.finditer(content)))
        new = chance.choice(TROUBLE + tuple(
            match.group() for match in chance.choices(list(NUMBER.finditer(content)), k=5)))
        return content[:old.start()] + new + content[old.end():]
    place = chance.randrange(len(content))
    if kind == "byte":
        return content[:place] + bytes([chance.randrange(256)]) + content[place + 1:]
    return content[:place]


def main():
    options = arguments(__doc__.splitlines()[0], 400, "changed files")
    chance = random.Random(options.seed)
    check = Checks()
    counts = {"accepted": 0, "rejected": 0, "crashed gmsh": 0}
    slowest = 0
    with Folder() as folder:
        (folder / "part.geo").write_text(GEOMETRY)
        originals = {}
        for kind in ("step", "brep"):
            subprocess.run(["gmsh", "-v", "0", "-0", "part.geo", "-o", f"part.{kind}"], cwd=folder,
                           stdout=subprocess.DEVNULL, check=True)
            originals[kind] = (folder / f"part.{kind}").read_bytes()
        originals["igs"] = (TOP / "tests" / "data" / "box.igs").read_bytes()
        for number in range(options.number):
            kind = list(originals)[number % len(originals)]
            content = originals[kind]
            if number >= len(originals):
                for _ in range(chance.randrange(1, 4)):
                    content = changed(content, chance)
            file = folder / f"changed.{kind}"
            file.write_bytes(content)
            (folder / "model.prm").write_text(MODEL.format(file=file.name))
            what = f"change {number} of a .{kind} file"
            start = time.monotonic()
            try:
                done = subprocess.run([options.program.resolve(), "--validate", "model.prm"], cwd=folder, capture_output=True,
                                      timeout=PATIENCE, check=False)
            except subprocess.TimeoutExpired:
                check(False, f"{what}: longer than {PATIENCE} s")
                continue
            slowest = max(slowest, time.monotonic() - start)
            message = done.stderr.decode(errors="replace")
            if done.returncode == 0:
                counts["accepted"] += 1
                continue
            check(number >= len(originals), f"{what}: {message}")
            check(done.returncode == 2, f"{what}: exit status {done.returncode}: {message}")
            check(message.count("\n") == 1 and "model.prm:4" in message,
                  f"{what}: message: {message}")
            counts["crashed gmsh" if "ended by signal" in message else "rejected"] += 1
    print(", ".join(f"{number} {name}" for name, number in counts.items()),
          f"(longest {slowest:.1f} s)")
    check.finish()


if __name__ == "__main__":
    main()
