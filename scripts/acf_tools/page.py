# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""A page of HTML that needs no other file; it is well-formed XML, too."""

import base64
import html
import re

STYLE = """
body { font: 15px/1.45 sans-serif; color: #222; max-width: 62rem; margin: 1.5rem auto; padding: 0 1rem }
h1 { font-size: 1.6rem } h2 { font-size: 1.25rem; margin-top: 2rem; border-bottom: 1px solid #ccc }
h3 { font-size: 1.05rem; margin-bottom: .3rem }
table { border-collapse: collapse; margin: .6rem 0 } th { text-align: left; background: #f3f3f3 }
th, td { border: 1px solid #ddd; padding: .15rem .55rem; vertical-align: top }
td.number { text-align: right; font-variant-numeric: tabular-nums }
td.beyond { background: #ffd9d4; font-weight: bold }
figure { margin: .6rem 0 } figure img { max-width: 100% } figcaption { color: #555; font-size: .9rem }
.pictures { display: flex; flex-wrap: wrap; gap: .6rem } .pictures figure { width: 30rem; margin: 0 }
.warnings li { background: #fff3cd; margin: .25rem 0; padding: .15rem .4rem }
.bar { background: #4e79a7; height: .8rem; min-width: 1px } td.bars { width: 16rem }
pre { background: #f7f7f7; padding: .6rem; overflow-x: auto; font-size: .85rem }
"""


def escape(text):
    """Text for HTML, without the control characters that XML does not allow."""
    return html.escape(re.sub(r"[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff]", "\ufffd", str(text)))


def number(value):
    """A number, or another value of JSON, for people."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.6g}"
    return str(value)


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def cell(value):
    """A cell of a table; a pair is a value and the class of the cell."""
    kind = ""
    if isinstance(value, tuple):
        value, kind = value
    kinds = " ".join(filter(None, [kind, "number" if is_number(value) else ""]))
    return f"<td class=\"{kinds}\">{escape(number(value))}</td>" if kinds else \
        f"<td>{escape(number(value))}</td>"


class Page:
    def __init__(self, title):
        self.title = title
        self.parts = []

    def heading(self, text, level=2):
        self.parts.append(f"<h{level}>{escape(text)}</h{level}>")

    def paragraph(self, text):
        self.parts.append(f"<p>{escape(text)}</p>")

    def items(self, texts, kind):
        self.parts.append(f"<ul class=\"{kind}\">"
                          + "".join(f"<li>{escape(text)}</li>" for text in texts) + "</ul>")

    def table(self, header, rows):
        head = "".join(f"<th>{escape(name)}</th>" for name in header)
        head = f"<tr>{head}</tr>\n" if header else ""
        self.parts.append(f"<table>\n{head}" + "\n".join(
            "<tr>" + "".join(map(cell, row)) + "</tr>" for row in rows) + "\n</table>")

    def bars(self, header, rows):
        """A table of names and values, with a bar for each value."""
        largest = max(value for _, value in rows) or 1
        lines = [f"<tr>{cell(name)}{cell(value)}<td class=\"bars\"><div class=\"bar\" "
                 f"style=\"width: {100 * value / largest:.1f}%\"></div></td></tr>"
                 for name, value in rows]
        head = "".join(f"<th>{escape(name)}</th>" for name in (*header, ""))
        self.parts.append(f"<table>\n<tr>{head}</tr>\n" + "\n".join(lines) + "\n</table>")

    @staticmethod
    def image(content, kind, text):
        """A picture, content as bytes, with a text below it."""
        data = base64.b64encode(content).decode()
        return (f"<figure><img src=\"data:image/{kind};base64,{data}\" alt=\"{escape(text)}\"/>"
                f"<figcaption>{escape(text)}</figcaption></figure>")

    def drawing(self, svg, text):
        self.parts.append(self.image(svg.encode(), "svg+xml", text))

    def pictures(self, contents_and_texts):
        self.parts.append("<div class=\"pictures\">" + "\n".join(
            self.image(content, "png", text) for content, text in contents_and_texts) + "</div>")

    def folded(self, title, text):
        self.parts.append(f"<details><summary>{escape(title)}</summary>"
                          f"<pre>{escape(text)}</pre></details>")

    def text(self):
        body = "\n".join(self.parts)
        return ("<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>"
                f"<meta charset=\"utf-8\"/><title>{escape(self.title)}</title>\n"
                f"<style>{STYLE}</style></head>\n<body>\n<h1>{escape(self.title)}</h1>\n{body}\n"
                "</body>\n</html>\n")
