#!/usr/bin/env python3
"""A run that is ended from outside leaves no namespace, folder or process behind.

Usage: field_cleanup_test.py LEDGER_NODE"""

import pathlib
import signal
import subprocess
import sys
import time

import field

HERE = pathlib.Path(__file__).resolve().parent
NODES = 2


def left_of(pid):
    mark = f"{field.PREFIX}-{pid}-"
    return [name for name in field.namespaces() + field.folders() if mark in name]


def nodes_of(pid):
    """Processes whose command line names the run's folder, as the nodes' does."""
    mark = f"{field.PREFIX}-{pid}-".encode()
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and mark in (entry / "cmdline").read_bytes():
                found.append(int(entry.name))
        except OSError:
            pass  # ended meanwhile
    return found


def wait_until(holds, what):
    end = time.monotonic() + 60
    while not holds():
        if time.monotonic() > end:
            raise AssertionError("not within a minute: " + what)
        time.sleep(0.1)


def end_with(number, program):
    run = subprocess.Popen([sys.executable, HERE / "run_scenario.py", "--ledger-node", program,
                            HERE / "scenarios/expiry"], stdout=subprocess.DEVNULL)
    try:
        wait_until(lambda: len(nodes_of(run.pid)) == NODES, "the nodes run")
        assert len(left_of(run.pid)) == NODES + 2, left_of(run.pid)
        run.send_signal(number)
        run.wait(60)
    finally:
        if run.poll() is None:
            run.kill()
            run.wait()
    wait_until(lambda: not nodes_of(run.pid), "the nodes end")
    if number == signal.SIGKILL:
        field.sweep()
    assert not left_of(run.pid), f"left behind after {number.name}: {left_of(run.pid)}"


def main():
    try:
        with field.Field(["probe"]):
            pass
    except field.Unsupported as reason:
        print(f"skipped: {reason}")
        sys.exit(77)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
        end_with(number, sys.argv[1])


if __name__ == "__main__":
    main()
