"""Twenty aircraft whose processors are taken away for a while: the ground station shows that, and all are UP again once they
have their processors back. What is old is not shown as fresh: FleetTable, FleetView and rule 14 of the simulation of fleets.

Usage: overload_test.py DEMO BIN TRANSPORT
The load of others is a control group of the kernel's that gives the fleet a twentieth of what it needs; nobody else on
the machine feels it. Ends with 77 where such groups cannot be made."""

import os
import pathlib
import re
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 240
AIRCRAFT = 20
# The aircraft need 0.8 of a processor.
SHARE_PERCENT = 4
LOAD_S = 20  # from the first that is not UP on
ROW = re.compile(r"\s*[\d.]+ s\s+(uav\d+)\s+(\w+)")


class ControlGroup:
    """A group of processes, by version 1 or 2 of the kernel's interface."""

    def __init__(self):
        first = pathlib.Path("/sys/fs/cgroup/cpu")
        self._old = first.is_dir()
        self.path = (first if self._old else pathlib.Path("/sys/fs/cgroup")) / f"rabit_overload_{os.getpid()}"
        self.path.mkdir()
        try:
            self.limit(None)
        except OSError:  # groups, but none for processors
            self.path.rmdir()
            raise

    def limit(self, percent):
        """Of one processor; None: no limit."""
        period = 100_000
        quota = -1 if percent is None else percent * period // 100
        if self._old:
            (self.path / "cpu.cfs_period_us").write_text(str(period), encoding="ascii")
            (self.path / "cpu.cfs_quota_us").write_text(str(quota), encoding="ascii")
        else:
            (self.path / "cpu.max").write_text(f"{'max' if quota < 0 else quota} {period}", encoding="ascii")

    def pids(self):
        return [int(pid) for pid in (self.path / "cgroup.procs").read_text(encoding="ascii").split()]

    def remove(self):
        """Once its processes have ended."""
        harness.until(lambda: not self.pids(), LIMIT_S)
        self.path.rmdir()


def all_up(states):
    return len(states) == AIRCRAFT and set(states.values()) == {"UP"}


def wait_for_states(ground, holds, since):
    """When the states of the last table satisfy `holds`, and what they are."""
    states = {}

    def look(text):
        row = ROW.match(text)
        if row:
            states[row[1]] = row[2]
        return dict(states) if row and holds(states) else None

    return ground.wait_for(look, LIMIT_S, since)


def fly(demo, programs, transport, group):
    with harness.Processes() as processes:
        ground = processes.start(
            ["sh", "-c", f"echo $$ >{group.path}/cgroup.procs && exec \"$@\"", "sh", demo, "--bin", programs, "--uavs",
             AIRCRAFT, "--web", "off", "--transport", transport, "--domain", harness.domain()])
        wait_for_states(ground, all_up, 0)
        begin = time.monotonic()
        group.limit(SHARE_PERCENT)
        # Shows that the load is one.
        wait_for_states(ground, lambda states: "STALE" in states.values() or "LOST" in states.values(), begin)
        time.sleep(LOAD_S)
        group.limit(None)
        end = time.monotonic()
        up, _ = wait_for_states(ground, all_up, end)
        print(f"{transport}: all UP {up - end:.1f} s after a load of {end - begin:.0f} s")
        ground.terminate(LIMIT_S)


def main():
    demo, programs, transport = sys.argv[1:]
    harness.enter_namespace()
    try:
        group = ControlGroup()
    except OSError as error:
        harness.skip(f"no control group can be made here: {error}")
    try:
        fly(demo, programs, transport, group)
    finally:
        group.limit(None)
        group.remove()


if __name__ == "__main__":
    main()
