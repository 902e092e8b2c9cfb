# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""A display for VTK, which Debian builds for X."""

import atexit
import ctypes
import functools
import os
import shutil
import subprocess

from acf_tools.command_line import RunError


@functools.cache
def open_display():
    """Starts an X server without a screen (Xvfb), which ends with this process.

    Without Xvfb the display that the variable DISPLAY names is used. Does nothing
    when it is called again.
    """
    if shutil.which("Xvfb"):
        reading, writing = os.pipe()
        server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(writing), "-screen", "0", "640x480x24", "-nolisten", "tcp"],
            pass_fds=[writing], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        os.close(writing)
        atexit.register(end, server)
        with os.fdopen(reading) as stream:
            display = stream.readline().strip()
        if not display:
            raise RunError("Xvfb does not start, without which no picture can be drawn")
        os.environ["DISPLAY"] = ":" + display
    elif not is_reachable():
        # VTK would abort the process
        raise RunError("no picture can be drawn: there is neither Xvfb (Debian's package xvfb) "
                       "nor a display")


def is_reachable():
    try:
        x11 = ctypes.CDLL("libX11.so.6")
    except OSError:
        return False
    x11.XOpenDisplay.restype = ctypes.c_void_p
    x11.XCloseDisplay.argtypes = [ctypes.c_void_p]
    display = x11.XOpenDisplay(None)
    if display:
        x11.XCloseDisplay(display)
    return bool(display)


def end(server):
    server.terminate()
    server.wait()
