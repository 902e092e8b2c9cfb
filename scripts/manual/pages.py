# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Pages of the manual as syntax trees of pandoc."""

import json
import posixpath
import re
import subprocess

# Markdown as GitHub reads it, with the same anchors of headings
READER = "gfm+tex_math_dollars"

# Where pages of the manual are, besides README.md
PLACES = ("CHANGELOG.md", "doc/*.md", "doc/*/README.md", "prm/*/README.md",
          "tests/performance/**/*.md")

CONTENTS = "doc/README.md"


def find_pages(top):
    """Names of all pages, relative to the folder top."""
    found = {path.relative_to(top).as_posix()
             for place in PLACES for path in top.glob(place)}
    if (top / "README.md").exists():
        found.add("README.md")
    return sorted(found)


def run(command, text, folder=None):
    """Output of a program that reads the text; fails with what it says."""
    result = subprocess.run(command, input=text, capture_output=True,
                            text=True, cwd=folder)
    # pandoc reports formulas that it cannot convert as warnings
    if result.returncode != 0 or result.stderr.strip():
        message = " ".join(result.stderr.split()) or "no message"
        raise RuntimeError(f"{command[0]}: {message}")
    return result.stdout


def walk(node):
    """All elements {"t": ..., "c": ...} in a tree, outer ones first."""
    if isinstance(node, dict):
        if "t" in node:
            yield node
        for value in node.values():
            yield from walk(value)
    elif isinstance(node, list):
        for value in node:
            yield from walk(value)


def transform(node, change):
    """
    The tree with each element replaced by change(element), a list of elements
    or None to go on inside it.
    """
    if isinstance(node, dict):
        return {key: transform(value, change) for key, value in node.items()}
    if not isinstance(node, list):
        return node
    result = []
    for item in node:
        new = change(item) if isinstance(item, dict) and "t" in item else None
        if new is None:
            result.append(transform(item, change))
        else:
            result.extend(new)
    return result


def plain(node):
    """The text of inline elements; code included, formulas left out."""
    words = {"Space": " ", "SoftBreak": " ", "LineBreak": " "}
    text = []
    for element in walk(node):
        if element["t"] == "Str":
            text.append(element["c"])
        elif element["t"] == "Code":
            text.append(element["c"][1])
        else:
            text.append(words.get(element["t"], ""))
    return "".join(text)


def codes(node):
    return [element["c"][1] for element in walk(node)
            if element["t"] == "Code"]


class Page:
    """A file in Markdown, and what is in it."""

    def __init__(self, top, name):
        self.name = name
        self.folder = posixpath.dirname(name)
        text = (top / name).read_text(encoding="utf-8")
        self.tree = json.loads(run(["pandoc", "-f", READER, "-t", "json"],
                                   text, top))
        self.blocks = self.tree["blocks"]
        elements = list(walk(self.blocks))

        headers = [e["c"] for e in elements if e["t"] == "Header"]
        self.title = plain(headers[0][2]) if headers else name
        self.anchors = {header[1][0] for header in headers}
        self.links = [e["c"][2][0] for e in elements if e["t"] == "Link"]
        self.images = [e["c"][2][0] for e in elements if e["t"] == "Image"]
        for element in elements:
            if element["t"] in ("RawInline", "RawBlock"):
                html = element["c"][1]
                self.anchors.update(re.findall(r'\b(?:id|name)="([^"]+)"',
                                               html))
                self.links += re.findall(r'\bhref="([^"]+)"', html)
                self.images += re.findall(r'\bsrc="([^"]+)"', html)

    def target(self, link):
        """
        The file, relative to the top, and the anchor of a link inside the
        project; None for addresses in the network.
        """
        if re.match(r"[a-z][a-z0-9+.-]*:", link):
            return None
        path, _, anchor = link.partition("#")
        if not path:
            return self.name, anchor
        return posixpath.normpath(posixpath.join(self.folder, path)), anchor

    def tables(self):
        """
        The tables: the paragraph before each, the texts of the cells of its
        head, and the cells of its rows.
        """
        before = None
        for block in self.blocks:
            if block["t"] == "Table":
                head, bodies = block["c"][3], block["c"][4]
                names = [plain(cell[4]) for row in head[1] for cell in row[1]]
                rows = [[cell[4] for cell in row[1]]
                        for body in bodies for row in body[3]]
                yield before, names, rows
            before = block


def relative(target, folder):
    return posixpath.relpath(target, folder or ".")
