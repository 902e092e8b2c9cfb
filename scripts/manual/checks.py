# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""
Checks of the manual. Each function returns a list of problems, one line each.
"""

import html
import os
import posixpath
import re
import urllib.parse

from . import api as doxygen
from . import pages

THEORY = "doc/theory.md"

# Pages that tell of code: names with () in them are functions of the headers
PAGES_ON_CODE = (THEORY, "doc/adding-a-joint.md")

NUMBER = re.compile(r"\\tag\{(\d+\.\d+)\}")
IN_PARENTHESES = re.compile(r"\((\d+\.\d+)\)")


def check_links(top, all_pages):
    problems = []
    for name, page in all_pages.items():
        for kind, links in (("link", page.links), ("image", page.images)):
            for link in links:
                place = page.target(urllib.parse.unquote(link))
                if place is None:
                    continue
                file, anchor = place
                if file.startswith("../") or not (top / file).exists():
                    problems.append(f"{name}: the {kind} '{link}' leads to "
                                    "nothing")
                elif anchor and (file not in all_pages or
                                 anchor not in all_pages[file].anchors):
                    problems.append(f"{name}: the link '{link}' has an "
                                    f"anchor that '{file}' does not have")
                elif (top / file).is_dir() and \
                        posixpath.join(file, "README.md") not in all_pages:
                    problems.append(f"{name}: the {kind} '{link}' leads to a "
                                    "folder without page")
    return problems


def check_contents(all_pages):
    """Every page is linked from the table of contents."""
    contents = all_pages[pages.CONTENTS]
    linked = {place[0] for link in contents.links
              if (place := contents.target(link)) is not None}
    return [f"{pages.CONTENTS}: no link to the page '{name}'"
            for name in all_pages
            if name != pages.CONTENTS and name not in linked]


def formula_table(theory):
    """
    Rows of the tables with the heads "formula", "computed by": numbers and
    names in each.
    """
    for _, head, rows in theory.tables():
        if head[:2] == ["formula", "computed by"]:
            for row in rows:
                yield (IN_PARENTHESES.findall(pages.plain(row[0])),
                       pages.codes(row[1]))


def check_formulas(top, all_pages, api):
    """Numbers of formulas, references to them, and their functions."""
    theory, problems, numbers = all_pages[THEORY], [], []
    for element in pages.walk(theory.blocks):
        if element["t"] != "Math" or element["c"][0]["t"] != "DisplayMath":
            continue
        found = NUMBER.findall(element["c"][1])
        if len(found) != 1:
            text = " ".join(element["c"][1].split())
            problems.append(f"{THEORY}: {len(found)} numbers at the formula "
                            f"'{text[:60]}'")
        numbers += found
    order = [tuple(map(int, number.split("."))) for number in numbers]
    problems += [f"{THEORY}: the formula ({numbers[k]}) follows "
                 f"({numbers[k - 1]})"
                 for k in range(1, len(order)) if order[k] <= order[k - 1]]

    for name, page in all_pages.items():
        if any("$$" in e["c"] for e in pages.walk(page.blocks)
               if e["t"] == "Str"):
            problems.append(f"{name}: a formula between $$ is not complete")

    # references
    for number in IN_PARENTHESES.findall(pages.plain(theory.blocks)):
        if number not in numbers:
            problems.append(f"{THEORY}: there is no formula ({number})")
    for name, page in all_pages.items():
        for number in doxygen.REFERENCE.findall(pages.plain(page.blocks)):
            if number not in numbers:
                problems.append(f"{name}: there is no formula ({number}) in "
                                f"{THEORY}")
    in_header = {}
    for file in sorted((top / "include").rglob("*.h")):
        name = file.relative_to(top / "include").as_posix()
        in_header[name] = set(doxygen.REFERENCE.findall(file.read_text()))
        problems += [f"include/{name}: there is no formula ({number}) in "
                     f"{THEORY}"
                     for number in sorted(in_header[name] - set(numbers))]

    # functions
    tied = set()
    for row, names in formula_table(theory):
        tied.update(row)
        if not names:
            problems.append(f"{THEORY}: no function computes "
                            f"({'), ('.join(row)})")
        for name in names:
            symbol = api.find(name)
            if symbol is None:
                problems.append(f"{THEORY}: '{name}' of the formula "
                                f"({'), ('.join(row)}) is not in the headers")
                continue
            headers = api.headers[symbol]
            if not any(set(row) & in_header.get(h, set()) for h in headers):
                problems.append(f"include/{min(headers)}: no doc comment "
                                f"refers to theory ({'), ('.join(row)}), "
                                f"which '{name}' computes")
    problems += [f"{THEORY}: the formula ({number}) is not in the table of "
                 "formulas and functions"
                 for number in numbers if number not in tied]
    return problems


def check_code(all_pages, api):
    """Functions that pages tell of exist."""
    problems = []
    for name in PAGES_ON_CODE:
        page = all_pages.get(name)
        for code in pages.codes(page.blocks) if page else []:
            if re.fullmatch(r"[\w:]+\(\)", code) and api.find(code) is None:
                problems.append(f"{name}: '{code}' is not in the headers")
    return problems


def check_html(folder):
    """Links of the finished pages, those of Doxygen included."""
    anchors, links = {}, {}
    for file in sorted(folder.rglob("*.html")):
        text = file.read_text()
        name = file.relative_to(folder).as_posix()
        anchors[name] = {html.unescape(a) for a in re.findall(
            r'\b(?:id|name)="([^"]*)"', text)}
        links[name] = {html.unescape(link) for link in re.findall(
            r'<(?:a|img|link|script|iframe)\b[^>]*?\b(?:href|src)="([^"]*)"',
            text)}
    problems = []
    for name, targets in links.items():
        for link in sorted(targets):
            if re.match(r"[a-z][a-z0-9+.-]*:", link):
                if not link.startswith(("http:", "https:", "mailto:",
                                        "data:", "javascript:")):
                    problems.append(f"{name}: the address '{link}'")
                continue
            path, _, anchor = link.partition("#")
            file = name if not path else posixpath.normpath(posixpath.join(
                posixpath.dirname(name), urllib.parse.unquote(path)))
            if not os.path.exists(folder / file):
                problems.append(f"{name}: the link '{link}' leads to nothing")
            elif anchor and file in anchors and anchor not in anchors[file]:
                problems.append(f"{name}: the link '{link}' has an anchor "
                                f"that '{file}' does not have")
    return problems
