#!/usr/bin/env python3
"""Runs one scenario: a fleet of ledger nodes in network namespaces, faults, and the judge's verdict.

Usage: run_scenario.py --ledger-node PROGRAM [--transports NAME,...] [--keep FOLDER] SCENARIO_FOLDER
The folder's scenario.json holds what README.md lists.
Exit code 0: as it has to be; 1: something is wrong; 77: this machine or this build does not allow it."""

import argparse
import collections
import json
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import sys
import time

import expectations
import field
import harness
import judge
import radio_field

HERE = pathlib.Path(__file__).resolve().parent
TRIES = 3  # of a run in which the machine stands still


def argument(arguments, flag, default):
    return arguments[arguments.index(flag) + 1] if flag in arguments else default


class LedgerEnd:
    """Follows a ledger as it grows, without reading any line twice: the last counters of each link of the newest life,
    and how many lines of each kind there are in all."""

    def __init__(self, path):
        self._path = path
        self._offset = 0
        self.links = {}  # (node, queue) -> counters
        self.in_life = collections.Counter()
        self.total = collections.Counter()

    def read(self):
        if not self._path.exists():
            return
        with open(self._path, "rb") as file:
            file.seek(self._offset)
            lines, newline, _ = file.read().rpartition(b"\n")
        self._offset += len(lines) + len(newline)
        for event in filter(None, map(judge.read_line, (lines + newline).decode().splitlines(keepends=True))):
            self.follow(event)

    def follow(self, event):
        if event.kind == "start":
            self.links = {}
            self.in_life = collections.Counter()
        elif event.kind == "link":
            self.links[event["to"], event.values.get("queue", judge.NOTES)] = judge.counters_of(event)
        self.in_life[event.kind] += 1
        self.total[event.kind] += 1


class Fleet:
    """The nodes of a scenario and their ledgers. Its programs other than ledger nodes are started and stopped alike."""

    def __init__(self, ground, program, transport, scenario, end=LedgerEnd):
        self.field = ground
        self._program = program
        self._transport = transport
        self._scenario = scenario
        self._nodes = scenario["nodes"]
        self.ends = {node: end(self._path(node)) for node in self._nodes}
        self._steps = collections.Counter()  # node -> seconds by which its wall clock was set forward
        self._disks = collections.Counter()  # node -> how often it was given an empty state folder
        self.ended = set()  # by themselves or by the scenario, and well

    def start(self, node):
        self.ended.discard(node)
        programs = self._scenario.get("programs", {})
        inside = {"space": self._scenario["inside"][node]} if node in self._scenario.get("inside", {}) else {}
        if node in programs:
            self.field.start(node, [self._filled(word) for word in programs[node]], **inside)
            return
        how = dict(inside)
        if node in self._scenario.get("unread", []):
            how["unread"] = True
        if node in self._scenario.get("stepped", []):
            self.step_clock(node, 0)
            how["env"] = {"LD_PRELOAD": str(self._bin("libstepped_clock.so")), "STEPPED_CLOCK": str(self._clock(node))}
        name = self._scenario.get("names", {}).get(node, node)
        transport = self._scenario.get("transports", {}).get(node, self._transport)
        self.field.start(node, [self._program, "--node", name, "--ledger", self._path(node), "--transport", transport,
                                *self._disk(node), *map(self._filled, self._nodes[node])], **how)

    def _disk(self, node):
        """The node's state folder, if it may have one."""
        if node in self._scenario.get("stateless", []):
            return []
        state = pathlib.Path(self.field.folder, f"{node}.state{self._disks[node]}")
        state.mkdir(exist_ok=True)
        state.chmod(0o777)  # in a container the node runs as another user
        return ["--state-dir", state]

    def step_clock(self, node, seconds):
        """Sets the wall clock of that node's computer forward or back by so much more."""
        self._steps[node] += seconds
        file = os.open(self._clock(node), os.O_WRONLY | os.O_CREAT, 0o644)
        os.pwrite(file, struct.pack("=q", self._steps[node]), 0)
        os.close(file)

    def _clock(self, node):
        return pathlib.Path(self.field.folder, node + ".clock")

    def new_disk(self, node):
        self._disks[node] += 1

    def stop_one(self, node):
        """SIGTERM; it must end well."""
        process = self.field.processes[node]
        code = process.terminate()
        if code != 0:
            raise AssertionError(f"{node} ended with {code}: {[text for _, text in process.lines[-5:]]}")
        self.ended.add(node)

    def _filled(self, word):
        """@node is that node's address, {here} this folder, {bin} that of the built programs."""
        if word.startswith("@"):
            return self.field.address(word[1:])
        return word.format(here=HERE, bin=self._bin()) if "{" in word else word

    def _bin(self, *name):
        return pathlib.Path(self._program, "..", *name).resolve()

    def paths(self):
        return {node: self._path(node) for node in self._nodes}

    def ledgers(self):
        return {node: self._path(node).read_text() if self._path(node).exists() else "" for node in self._nodes}

    def stop(self):
        """SIGTERM to all that run; all must end well."""
        wrong = []
        for node, process in self.field.processes.items():
            if node in self.ended:
                continue
            if process.running():
                try:
                    code = process.terminate()
                except subprocess.TimeoutExpired:
                    code = f"{process.kill()}, for it did not end on SIGTERM"
                if code != 0:
                    wrong.append(f"{node} ended with {code}: {[text for _, text in process.lines[-5:]]}")
            else:
                wrong.append(f"{node} ended by itself: {[text for _, text in process.lines[-5:]]}")
        return wrong

    def wait_until_settled(self, limit_s, waited=lambda begin, end: 0.0):
        """Until the last life of each node has had all its notes accepted, and has an outcome of each. It may take so long, and
        what the machine took (harness.Waits) as long as something changes."""
        before, began = None, time.monotonic()
        since = began
        while time.monotonic() - since < limit_s and time.monotonic() - began < limit_s + waited(began, time.monotonic()):
            left = self._unsettled()
            if not left:
                return []
            if left != before:
                before, since = left, time.monotonic()
            time.sleep(0.5)
        return [f"not settled after {time.monotonic() - began:.0f} s, and as it is for {time.monotonic() - since:.0f} s: {text}"
                for text in left]

    def _unsettled(self):
        left = []
        for node, end in self.ends.items():
            end.read()
            arguments = self._nodes[node]
            wanted = int(argument(arguments, "--count", 0))
            for to in (a for flag, a in zip(arguments, arguments[1:]) if flag == "--to"):
                now = end.links.get((to, judge.NOTES), collections.Counter())
                if now["accepted"] < wanted or now["outbox"]:
                    left.append(f"{node} to {to}: {now['accepted']} of {wanted} accepted, {now['outbox']} open")
            pictures = int(argument(arguments, "--pictures", 1)) if "--pictures-to" in arguments else 0
            if end.in_life["picture_outcome"] < pictures:
                left.append(f"{node}: outcomes of {end.in_life['picture_outcome']} of {pictures} pictures")
        return left

    def _path(self, node):
        return pathlib.Path(self.field.folder, node + ".ledger")


