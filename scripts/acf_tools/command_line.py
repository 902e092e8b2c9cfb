# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Options and errors: an error is one line on standard error, as of acf-dealii."""

import argparse
import pathlib
import sys


class InputError(Exception):
    """Wrong input: exit status 2."""


class RunError(Exception):
    """The input is right, but the work failed: exit status 1."""


def program_name():
    return pathlib.Path(sys.argv[0]).name


def report(text):
    """Writes an error or a warning on standard error."""
    print(f"{program_name()}: {text}", file=sys.stderr)


class ArgumentParser(argparse.ArgumentParser):
    """argparse's, with errors of one line and without abbreviated options.

    Values may begin with a minus: --view -x.
    """

    def __init__(self, **keywords):
        super().__init__(allow_abbrev=False, **keywords)

    def parse_args(self, arguments=None):
        joined = []
        for argument in sys.argv[1:] if arguments is None else arguments:
            action = self._option_string_actions.get(joined[-1]) if joined else None
            if action and action.nargs is None and joined[-1].startswith("--") \
                    and argument[:1] == "-" != argument[1:2]:
                joined[-1] += "=" + argument
            else:
                joined.append(argument)
        return super().parse_args(joined)

    def error(self, message):
        report(message)
        sys.exit(2)


def run(main):
    """Calls main, whose result is the exit status, and reports errors."""
    try:
        status = main()
    except InputError as error:
        report(error)
        status = 2
    except (RunError, OSError) as error:
        report(error)
        status = 1
    except ModuleNotFoundError as error:
        report(f"Python has no module '{error.name}'; Debian's packages python3-vtk9 and "
               "python3-matplotlib are needed")
        status = 1
    except KeyboardInterrupt:
        status = 130
    sys.exit(status)


def number(text, what):
    """The number in a text; what says whose, for the message."""
    try:
        value = float(text)
        if abs(value) < float("inf"):
            return value
    except ValueError:
        pass
    raise InputError(f"{what}: found '{text}'; allowed: a number")


def numbers(text, count, what):
    """The numbers of a list that is separated by commas."""
    items = text.split(",")
    if len(items) != count:
        raise InputError(f"{what}: found '{text}'; allowed: {count} numbers, separated by commas")
    return [number(item.strip(), what) for item in items]
