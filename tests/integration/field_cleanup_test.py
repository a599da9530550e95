#!/usr/bin/env python3
"""A run that is ended from outside leaves no namespace, folder or process behind, and a mistake skips no test.

Usage: field_cleanup_test.py LEDGER_NODE"""

import pathlib
import signal
import subprocess
import sys
import time

import field
import radio_field

HERE = pathlib.Path(__file__).resolve().parent
# Scenario -> the number of its processes, with the radio if there is one; and of its namespaces, with the bridge's.
RUNS = {"expiry": (2, 3), "radio": (4, 3)}


def left_of(pid):
    mark = f"{field.PREFIX}-{pid}-"
    return [name for name in field.namespaces() + field.folders() if mark in name]


def processes_of(pid):
    """Those whose command line names the run's folder, as the nodes' does, or its namespaces, as the radio's does."""
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
    end = time.monotonic() + 300
    while not holds():
        if time.monotonic() > end:
            raise AssertionError("not within five minutes: " + what)
        time.sleep(0.1)


def end_with(number, program, scenario):
    processes, spaces = RUNS[scenario]
    run = subprocess.Popen([sys.executable, HERE / "run_scenario.py", "--ledger-node", program,
                            HERE / "scenarios" / scenario], stdout=subprocess.DEVNULL)
    try:
        wait_until(lambda: len(processes_of(run.pid)) == processes, "the nodes run")
        assert len(left_of(run.pid)) == spaces + 1, left_of(run.pid)  # and the folder
        run.send_signal(number)
        run.wait(300)
    finally:
        if run.poll() is None:
            run.kill()
            run.wait()
    wait_until(lambda: not processes_of(run.pid), "the nodes end")
    if number == signal.SIGKILL:
        field.sweep()
    assert not left_of(run.pid), f"left behind after {number.name}: {left_of(run.pid)}"


class MistakenField(field.Field):
    def _switch_on(self, node):
        field.run("ip", "-n", self.space(node), "link", "set", "nothing", "up")


def check_that_a_mistake_skips_no_test():
    try:
        with MistakenField(["probe"]):
            pass
    except subprocess.CalledProcessError:
        return
    raise AssertionError("a command that fails was not reported")


def main():
    with field.skipping():
        with field.Field(["probe"]):
            pass
        with radio_field.RadioField(pathlib.Path(sys.argv[1]).parent / "radio", ["probe"]):
            pass
    check_that_a_mistake_skips_no_test()
    for scenario in RUNS:
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            end_with(number, sys.argv[1], scenario)


if __name__ == "__main__":
    main()
