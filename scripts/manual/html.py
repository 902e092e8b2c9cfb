# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""HTML of the pages."""

import html
import json
import posixpath
import re
import shutil
import urllib.parse

from . import checks, pages

STYLE = """
body { font: 16px/1.5 sans-serif; max-width: 60em; margin: 0 auto;
  padding: 0 1em 4em; color: #222; }
nav { border-bottom: 1px solid #bbb; padding: 0.7em 0; }
nav a { margin-right: 1.5em; }
a { color: #0645ad; text-decoration: none; }
a:hover { text-decoration: underline; }
pre { background: #f5f5f5; padding: 0.7em; overflow-x: auto; }
code { background: #f5f5f5; font-size: 0.92em; }
table { border-collapse: collapse; display: block; overflow-x: auto; }
th, td { border: 1px solid #ccc; padding: 0.2em 0.6em; vertical-align: top; }
img { max-width: 100%; }
.equation { display: flex; align-items: center; overflow-x: auto; }
.equation > :first-child { flex: 1; }
.equation:target { background: #ffc; }
"""

# Made of what the program prints, beside the page of the model file
REFERENCE = "doc/parameters.md"


def name_of(page):
    """The file of a page: index.html for the contents of the manual."""
    return posixpath.splitext(page)[0] + ".html"


def text_element(text):
    return {"t": "Str", "c": text}


def link_element(target, content):
    return {"t": "Link", "c": [["", [], []], content, [target, ""]]}


class Writer:
    """Writes pages into a folder, with the files that they link to."""

    def __init__(self, top, folder, all_pages, api):
        self.top = top
        self.folder = folder
        self.pages = all_pages
        self.api = api

    def write(self, page):
        theory = page.name == checks.THEORY
        tree = dict(page.tree)
        tree["blocks"] = pages.transform(
            page.blocks, lambda element: self.change(element, page, theory))
        body = pages.run(["pandoc", "-f", "json", "-t", "html", "--mathml",
                          "--wrap=none"], json.dumps(tree))
        self.write_html(page.name, page.title, body)

    def write_reference(self, text):
        body = pages.run(["pandoc", "-f", pages.READER, "-t", "html",
                          "--wrap=none"],
                         text.replace("(model-file.md)", "(model-file.html)"))
        self.write_html(REFERENCE, "All entries", body)

    def write_html(self, name, title, body):
        file = self.folder / name_of(name)
        file.parent.mkdir(parents=True, exist_ok=True)
        up = posixpath.dirname(name)
        menu = "".join(
            f'<a href="{pages.relative(target, up)}">{text}</a>\n'
            for target, text in ((name_of(pages.CONTENTS), "Manual"),
                                 (name_of(REFERENCE), "All entries"),
                                 ("api/index.html", "Library")))
        file.write_text(
            '<!DOCTYPE html>\n<html lang="en">\n<head>\n'
            '<meta charset="utf-8">\n'
            '<meta name="viewport" content="width=device-width">\n'
            f"<title>{html.escape(title)}</title>\n"
            f"<style>{STYLE}</style>\n</head>\n<body>\n<nav>\n{menu}</nav>\n"
            f"{body}</body>\n</html>\n", encoding="utf-8")

    def change(self, element, page, theory):
        """What stands for an element in HTML; None: the same."""
        kind = element["t"]
        if kind in ("Link", "Image"):
            attributes, content, (target, title) = element["c"]
            # no links inside links
            inside = content if kind == "Link" else pages.transform(
                content, lambda e: self.change(e, page, theory))
            return [{"t": kind, "c": [attributes, inside, [
                self.address(target, page), title]]}]
        if kind == "Code":
            symbol = self.api.find(element["c"][1])
            if symbol and re.search(r"\(\)$|[a-z][A-Z]", element["c"][1]):
                target = pages.relative(f"api/{self.api.places[symbol]}",
                                        page.folder)
                return [link_element(target, [element])]
        if kind == "Math" and theory:
            return self.numbered(element)
        if kind == "Str" and theory:
            return self.with_references(element["c"])
        if kind in ("RawInline", "RawBlock"):
            text = re.sub(
                r'\b(href|src)="([^"]+)"',
                lambda m: f'{m[1]}="{self.address(m[2], page)}"',
                element["c"][1])
            return [{"t": kind, "c": [element["c"][0], text]}]
        return None

    def address(self, link, page):
        """A link in HTML; copies files that are not pages."""
        place = page.target(urllib.parse.unquote(link))
        if place is None:
            return link
        file, anchor = place
        if (self.top / file).is_dir():
            file = posixpath.join(file, "README.md")
        if file in self.pages:
            target = name_of(file)
        else:
            target = file
            if (self.top / file).is_file():
                copy = self.folder / file
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(self.top / file, copy)
        if target == name_of(page.name) and anchor:
            return f"#{anchor}"
        target = urllib.parse.quote(pages.relative(target, page.folder))
        return f"{target}#{anchor}" if anchor else target

    @staticmethod
    def numbered(element):
        """A formula with its number beside it."""
        numbers = checks.NUMBER.findall(element["c"][1])
        if not numbers:
            return None
        formula = checks.NUMBER.sub("", element["c"][1]).strip()
        return [{"t": "Span", "c": [
            [f"eq-{numbers[0]}", ["equation"], []],
            [{"t": "Math", "c": [element["c"][0], formula]},
             {"t": "Span", "c": [["", [], []],
                                 [text_element(f"({numbers[0]})")]]}]]}]

    @staticmethod
    def with_references(text):
        """Numbers of formulas in a word become links."""
        result, end = [], 0
        for match in checks.IN_PARENTHESES.finditer(text):
            if match.start() > end:
                result.append(text_element(text[end:match.start()]))
            result.append(link_element(f"#eq-{match[1]}",
                                       [text_element(match[0])]))
            end = match.end()
        if not result:
            return None
        return result + ([text_element(text[end:])] if text[end:] else [])