class Faults:
    """One method for each fault that a scenario may name."""

    def __init__(self, fleet):
        self._fleet = fleet
        self._field = fleet.field
        self.done = []  # (time in s on the ledgers' clock, what, arguments)

    def run(self, steps):
        for what, *arguments in steps:
            self.done.append((time.monotonic(), what, arguments))
            getattr(self, what)(*arguments)

    def wait(self, seconds):
        time.sleep(seconds)

    def start(self, node):
        self._fleet.start(node)

    def kill(self, node):
        self._field.kill(node)

    def stop(self, node):
        self._fleet.stop_one(node)

    def step_clock(self, node, seconds):
        self._fleet.step_clock(node, seconds)

    def shape(self, node, kbit):
        self._field.shape(node, kbit)

    def move(self, node):
        """As if on another computer: another address, and no memory of earlier lives."""
        self._field.move(node)
        self._fleet.new_disk(node)

    def freeze(self, node):
        self._field.signal(node, signal.SIGSTOP)

    def thaw(self, node):
        self._field.signal(node, signal.SIGCONT)

    def lose(self, percent, origins=None, destinations=None):
        self._field.lose(percent, origins, destinations)

    def cut(self, node):
        self._field.cut(node)

    def heal(self):
        self._field.heal()

    def rate(self, kbit):
        self._field.rate(kbit)

    def delay(self, ms, jitter_ms=0):
        self._field.delay(ms, jitter_ms)

    def deaf(self, node, origin):
        self._field.deaf(node, origin)

    def hear(self, node, origin):
        self._field.hear(node, origin)

    def arp(self, switched):
        self._field.arp(switched)

    def outage(self, switched):
        self._field.outage(switched)

    def repeat(self, times, steps):
        for _ in range(times):
            self.run(steps)


