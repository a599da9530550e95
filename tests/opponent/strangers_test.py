#!/usr/bin/env python3
"""Each sequence of a stranger against a fleet of three real nodes, over both vendors. README.md lists what is judged.

Usage: strangers_test.py --opponent FILE --ledger-node FILE [--only NAME,...] [--seed N] [--seconds N]
--seconds: how long each sequence plays.
Exit code 0: all is well; 1: something is wrong; 77: this machine allows no namespaces."""

import argparse
import os
import pathlib
import re
import signal
import subprocess
import sys
import time
import types

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "gate"), str(HERE.parent / "integration")]
import flights  # noqa: E402
import field  # noqa: E402
import harness  # noqa: E402
import judge  # noqa: E402
import sight  # noqa: E402

FLEET = {"ground": "fastdds", "uav1": "cyclonedds", "uav2": "fastdds"}
NEWCOMERS = {"newcomer1": "fastdds", "newcomer2": "cyclonedds"}
ADDRESSES = 4
LIMIT_S = 300  # only ends a broken run
QUIET_S = 6
HEAR_S = 2
# The goals.
MOST_MEMORY_MB = 10
MOST_PROCESSOR = 0.5  # of one, beyond what the node takes in quiet
LONGEST_MEETING_S = 2
MOST_TRAFFIC = 2  # bytes out for each byte in


def memory_mb(pid):
    status = pathlib.Path(f"/proc/{pid}/status").read_text(encoding="ascii")
    return int(re.search(r"VmRSS:\s+(\d+) kB", status).group(1)) / 1024


def processor_s(pid):
    words = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


class Look:
    """What the fleet has taken so far."""

    def __init__(self, flight, changes):
        ground = flight.ground
        self.when = time.monotonic()
        self.memory = {node: memory_mb(ground.processes[node].pid) for node in FLEET}
        self.processor = {node: processor_s(ground.processes[node].pid) for node in FLEET}
        self.out = sum(ground.traffic(node)[0] for node in FLEET)
        self.changes = len(changes)


