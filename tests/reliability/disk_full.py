#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
"""Lets the disk run full at different points of a run.

In a mount namespace of its own where the system allows it: file systems in memory that are
smaller and smaller than the results. Elsewhere, and always in addition, with limits of the size
of files. What was written before must be there, complete, and the message must say what happened.
"""

import os
import resource
import subprocess
import sys

from common import (MODEL_FILE, MODELS, Checks, Folder, arguments, check_fields, entries, lines, run,
                    statistics)

FORMATS = {"VTU": MODELS["fixed steps"], "XDMF": MODELS["XDMF"]}


def without_checkpoints(settings):
    """The disk is full when files of fields, their list or the probes are written."""
    return [setting.replace("Checkpoint interval=0.005", "Checkpoint interval=0")
            for setting in settings]


def check_results(check, what, directory, reference):
    """Everything that has a final name is complete."""
    found = lines(directory / "probes.csv")
    check(found == lines(reference / "probes.csv")[:len(found)],
          f"{what}: probes.csv is something else")
    text = (directory / "probes.csv").read_bytes() if found else b"\n"
    check(text.endswith(b"\n"), f"{what}: probes.csv ends within a line")
    listed = check_fields(check, what, directory, reference)
    check(listed == entries(reference)[:len(listed)], f"{what}: something else is listed")
    check(not list(directory.glob("*.tmp")), f"{what}: temporary files are left")
    if (directory / "statistics.json").exists():
        statistics(directory)
    return len(found), len(listed)


def attack(program, settings, what, directory, reference, reason, check, limit=None):
    """Runs into the obstacle, and goes on elsewhere if there is a checkpoint."""
    preexec = None
    if limit is not None:
        def preexec():
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    done = subprocess.run(
        [program, *settings, "--output-directory", directory, MODEL_FILE],
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False,
        preexec_fn=preexec)
    check(done.returncode == 1, f"{what}: exit status {done.returncode}: {done.stderr}")
    check(done.stderr.count("\n") == 1 and reason in done.stderr,
          f"{what}: message: {done.stderr}")
    n_rows, n_times = check_results(check, what, directory, reference)
    restarted = "-"
    checkpoint = directory / "checkpoint.h5"
    if checkpoint.exists():
        with Folder() as other:
            status, messages = run(program, settings, other / "rest", "--restart", checkpoint)
            check(status == 0, f"{what}: restart: {messages}")
            rest = lines(other / "rest" / "probes.csv")
            whole = lines(reference / "probes.csv")
            check(rest[1:] == whole[len(whole) - len(rest) + 1:] and
                  len(rest) + n_rows >= len(whole),
                  f"{what}: rows are missing after the restart")
            listed = check_fields(check, f"{what}: restart", other / "rest", reference)
            check(listed == entries(reference)[len(entries(reference)) - len(listed):] and
                  len(listed) + n_times >= len(entries(reference)),
                  f"{what}: fields are missing after the restart")
            restarted = len(rest) - 1
    print(f"{what}: {n_rows} rows and fields of {n_times} times kept, "
          f"rows after a restart elsewhere: {restarted}; {done.stderr.strip()}")


def mount(disk, options):
    """A file system in memory."""
    disk.mkdir()
    return subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", disk],
                          stderr=subprocess.DEVNULL, check=False).returncode == 0


def attack_read_only(program, disk, check):
    """Nothing can be written from the beginning: that is said before anything is computed."""
    if not mount(disk, "ro"):
        return
    status, messages = run(program, FORMATS["VTU"], disk / "results")
    check(status == 1 and messages.count("\n") == 1 and "Read-only file system" in messages,
          f"read-only: exit status {status}: {messages}")
    print(f"read-only file system: {messages.strip()}")
    subprocess.run(["umount", disk], check=True)


def in_namespace():
    """Starts this program again where it may mount file systems; false if that is forbidden."""
    if os.environ.get("ACF_IN_NAMESPACE"):
        return True
    command = ["unshare", "--mount"] + ([] if os.getuid() == 0 else ["--user", "--map-root-user"])
    try:
        if subprocess.run([*command, "true"], stderr=subprocess.DEVNULL, check=False).returncode:
            return False
    except FileNotFoundError:
        return False
    os.environ["ACF_IN_NAMESPACE"] = "1"
    os.execvp(command[0], [*command, sys.executable, *sys.argv])
    return False


def attack_format(program, form, number, may_mount, check):
    """Full disks and limits of the size of files, for one format of the fields."""
    settings = FORMATS[form]
    with Folder() as top:
        reference = top / "whole"
        status, messages = run(program, settings, reference)
        check(status == 0, messages)
        sizes = {file.name: file.stat().st_size for file in reference.iterdir()}
        total = sum(sizes.values())
        results = sum(size for name, size in sizes.items() if not name.startswith("checkpoint"))
        for k in range(number if may_mount else 0):
            disk = top / f"disk-{k}"
            n_bytes = int((total if k % 2 == 0 else results) * (k + 0.5) / number)
            if not mount(disk, f"size={n_bytes}"):
                print("File systems cannot be mounted here.")
                break
            attack(program, settings if k % 2 == 0 else without_checkpoints(settings),
                   f"{form}, disk of {n_bytes} bytes", disk / "results", reference,
                   "No space left on device", check)
            subprocess.run(["umount", disk], check=True)
        n_limits = max(2, number // 4)
        for k in range(n_limits):
            limit = int(max(sizes.values()) * (k + 0.5) / n_limits)
            attack(program, settings, f"{form}, files of at most {limit} bytes",
                   top / f"limit-{k}", reference, "File too large", check, limit)


def main():
    options = arguments(__doc__.splitlines()[0], 20,
                        "points at which the disk runs full, for each format")
    may_mount = in_namespace()
    check = Checks()
    for form in FORMATS:
        attack_format(options.program, form, options.number, may_mount, check)
    with Folder() as top:
        if may_mount:
            attack_read_only(options.program, top / "read-only", check)
    check.finish()


if __name__ == "__main__":
    main()
