# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Entries of model files: what the program has, and what the manual says."""

import re

from . import pages

MODEL_FILE = "doc/model-file.md"


class Entry:
    """An entry of a section such as "Bodies/NAME"."""

    def __init__(self, section, name, default, meaning):
        self.section = section
        self.name = name
        self.default = default
        self.meaning = meaning

    def path(self):
        return f"{self.section}/{self.name}" if self.section else self.name


def read_entries(text):
    """
    The entries in what the program prints with --print-parameters. A
    subsection of a section is one for an object with any name.
    """
    entries, sections, comment = [], [], []
    for line in text.splitlines():
        line = line.strip()
        if line.startswith("#"):
            # an underlined line is a title
            underline = not line.strip("#- ")
            comment = [] if underline else comment + [line[1:].strip()]
            continue
        if line.startswith("subsection "):
            sections.append("NAME" if sections else line[11:])
        elif line == "end":
            sections.pop()
        elif line.startswith("set "):
            name, _, rest = line[4:].partition("=")
            entries.append(Entry("/".join(sections), name.strip(),
                                 rest.strip(), " ".join(comment)))
        comment = []
    return entries


def documented_entries(page):
    """
    Paths of the entries that the reference names: the code in the first
    columns of tables with the heads "entry", "default", below a paragraph
    that begins with the name of the section in bold, and the code in that
    paragraph.
    """
    found = []

    def add(section, names):
        found.extend(f"{section}/{name}" if section else name
                     for name in names)

    for block in page.blocks:
        if block["t"] == "Para" and block["c"][0]["t"] == "Strong":
            section = ""
            for inline in block["c"]:
                if inline["t"] == "Strong":
                    section = "".join(pages.codes(inline))
                elif inline["t"] == "Code":
                    add(section, [inline["c"][1]])
    for before, head, rows in page.tables():
        if head[:2] != ["entry", "default"]:
            continue
        strong = [e for e in pages.walk(before) if e["t"] == "Strong"]
        section = "".join(pages.codes(strong[-1])) if strong else ""
        for row in rows:
            add(section, pages.codes(row[0]))
    return found


def check_entries(entries, all_pages):
    """Problems: entries without documentation, and names without entry."""
    page = all_pages[MODEL_FILE]
    exist = {entry.path() for entry in entries}
    documented = set(documented_entries(page))
    problems = [f"{MODEL_FILE}: the entry '{path}' of the program is not in "
                "the tables of entries"
                for path in sorted(exist - documented)]
    problems += [f"{MODEL_FILE}: the tables of entries name '{path}', which "
                 "the program does not have"
                 for path in sorted(documented - exist)]
    problems += [f"the entry '{entry.path()}' has no documentation in the "
                 "program" for entry in entries if not entry.meaning]

    names = {entry.name for entry in entries}
    top = {entry.section.split("/")[0] for entry in entries if entry.section}
    for name, page in all_pages.items():
        # what a changelog tells of may have had another name
        if name == "CHANGELOG.md":
            continue
        for element in pages.walk(page.blocks):
            if element["t"] == "CodeBlock":
                problems += [
                    f"{name}: an example sets '{found}', which no section has"
                    for found in re.findall(r"^\s*set ([^=\n]+?)\s*=",
                                            element["c"][1], re.M)
                    if found not in names]
                words = re.findall(r"--(?:set|vary)[ =]'([^'=]+)=", element["c"][1])
            elif element["t"] == "Code":
                code = element["c"][1]
                words = re.findall(r"--(?:set|vary)[ =]'?([^'=]+)=", code)
                if re.fullmatch(r"[A-Z][\w' -]*(/[\w' +-]+)+(=.*)?", code):
                    words.append(code.split("=")[0].strip())
            else:
                continue
            problems += [f"{name}: names the entry '{word}', which the "
                         "program does not have"
                         for word in words
                         if word.split("/")[0] in top and
                         not is_entry(word, exist)]
    return problems


def is_entry(word, exist):
    """Whether a path, with names of objects, is one of an entry or section."""
    parts = word.split("/")
    general = "/".join([parts[0], "NAME"] + parts[2:])
    return (word in exist or general in exist or
            any(path.startswith(f"{general}/") for path in exist))


def check_options(help_text, page):
    """Problems: options without documentation, and names without option."""
    exist = set(re.findall(r"^  (--[a-z-]+)", help_text, re.M))
    documented = {code.split()[0] for _, head, rows in page.tables()
                  if head[:1] == ["option"]
                  for row in rows for code in pages.codes(row[0])} - {"--"}
    return [f"{page.name}: the option '{option}' of the program is not in the "
            "table of options" for option in sorted(exist - documented)] + [
        f"{page.name}: the table of options names '{option}', which the "
        "program does not have" for option in sorted(documented - exist)]


def reference(entries):
    """The reference of all entries, in Markdown."""
    text = ["# All entries", "",
            "Generated from `acf-dealii --print-parameters`; "
            "[The model file](model-file.md) explains them. NAME stands for "
            "the name of a body, joint ...", ""]
    section = None

    def cell(value):
        return value.replace("|", "\\|").replace("<", "&lt;")

    for entry in entries:
        if section != entry.section:
            section = entry.section
            text += ["", f"## {section or 'Top level'}", "",
                         "| entry | default | unit | meaning |",
                     "|---|---|---|---|"]
        default = f"`{cell(entry.default)}`" if entry.default else ""
        meaning, _, unit = entry.meaning.partition(" Units: ")
        unit = "" if unit == "none." else unit.rstrip(".")
        text.append(f"| `{entry.name}` | {default} | {cell(unit)} | "
                    f"{cell(meaning)} |")
    return "\n".join(text) + "\n"
