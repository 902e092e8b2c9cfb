# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Doxygen of the headers, and what it knows of them."""

import html
import json
import os
import re
import subprocess
import xml.etree.ElementTree as ElementTree

from . import pages

DOXYFILE = "doc/Doxyfile"

# Formulas in pages of Doxygen, as it hands them over to a program in browsers
FORMULA = re.compile(r"\\\((.+?)\\\)|\\\[(.+?)\\\]", re.S)

# References of doc comments to formulas of the manual
REFERENCE = re.compile(r"\b[Tt]heory[\s*]+\((\d+\.\d+)\)")


class Api:
    """Classes and functions of the headers."""

    def __init__(self):
        # name without namespace -> page and anchor; -> header
        self.places = {}
        self.headers = {}

    def add(self, name, place, header):
        name = name.removeprefix("ACF::")
        self.places.setdefault(name, place)
        self.headers.setdefault(name, set()).add(header)

    def find(self, code):
        """The name of a class or function as code in the text, or None."""
        name = re.sub(r"\(\)$", "", code).removeprefix("ACF::")
        return name if name in self.places else None


def run_doxygen(top, folder):
    """
    Writes the pages into folder/api.
    @return what the headers contain, and problems
    """
    tags, warnings = folder / "tags", folder / "warnings"
    settings = (top / DOXYFILE).read_text() + "\n" + "\n".join([
        f'OUTPUT_DIRECTORY = "{folder}"', "HTML_OUTPUT = api",
        f'GENERATE_TAGFILE = "{tags}"', f'WARN_LOGFILE = "{warnings}"', ""])
    pages.run(["doxygen", "-"], settings, top)
    problems = [f"doxygen: {line.removeprefix(str(top) + os.sep)}"
                for line in warnings.read_text().splitlines() if line.strip()]
    api = read_tags(tags, top / "include")
    tags.unlink()
    warnings.unlink()
    return api, problems


def read_tags(file, include):
    api, in_header = Api(), {}
    compounds = ElementTree.parse(file).getroot().findall("compound")
    for compound in compounds:
        if compound.get("kind") != "file":
            continue
        path = os.path.join(compound.findtext("path", ""),
                            compound.findtext("name"))
        header = os.path.relpath(path, include)
        for name in compound.findall("class"):
            in_header[name.text] = header
        for member in compound.findall("member"):
            api.add(member.findtext("name"), place(member), header)
    for compound in compounds:
        name = compound.findtext("name")
        if compound.get("kind") in ("class", "struct") and name in in_header:
            header = in_header[name]
            api.add(name, compound.findtext("filename"), header)
            for member in compound.findall("member"):
                api.add(f"{name}::{member.findtext('name')}", place(member),
                        header)
    return api


def place(member):
    return f"{member.findtext('anchorfile')}#{member.findtext('anchor')}"


def convert_formulas(folder):
    """
    Turns the formulas in pages of Doxygen into MathML, and takes out the
    program that would be loaded for them.
    @return problems
    """
    texts = {file: file.read_text() for file in sorted(folder.glob("*.html"))}
    formulas = {}
    for text in texts.values():
        for inline, display in FORMULA.findall(text):
            formulas[inline, display] = ""
    try:
        for key, result in zip(formulas, mathml(formulas)):
            formulas[key] = result
    except RuntimeError as error:
        return [f"doc comments: {error}"]
    for file, text in texts.items():
        text = FORMULA.sub(lambda match: formulas[match.groups("")], text)
        text = re.sub(r"<script[^>]*>(?:(?!</script>).)*?MathJax.*?</script>\n?"
                      r"|<script[^>]*MathJax[^>]*></script>\n?",
                      "", text, flags=re.S)
        text = REFERENCE.sub(
            r'<a href="../doc/theory.html#eq-\1">\g<0></a>', text)
        file.write_text(text)
    return []


def mathml(formulas):
    """Pairs (inline, display) of formulas in MathML."""
    def math(inline, display):
        kind = "InlineMath" if inline else "DisplayMath"
        return {"t": "Math", "c": [{"t": kind},
                                   html.unescape(inline or display)]}

    tree = {"pandoc-api-version": [1, 22], "meta": {},
            "blocks": [{"t": "Div", "c": [["", ["formula"], []], [
                {"t": "Plain", "c": [math(*formula)]}]]}
                       for formula in formulas]}
    text = pages.run(["pandoc", "-f", "json", "-t", "html", "--mathml"],
                     json.dumps(tree))
    return re.findall(r'<div class="formula">\s*(.*?)\s*</div>', text, re.S)
