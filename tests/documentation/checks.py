#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""
Usage: tests/documentation/checks.py TOP_OF_THE_SOURCES

Shows that each check of scripts/doc finds what it is for: a small manual has no
problems; with one thing broken it has one, in one line, and is not written.
"""

import concurrent.futures
import pathlib
import shutil
import subprocess
import sys
import tempfile

FILES = {
    "README.md": """# Title

Read [the manual](doc/README.md), [a part](doc/theory.md#theory) or the
[licence](LICENSE). `Body/Mass` is no path of an entry.
""",
    "LICENSE": "free\n",
    "doc/README.md": """# Manual

[program](../README.md), [model file](model-file.md), [theory](theory.md) and
a [section of this page](#section), a <a href="theory.md">link in HTML</a>

![picture](picture.png)

## Section

`Output/Interval` has a default; `weigh()` is a function. Theory (1.1) is a
formula.
""",
    "doc/picture.png": "no picture, but a file",
    "doc/model-file.md": """# Model file

**Top level**

| entry | default | meaning |
|---|---|---|
| `Title` | | for people |

**`Bodies`**: `Names`. **`Bodies/NAME`**:

| entry | default | unit | meaning |
|---|---|---|---|
| `Mass`, `Volume` | 1 | kg, m^3 | of the body |

**`Output`**

| entry | default | unit | meaning |
|---|---|---|---|
| `Interval` | 0 | s | between files |

| option | meaning |
|---|---|
| `--help`, `--quiet` | print, and not |
| `--set 'Section/Entry=value'` | an entry |
| `--` | end |

An example:

    set Title = A body
    acf-dealii --set 'Bodies/ball/Mass=2' model.prm
""",
    "doc/theory.md": """# Theory

`weigh()` computes

$$m = \\rho V, \\tag{1.1}$$

and `Ball::volume()`, as (1.1) needs it,

$$V = \\int dV. \\tag{1.2}$$

| formula | computed by |
|---|---|
| (1.1) | `weigh()` |
| (1.2) | `Ball`, `Ball::volume()` |
""",
    "include/acf/ball.h": """
namespace ACF
{
  /** A ball. See theory (1.2). */
  class Ball
  {
  public:
    /** $\\frac43 \\pi r^3$, m^3 */
    double volume() const;
  };

  /**
   * Its mass, see theory (1.1).
   * @param density kg/m^3
   */
  double weigh(const Ball &ball, const double density);
}
""",
    "program": """#!/bin/sh
if [ "$1" = --help ]; then
  echo "Options:"
  echo "  --help   print this text"
  echo "  --set 'Section/Entry=value'   set"
  echo "  --quiet  print nothing"
  exit
fi
cat <<'END'
# Listing of Parameters
# ---------------------
# What it is. Units: none.
set Title =


subsection Bodies
  # Names of bodies. Units: none.
  set Names = body


  subsection body
    # Of the body. Units: kg.
    set Mass   = 1

    # Its volume; default
    # is a litre. Units: m^3.
    set Volume = 0.001

  end

end


subsection Output
  # Between files. Units: s.
  set Interval = 0

end
END
"""}

# What is broken: file, text, text in its place, and what the problem says
BROKEN = [
    ("README.md", "doc/theory.md#theory", "doc/theorie.md",
     "README.md: the link 'doc/theorie.md' leads to nothing"),
    ("README.md", "#theory", "#practice",
     "the link 'doc/theory.md#practice' has an anchor"),
    ("README.md", "(LICENSE)", "(include)",
     "the link 'include' leads to a folder"),
    ("README.md", "(LICENSE)", "(../LICENSE)",
     "the link '../LICENSE' leads to nothing"),
    ("doc/README.md", "#section", "#sections",
     "the link '#sections' has an anchor"),
    ("doc/README.md", 'href="theory.md"', 'href="theories.md"',
     "the link 'theories.md' leads to nothing"),
    ("doc/README.md", "(picture.png)", "(film.png)",
     "the image 'film.png' leads to nothing"),
    ("doc/README.md", "[model file](model-file.md)", "model file",
     "no link to the page 'doc/model-file.md'"),
    ("doc/more.md", "", "# More\n", "no link to the page 'doc/more.md'"),
    ("doc/model-file.md", "`Mass`, `Volume`", "`Mass`",
     "the entry 'Bodies/NAME/Volume' of the program is not in"),
    ("program", "  set Interval", "  set Format = VTU\n  # I.\n  set Interval",
     "the entry 'Output/Format' of the program is not in"),
    ("doc/model-file.md", "`Names`", "`Names`, `Count`",
     "name 'Bodies/Count', which the program does not have"),
    ("doc/model-file.md", "| `Interval` |", "| `Interval`, `Steps` |",
     "name 'Output/Steps', which the program does not have"),
    ("program", "  # Between files. Units: s.\n", "",
     "the entry 'Output/Interval' has no documentation"),
    ("doc/model-file.md", "set Title", "set Heading",
     "an example sets 'Heading'"),
    ("doc/model-file.md", "ball/Mass", "ball/Weight",
     "names the entry 'Bodies/ball/Weight'"),
    ("doc/README.md", "`Output/Interval`", "`Output/Step`",
     "names the entry 'Output/Step'"),
    ("doc/model-file.md", "`--help`, `--quiet`", "`--help`",
     "the option '--quiet' of the program is not in the table"),
    ("doc/model-file.md", "`--quiet`", "`--quiet`, `--loud`",
     "the table of options names '--loud'"),
    ("doc/theory.md", "as (1.1)", "as (2.1)", "there is no formula (2.1)"),
    ("doc/README.md", "Theory (1.1)", "Theory (1.3)",
     "doc/README.md: there is no formula (1.3)"),
    ("include/acf/ball.h", "A ball.", "A ball, theory (3.1).",
     "include/acf/ball.h: there is no formula (3.1)"),
    ("doc/theory.md", "\\int dV. \\tag{1.2}$$",
     "\\int dV. \\tag{1.2}$$\n\n$$a = b$$\n",
     "0 numbers at the formula 'a = b'"),
    ("doc/theory.md", "$$\n\n| formula", "$$\n\n$$a \\tag{1.2}$$\n\n| formula",
     "the formula (1.2) follows (1.2)"),
    ("doc/theory.md", "| (1.1) | `weigh()` |\n", "",
     "the formula (1.1) is not in the table"),
    ("doc/theory.md", "| (1.1) | `weigh()`", "| (1.1) | `Ruler`",
     "'Ruler' of the formula (1.1) is not in the headers"),
    ("doc/theory.md", "| (1.1) | `weigh()` |", "| (1.1) | |",
     "no function computes (1.1)"),
    ("include/acf/ball.h", ", see theory (1.1)", "",
     "no doc comment refers to theory (1.1), which 'weigh()' computes"),
    ("doc/theory.md", "and `Ball::volume()`", "and `Ball::mass()`",
     "'Ball::mass()' is not in the headers"),
    ("doc/theory.md", "\\int dV", "\\integral dV", "doc/theory.md: pandoc: "),
    ("doc/README.md", "Theory (1.1)", "$$ a = { $$ (1.1)",
     "doc/README.md: a formula between $$ is not complete"),
    ("include/acf/ball.h", "@param density", "@param mass",
     "doxygen: include/acf/ball.h:"),
    ("include/acf/ball.h", "\\frac43", "\\frac{4",
     "doc comments: pandoc: "),
    ("doc/theory.md", None, None, "no page 'doc/theory.md'"),
]


class Tests:
    def __init__(self, top):
        self.top = pathlib.Path(top)
        self.n_checks = 0
        self.failures = []

    def check(self, message, holds):
        self.n_checks += 1
        if not holds:
            self.failures.append(message)

    def make(self, folder, name=None, old=None, new=None):
        """The small manual, with a text replaced in a file or without it."""
        shutil.copytree(self.top / "scripts", folder / "scripts")
        for file, text in FILES.items():
            (folder / file).parent.mkdir(parents=True, exist_ok=True)
            (folder / file).write_text(text)
        for file in ("Doxyfile", "api.dox"):
            shutil.copy(self.top / "doc" / file, folder / "doc")
        (folder / "program").chmod(0o755)
        if name is None:
            return
        file = folder / name
        if old is None:
            file.unlink()
        elif old == "":
            file.write_text(new)
        else:
            text = file.read_text()
            if text.count(old) != 1:
                raise RuntimeError(f"'{old}' is {text.count(old)} times in "
                                   f"{name}")
            file.write_text(text.replace(old, new))

    @staticmethod
    def run(folder, *arguments):
        return subprocess.run([folder / "scripts/doc", *arguments], cwd=folder,
                              capture_output=True, text=True)

    def good(self, folder):
        self.make(folder)
        for time in ("first", "second"):
            result = self.run(folder, "./program", "html")
            self.check(f"the good manual, {time} time: {result.stderr}",
                       result.returncode == 0 and not result.stderr)
        theory = (folder / "html/doc/theory.html").read_text()
        for text in ('id="eq-1.2"', "<mo>∫</mo>", 'href="#eq-1.1"',
                     "(1.1)", "volume()</code></a>"):
            self.check(f"theory.html does not contain {text}", text in theory)
        self.check("theory.html contains \\tag", "\\tag" not in theory)
        entries = (folder / "html/doc/parameters.html").read_text()
        for text in ("Bodies/NAME", "<code>Volume</code>",
                     "default is a litre", "m^3", "<code>0.001</code>"):
            self.check(f"parameters.html does not contain {text}",
                       text in entries)
        ball = "".join(file.read_text()
                       for file in (folder / "html/api").glob("*Ball.html"))
        for text in ("<mfrac>", '<a href="../doc/theory.html#eq-1.2">'):
            self.check(f"the page of Ball does not contain {text}",
                       text in ball)
        self.check("a page would load a program from the network", not any(
            'src="http' in file.read_text()
            for file in (folder / "html").rglob("*.html")))

    def wrong_use(self, folder):
        self.make(folder)
        (folder / "mine").mkdir()
        (folder / "mine/file").touch()
        for arguments, text in ((["./program"], "found 1 arguments"),
                                (["./none", "html"], "found './none'"),
                                (["/bin/false", "html"], "found '/bin/false'"),
                                (["./program", "mine"], "allowed: a new or")):
            result = self.run(folder, *arguments)
            self.check(f"{arguments}: {result.returncode} {result.stderr}",
                       result.returncode == 2 and text in result.stderr and
                       result.stderr.count("\n") == 1)
        self.check("the folder of others", (folder / "mine/file").exists())

    def broken(self, folder, name, old, new, expected):
        self.make(folder, name, old, new)
        result = self.run(folder, "./program", "html")
        what = f"{name}: '{old}' -> '{new}'"
        self.check(f"{what}: exit status {result.returncode}",
                   result.returncode == 1)
        self.check(f"{what}: no line with '{expected}': {result.stderr}",
                   expected in result.stderr)
        self.check(f"{what}: more than one line: {result.stderr}",
                   result.stderr.count("\n") == 1)
        self.check(f"{what}: the manual is written",
                   not (folder / "html").exists())


def main(top):
    tests = Tests(top)
    cases = [tests.good, tests.wrong_use]
    cases += [lambda folder, case=case: tests.broken(folder, *case)
              for case in BROKEN]
    with tempfile.TemporaryDirectory() as temporary, \
            concurrent.futures.ThreadPoolExecutor(2) as pool:
        results = []
        for k, case in enumerate(cases):
            folder = pathlib.Path(temporary) / str(k)
            folder.mkdir()
            results.append(pool.submit(case, folder))
        for result in results:
            result.result()
    for failure in tests.failures:
        print(f"FAILED: {failure}")
    print(f"{tests.n_checks} checks, {len(tests.failures)} failed")
    return 1 if tests.failures or tests.n_checks == 0 else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: checks.py TOP_OF_THE_SOURCES")
    sys.exit(main(sys.argv[1]))
