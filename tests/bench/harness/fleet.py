"""A fleet of processes on one machine: each publishes at the same rate and subscribes to that of all others."""

import os
import pathlib
import signal
import statistics
import time

from contestants import LIMIT_S, harness, loopback_bytes, result

# A fleet has settled when, within one second, each member has heard this share of its expected samples.
SETTLED = 0.8
# A machine that is too small for the fleet never gets that far; the results then have the share that arrived.
SETTLING_S = 10


class Fleet:
    """with Fleet(programs, contestant, transport, options) as fleet: fleet.discover(), fleet.measure(seconds)"""

    def __init__(self, programs, contestant, transport, options):
        self._argv = lambda member: programs.argv(contestant, transport, "member", {**options, "member": member})
        self.size, self._period_ns = options["members"], options["period"]
        self.members = []
        self._processes = harness.Processes()

    def __enter__(self):
        self._processes.__enter__()
        return self

    def __exit__(self, *error):
        self._processes.__exit__(*error)

    def discover(self):
        """Starts all, one after the other without a pause. Seconds from the start of the last one until every one has
        a sample of every other."""
        for member in range(1, self.size + 1):
            last_start = time.monotonic_ns()
            self.members.append(self._processes.start(self._argv(member)))
        end = time.monotonic() + LIMIT_S
        try:
            heard = [result(member, 0, end - time.monotonic())["all_heard_at_ns"] for member in self.members]
        except AssertionError as error:
            raise AssertionError(f"{self.size} processes: within {LIMIT_S} s not all heard all\n"
                                 + self._who_misses_whom()) from error
        return (max(heard) - last_start) * 1e-9

    def settle(self):
        """Waits until the samples flow evenly."""
        reports = self._reports()
        for _ in range(SETTLING_S):
            time.sleep(1)
            before, reports = reports, self._reports()
            if min(self._arrived(b, a) for b, a in zip(before, reports)) >= SETTLED:
                return

    def measure(self, seconds):
        """What each member costs on average, and whether the machine was large enough for all of them."""
        before, bytes_before, busy_before, began = self._reports(), loopback_bytes(), busy_s(), time.monotonic()
        time.sleep(seconds)
        passed, bytes_after, busy_after = time.monotonic() - began, loopback_bytes(), busy_s()
        after = self._reports()
        strangers = sum(report["strangers"] for report in after)
        if strangers:
            raise AssertionError(f"{strangers} samples came from outside the fleet")
        shares = [(a["cpu_ns"] - b["cpu_ns"]) / (a["at_ns"] - b["at_ns"]) for b, a in zip(before, after)]
        shares_arrived = [self._arrived(b, a) for b, a in zip(before, after)]
        memory = [memory_mib(member.pid) for member in self.members]
        return {"processor": statistics.mean(shares), "processor_of_the_dearest": max(shares),
                "bytes_per_s": (bytes_after - bytes_before) / self.size / passed,
                "pss_mib": statistics.mean(pss for pss, _ in memory),
                "own_mib": statistics.mean(own for _, own in memory),
                "arrived": statistics.mean(shares_arrived), "arrived_at_the_worst": min(shares_arrived),
                "busy": (busy_after - busy_before) / passed / os.cpu_count()}

    def _arrived(self, before, after):
        """Share of what all others should have sent meanwhile that has come."""
        due = (after["at_ns"] - before["at_ns"]) / self._period_ns * (self.size - 1)
        return (after["received"] - before["received"]) / due

    def _reports(self):
        """A report of each member, of about the same moment."""
        asked = [len(member.lines) for member in self.members]
        for member in self.members:
            os.kill(member.pid, signal.SIGUSR1)
        return [self._next_report(member, lines) for member, lines in zip(self.members, asked)]

    @staticmethod
    def _next_report(member, lines):
        index = sum(text.startswith("{") for _, text in member.lines[:lines])
        report = result(member, index)
        # A member may hear the last of the others only after it was asked: the next report then is the answer.
        return report if "at_ns" in report else result(member, index + 1)

    def _who_misses_whom(self):
        ended = [f"{number} has ended: {member.lines[-3:]}\n" for number, member in enumerate(self.members, 1)
                 if not member.running()]
        if ended:
            return "".join(ended)
        text = ""
        for number, (member, report) in enumerate(zip(self.members, self._reports()), 1):
            if report["missing"]:
                text += f"{number} (pid {member.pid}) has not heard {report['missing']}\n"
        return text


def memory_mib(pid):
    """(its proportional share of what it has in memory, what it has for itself alone and not of a file)"""
    fields = dict(line.split()[:2] for line in
                  pathlib.Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()[1:])
    return int(fields["Pss:"]) / 1024, int(fields["Anonymous:"]) / 1024


def busy_s():
    """Seconds that all processors together were not idle so far, whoever used them."""
    fields = [int(f) for f in pathlib.Path("/proc/stat").read_text().splitlines()[0].split()[1:9]]
    return (sum(fields) - fields[3] - fields[4]) / os.sysconf("SC_CLK_TCK")


def run(programs, contestant, transport, options, seconds):
    """One fleet from its start to its end."""
    with Fleet(programs, contestant, transport, options) as fleet:
        discovery = fleet.discover()
        fleet.settle()
        return {"discovery_s": discovery, **fleet.measure(seconds)}