class Trial:
    def __init__(self, options, ground, name):
        self.options, self.ground, self.name = options, ground, name
        self.flight = flights.Flight(types.SimpleNamespace(ledger_node=options.ledger_node,
                                                           deadline=time.monotonic() + LIMIT_S + options.seconds),
                                     ground, dict(FLEET))
        self.wrong = []
        self.seen = {}

    def changes(self):
        """What nodes showed of each other besides UP, so far."""
        lines = []
        for node, text in self.flight.fleet.ledgers().items():
            for event in filter(None, map(judge.read_line, text.splitlines(keepends=True))):
                if event.kind == "peer" and event["node"] in FLEET and event["state"] != "UP":
                    lines.append(f"{node} shows {event['node']} {event['state']}")
        return lines

    def newcomer(self, name):
        """Starts one more node, and returns after how many seconds it and the fleet show each other UP."""
        path = pathlib.Path(self.ground.folder, f"{name}.late")
        begin = time.monotonic()
        process = self.ground.start(name, [self.options.ledger_node, "--node", name, "--ledger", path, "--transport",
                                           NEWCOMERS[name]])
        own = sight.Sight(path)

        def met():
            for each in (own, *self.flight.sights.values()):
                each.read()
            return (all(own.peers.get(node) == "UP" for node in FLEET) and
                    all(self.flight.sights[node].peers.get(name) == "UP" for node in FLEET))
        while not met() and time.monotonic() - begin < 4 * LONGEST_MEETING_S:
            time.sleep(0.02)
        took = time.monotonic() - begin
        del self.ground.processes[name]
        process.kill()
        return took

    def play(self):
        flight, options = self.flight, self.options
        flight.gather()
        flight.exchange()
        first = Look(flight, self.changes())
        time.sleep(QUIET_S)
        quiet = Look(flight, self.changes())
        idle = (quiet.out - first.out) / (quiet.when - first.when)
        self.seen["newcomer in quiet"] = self.newcomer("newcomer1")
        met = Look(flight, self.changes())
        newcomer_bytes = max(0, met.out - quiet.out - idle * (met.when - quiet.when))
        addresses = self.ground.address("opponent"), *(f"10.77.9.{number + 1}" for number in range(ADDRESSES - 1))
        for address in addresses[1:]:
            field.run("ip", "-n", self.ground.space("opponent"), "address", "add", address + "/16", "dev", "eth0")
        opponent = harness.Process(["ip", "netns", "exec", self.ground.space("opponent"), options.opponent, "--only", self.name,
                                    "--seed", options.seed, "--seconds", options.seconds, "--hear", HEAR_S,
                                    *(word for address in addresses for word in ("--from", address))])
        try:
            opponent.wait_for(re.compile(r"heard \d+").fullmatch, LIMIT_S)
            begin = Look(flight, self.changes())
            largest = dict(begin.memory)
            curve = []  # growth of the node that grew most, minute by minute
            half = time.monotonic() + options.seconds / 2
            meetings = []
            while opponent.running():
                for node in FLEET:
                    if not self.ground.processes[node].running():
                        raise flights.Failure("each node to live", f"{node} ended with {self.ground.processes[node].exit_code(5)}")
                    largest[node] = max(largest[node], memory_mb(self.ground.processes[node].pid))
                if time.monotonic() - begin.when > 60 * (len(curve) + 1):
                    curve.append(round(max(memory_mb(self.ground.processes[node].pid) - begin.memory[node] for node in FLEET), 1))
                if not meetings and time.monotonic() > half:
                    meetings = [self.newcomer(name) for name in NEWCOMERS]
                time.sleep(0.2)
            _, played = opponent.wait_for(re.compile(r"played \S+ datagrams (\d+) bytes (\d+)").fullmatch, LIMIT_S)
        finally:
            if opponent.running():
                opponent.kill()
        end = Look(flight, self.changes())
        took = end.when - begin.when
        inside = int(played.group(2))
        grown = {node: largest[node] - begin.memory[node] for node in FLEET}
        busy = {node: (end.processor[node] - begin.processor[node]) / took -
                (quiet.processor[node] - first.processor[node]) / (quiet.when - first.when) for node in FLEET}
        extra = max(0, end.out - begin.out - idle * took - len(NEWCOMERS) * newcomer_bytes)
        self.seen |= {"in": inside, "extra out": round(extra), "memory": grown, "memory each minute": curve, "processor": busy, "meetings": meetings,
                      "presence": end.changes - begin.changes}
        self.judge(grown, busy, meetings, inside, extra, self.changes()[begin.changes:])
        flight.exchange()
        self.wrong += flight.end()

    def judge(self, grown, busy, meetings, inside, extra, changes):
        def expect(holds, expected, seen):
            if not holds:
                self.wrong.append(f"expected {expected}; seen: {seen}")
        for node in FLEET:
            expect(grown[node] <= MOST_MEMORY_MB, f"{node} to grow by {MOST_MEMORY_MB} MB at most", f"{grown[node]:.1f} MB")
            expect(busy[node] <= MOST_PROCESSOR, f"{node} to take {MOST_PROCESSOR} of a processor more at most", f"{busy[node]:.2f}")
        for took in meetings:
            expect(took <= LONGEST_MEETING_S, f"a newcomer to be met within {LONGEST_MEETING_S} s", f"{took:.2f} s")
        expect(extra <= MOST_TRAFFIC * inside, f"{MOST_TRAFFIC} bytes out for each of {inside} in at most", f"{extra:.0f}")
        expect(not changes, "the nodes to show each other UP all the while", changes[:4])


def trial(options, name):
    hosts = [*FLEET, *NEWCOMERS, "opponent"]
    with field.Field(hosts) as ground:
        run = Trial(options, ground, name)
        try:
            run.play()
        except flights.Failure as failure:
            run.wrong.append(str(failure))
        except AssertionError as error:
            run.wrong.append(harness.reason(error))
        return run


def shown(seen):
    return {key: {node: round(number, 2) for node, number in value.items()} if isinstance(value, dict) else
            [round(each, 2) for each in value] if isinstance(value, list) else
            round(value, 2) if isinstance(value, float) else value for key, value in seen.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--opponent", required=True)
    parser.add_argument("--ledger-node", required=True)
    parser.add_argument("--only")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=int, default=30)
    options = parser.parse_args()
    with field.skipping(), field.Field(["probe"]):
        pass
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, field.stop)
    listed = subprocess.run([options.opponent, "--list"], check=True, capture_output=True, text=True).stdout
    names = options.only.split(",") if options.only else [line.split(":")[0] for line in listed.splitlines()]
    failed = False
    for name in names:
        run = trial(options, name)
        print(f"{name}, seed {options.seed}: {shown(run.seen)}", flush=True)
        for text in run.wrong:
            print(f"FAILED {name}: {text}", flush=True)
        failed = failed or bool(run.wrong)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
