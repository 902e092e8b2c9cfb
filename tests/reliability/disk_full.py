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
import xml.etree.ElementTree

from common import MODEL_FILE, MODELS, Checks, Folder, arguments, lines, run, statistics

SETTINGS = MODELS["fixed steps"]

# The disk is full when the VTU files or the probes are written.
NO_CHECKPOINTS = [setting.replace("Checkpoint interval=0.005", "Checkpoint interval=0")
                  for setting in SETTINGS]


def check_results(check, what, directory, reference):
    """Everything that has a final name is complete."""
    found = lines(directory / "probes.csv")
    check(found == lines(reference / "probes.csv")[:len(found)],
          f"{what}: probes.csv is something else")
    text = (directory / "probes.csv").read_bytes() if found else b"\n"
    check(text.endswith(b"\n"), f"{what}: probes.csv ends within a line")
    listed = []
    if (directory / "solution.pvd").exists():
        tree = xml.etree.ElementTree.parse(directory / "solution.pvd")
        listed = [entry.get("file") for entry in tree.iter("DataSet")]
    for name in listed:
        check((directory / name).exists(), f"{what}: {name} is listed, but not there")
    for file in directory.glob("*.vtu"):
        check(file.read_bytes() == (reference / file.name).read_bytes(),
              f"{what}: {file.name} is something else")
    check(not list(directory.glob("*.tmp")), f"{what}: temporary files are left")
    if (directory / "statistics.json").exists():
        statistics(directory)
    return len(found), len(listed)


def attack(program, what, directory, reference, reason, check, limit=None, settings=None):
    """Runs into the obstacle, and goes on elsewhere if there is a checkpoint."""
    preexec = None
    if limit is not None:
        def preexec():
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    done = subprocess.run(
        [program, *(settings or SETTINGS), "--output-directory", directory, MODEL_FILE],
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False,
        preexec_fn=preexec)
    check(done.returncode == 1, f"{what}: exit status {done.returncode}: {done.stderr}")
    check(done.stderr.count("\n") == 1 and reason in done.stderr,
          f"{what}: message: {done.stderr}")
    n_rows, n_files = check_results(check, what, directory, reference)
    restarted = "-"
    checkpoint = directory / "checkpoint.h5"
    if checkpoint.exists():
        with Folder() as other:
            status, messages = run(program, SETTINGS, other / "rest", "--restart", checkpoint)
            check(status == 0, f"{what}: restart: {messages}")
            rest = lines(other / "rest" / "probes.csv")
            whole = lines(reference / "probes.csv")
            check(rest[1:] == whole[len(whole) - len(rest) + 1:] and
                  len(rest) + n_rows >= len(whole),
                  f"{what}: rows are missing after the restart")
            restarted = len(rest) - 1
    print(f"{what}: {n_rows} rows and {n_files} VTU files kept, "
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
    status, messages = run(program, SETTINGS, disk / "results")
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


def main():
    options = arguments(__doc__.splitlines()[0], 20, "points at which the disk runs full")
    may_mount = in_namespace()
    check = Checks()
    with Folder() as top:
        reference = top / "whole"
        status, messages = run(options.program, SETTINGS, reference)
        check(status == 0, messages)
        sizes = {file.name: file.stat().st_size for file in reference.iterdir()}
        total = sum(sizes.values())
        results = sum(size for name, size in sizes.items() if not name.endswith(".h5"))
        n_points = options.number if may_mount else 0
        for k in range(n_points):
            disk = top / f"disk-{k}"
            settings = SETTINGS if k % 2 == 0 else NO_CHECKPOINTS
            n_bytes = int((total if k % 2 == 0 else results) * (k + 0.5) / n_points)
            if not mount(disk, f"size={n_bytes}"):
                print("File systems cannot be mounted here.")
                break
            attack(options.program, f"disk of {n_bytes} bytes", disk / "results", reference,
                   "No space left on device", check, settings=settings)
            subprocess.run(["umount", disk], check=True)
        if may_mount:
            attack_read_only(options.program, top / "read-only", check)
        for k in range(max(2, options.number // 4)):
            limit = int(max(sizes.values()) * (k + 0.5) / max(2, options.number // 4))
            attack(options.program, f"files of at most {limit} bytes", top / f"limit-{k}",
                   reference, "File too large", check, limit)
    check.finish()


if __name__ == "__main__":
    main()