def figures(seen):
    """One line for each link: what became of the notes, and how long they took, of those sent under loss if any."""
    delays = seen.links()
    for node, lives in seen.lives.items():
        for to in sorted({event["to"] for life in lives for event in life.of("intent")}):
            took = sorted(1000 * delay for time, delay in delays[node, to] if time - delay > seen.losing_since())
            total = collections.Counter()
            for life in lives:
                total.update(life.counters(to) or {})
            yield (f"{node} to {to}: lives {len(lives)}, accepted {total['accepted']}, delivered {total['delivered']}, "
                   f"expired {total['expired']}, in doubt {total['in_doubt']}, resent {total['resent']}"
                   + (f", delay p50 {took[len(took) // 2]:.1f} ms, p99 {took[len(took) * 99 // 100]:.1f} ms"
                      if took else ""))


class StoodStill(Exception):
    """All that seems wrong in a run in which the whole machine stood still for so long that nodes become STALE. Nobody can tell
    what the nodes would have done. Messages that are lost, twice or out of order are wrong in any case, and so is a node that ends
    by itself or with an error."""


def repeated(a_run):
    """What is wrong in a run, which is repeated if the machine stood still meanwhile."""
    wrong = []
    for _ in range(TRIES):
        try:
            return a_run()
        except StoodStill as reason:
            wrong = reason.args[0]
            print("the run proves nothing, since the machine stood still: " + "; ".join(wrong[:5]), flush=True)
    return wrong


def run(options):
    scenario = json.loads(pathlib.Path(options.scenario, "scenario.json").read_text())
    missing = set(scenario.get("transports", {}).values()) - set(options.transports.split(","))
    if missing:
        raise field.Unsupported(f"not built: {', '.join(sorted(missing))}")
    hosts = [node for node in [*scenario["nodes"], *scenario.get("programs", {})]
             if node not in scenario.get("inside", {})]
    multicast = scenario.get("multicast", True)
    if "medium" in scenario:
        radio = options.radio or pathlib.Path(options.ledger_node).parent / "radio"
        ground = radio_field.RadioField(radio, hosts, scenario["medium"], multicast)
    else:
        ground = field.Field(hosts, multicast)
    with ground:
        return run_in(ground, scenario, options)


def run_in(ground, scenario, options):
    """Runs it in a field that is there: namespaces or containers."""
    fleet = Fleet(ground, options.ledger_node, options.transports.split(",")[0], scenario)
    faults = Faults(fleet)
    pauses = harness.Pauses()
    waits = harness.Waits(ground.pids)
    began = time.monotonic()
    for node in [*scenario["nodes"], *scenario.get("programs", {})]:
        if node not in scenario.get("late", []):
            fleet.start(node)
    faults.run(scenario["faults"])
    wrong = fleet.wait_until_settled(scenario["limit_s"], waits.between)
    seconds = time.monotonic() - began
    bytes_sent = {node: ground.traffic(node)[0] for node in scenario["nodes"]}
    air = ground.counters() if "medium" in scenario else None
    # Judged before the stop, which the other nodes see as LOST.
    wrong += expectations.states(expectations.Run(fleet.ledgers(), faults.done, waits.between), scenario.get("states", {}))
    ended = time.monotonic()
    unsound = fleet.stop()
    ledgers = fleet.ledgers()
    if options.keep:
        shutil.copytree(ground.folder, options.keep, dirs_exist_ok=True)
    seen = expectations.Run(ledgers, faults.done, waits.between)
    for line in figures(seen):
        print(line)
    print(f"{seconds:.0f} s; bytes sent: " + ", ".join(f"{node} {count}" for node, count in bytes_sent.items()))
    seen.air, seen.ended = air, ended
    print(f"the processes waited for a processor for {waits.between(began, ended):.1f} s, all together")
    still = pauses.end()
    for begin, end in still:
        print(f"the machine stood still for {end - begin:.1f} s, {begin - began:.0f} s after the start")
    if air:
        print(radio_field.summary(air))
    wrong += expectations.check(seen, scenario.get("expect", {}))
    unsound += judge.judge(ledgers[node] for node in scenario.get("judged", ledgers))
    if wrong and not unsound and any(end - begin >= expectations.STALE_S for begin, end in still):
        raise StoodStill(wrong)
    return wrong + unsound


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--ledger-node", required=True)
    parser.add_argument("--transports", default="fastdds", help="those that are built, the default one first")
    parser.add_argument("--radio", help="the program for a scenario with a medium; default: beside the ledger node")
    parser.add_argument("--keep", help="copy the ledgers into this folder")
    parser.add_argument("scenario")
    with field.skipping():
        options = parser.parse_args()
        wrong = repeated(lambda: run(options))
    for text in wrong[:50]:
        print("WRONG " + text)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
