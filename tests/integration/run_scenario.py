#!/usr/bin/env python3
"""Runs one scenario: a fleet of ledger nodes in network namespaces, faults, and the judge's verdict, which outcomes alone
decide. README.md says how.

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
import judge
import radio_field
import sight

HERE = pathlib.Path(__file__).resolve().parent
PATIENCE_S = 600  # for an outcome; it only ends a broken run
LOOK_S = 0.2


class NeverSeen(Exception):
    """Outcomes that did not come, one text for each."""


def argument(arguments, flag, default):
    return arguments[arguments.index(flag) + 1] if flag in arguments else default


class Fleet:
    """The nodes of a scenario and what they have seen. Its programs other than ledger nodes are started and stopped alike."""

    def __init__(self, ground, program, transport, scenario):
        self.field = ground
        self._program = program
        self._transport = transport
        self._scenario = scenario
        self._nodes = scenario["nodes"]
        self.sights = {node: sight.Sight(self._path(node)) for node in self._nodes}
        self._steps = collections.Counter()  # node -> seconds by which its wall clock was set forward
        self._disks = collections.Counter()  # node -> how often it was given an empty state folder
        self._ordered = collections.Counter()  # node -> notes to each receiver that were ordered in its newest life
        self.running = set()  # nodes
        self.ended = set()  # by themselves or by the scenario, and well

    def start(self, node):
        self.ended.discard(node)
        if node in self._nodes:
            self.running.add(node)
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
        self._forget(node)

    def kill(self, node):
        self.field.kill(node)
        self._forget(node)

    def _forget(self, node):
        self.running.discard(node)
        self._ordered[node] = 0
        self.sights[node].read()
        self.sights[node].await_life()

    def order(self, node, text):
        """A line of Orders.h on the node's standard input."""
        self.field.processes[node].tell(text)
        what, _, count = text.partition(" ")
        self._ordered[node] += int(count) if what == "notes" else 0

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

    def until(self, missing, patience_s=PATIENCE_S):
        """Waits until `missing()` finds nothing. Raises NeverSeen if it still does after that time, or if a node has ended."""
        began = time.monotonic()
        while True:
            ended = [node for node in self.running if not self.field.processes[node].running()]
            for one in self.sights.values():
                one.read()
            left = missing()
            if not left:
                return
            if ended or time.monotonic() - began > patience_s:
                raise NeverSeen(*left, *(f"{node} ended by itself" for node in ended))
            time.sleep(LOOK_S)

    def groups(self):
        """The judged nodes that must meet, and those that must not be seen by them: each group by itself."""
        return self._scenario.get("groups", [self._scenario.get("judged", list(self._nodes))])

    def not_met(self):
        ticking = [node for node, arguments in self._nodes.items() if "--ticks" in arguments]
        return [text for group in self.groups()
                for text in sight.not_met(self.sights, [node for node in group if node in self.running], ticking)]

    def old_states(self):
        return [text for group in self.groups()
                for text in sight.old_states(self.sights, [node for node in group if node in self.running])]

    def unsettled(self):
        """What is missing until the newest life of each node has had all its notes accepted, has an outcome of each, and has
        posted all its States."""
        left = []
        for node in self.running:
            one, arguments = self.sights[node], self._nodes[node]
            wanted = int(argument(arguments, "--count", 0)) + self._ordered[node]
            for to in (a for flag, a in zip(arguments, arguments[1:]) if flag == "--to"):
                now = one.links.get((to, judge.NOTES), collections.Counter())
                if now["accepted"] < wanted or now["outbox"]:
                    left.append(f"{node} to {to}: {now['accepted']} of {wanted} accepted, {now['outbox']} open")
            pictures = int(argument(arguments, "--pictures", 1)) if "--pictures-to" in arguments else 0
            if one.in_life["picture_outcome"] < pictures:
                left.append(f"{node}: outcomes of {one.in_life['picture_outcome']} of {pictures} pictures")
            posts = int(argument(arguments, "--states", 0)) * int(argument(arguments, "--state-posts", 0))
            if sum(one.posted.values()) < posts:
                left.append(f"{node}: {sum(one.posted.values())} of {posts} States posted")
        return left

    def counted(self, node, key):
        return sum(counters[key] for counters in self.sights[node].links.values())

    def _path(self, node):
        return pathlib.Path(self.field.folder, node + ".ledger")


class Faults:
    """One method for each fault, and each outcome to wait for, that a scenario may name."""

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
        self._fleet.kill(node)

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

    def order(self, node, text):
        self._fleet.order(node, text)

    def meet(self):
        self._fleet.until(self._fleet.not_met)

    def settle(self):
        self._fleet.until(self._fleet.unsettled)

    def shows(self, node, other, state):
        peers = self._fleet.sights[node].peers
        self._until(lambda: self._fleet.sights[node].peers.get(other) == state,
                    lambda: f"{node} shows {other} {peers.get(other, 'not at all')}, not {state}")

    def refused(self, node, other):
        self._until(lambda: self._fleet.sights[node].refused[other], lambda: f"nothing from {node} to {other} is refused")

    def reports(self, node, text):
        self._until(lambda: any(text in reason for reason in self._fleet.sights[node].problems),
                    lambda: f"{node} did not report '{text}', but {self._fleet.sights[node].problems}")

    def says(self, program, text):
        self._until(lambda: any(text in line for _, line in self._field.processes[program].lines),
                    lambda: f"{program} does not say '{text}'")

    def counted(self, node, key, count):
        self._until(lambda: self._fleet.counted(node, key) >= count,
                    lambda: f"{node} counts {self._fleet.counted(node, key)} notes {key}, not {count}")

    def _until(self, holds, text):
        self._fleet.until(lambda: [] if holds() else [text()])


def figures(seen):
    """One line for each link: what became of the notes, and how long they took."""
    delays = seen.links()
    for node, lives in seen.lives.items():
        for to in sorted({event["to"] for life in lives for event in life.of("intent")}):
            took = sorted(1000 * delay for _, delay in delays[node, to])
            total = collections.Counter()
            for life in lives:
                total.update(life.counters(to) or {})
            yield (f"{node} to {to}: lives {len(lives)}, accepted {total['accepted']}, delivered {total['delivered']}, "
                   f"expired {total['expired']}, in doubt {total['in_doubt']}, resent {total['resent']}"
                   + (f", delay p50 {took[len(took) // 2]:.1f} ms, p99 {took[len(took) * 99 // 100]:.1f} ms"
                      if took else ""))


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
    expect = scenario.get("expect", {})
    wrong = []
    for node in [*scenario["nodes"], *scenario.get("programs", {})]:
        if node not in scenario.get("late", []):
            fleet.start(node)
    try:
        faults.run(scenario["faults"])
        fleet.until(lambda: fleet.unsettled() + fleet.not_met() + fleet.old_states() + expectations.awaited(fleet.sights, expect))
    except NeverSeen as never:
        last = faults.done[-1][1:] if faults.done else "the start"
        wrong += [f"not seen after {last}: {text}" for text in never.args]
    bytes_sent = {node: ground.traffic(node)[0] for node in scenario["nodes"]}
    air = ground.counters() if "medium" in scenario else None
    wrong += fleet.stop()
    ledgers = fleet.ledgers()
    if options.keep:
        shutil.copytree(ground.folder, options.keep, dirs_exist_ok=True)
    seen = expectations.Run(ledgers, faults.done)
    for line in figures(seen):
        print(line)
    print("bytes sent: " + ", ".join(f"{node} {count}" for node, count in bytes_sent.items()))
    if air:
        print(radio_field.summary(air))
    wrong += sight.strayed(fleet.sights, fleet.groups()) if "groups" in scenario else []
    wrong += expectations.check(seen, expect)
    return wrong + judge.judge(ledgers[node] for node in scenario.get("judged", ledgers))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--ledger-node", required=True)
    parser.add_argument("--transports", default="fastdds", help="those that are built, the default one first")
    parser.add_argument("--radio", help="the program for a scenario with a medium; default: beside the ledger node")
    parser.add_argument("--keep", help="copy the ledgers into this folder")
    parser.add_argument("scenario")
    with field.skipping():
        options = parser.parse_args()
        wrong = run(options)
    for text in wrong[:50]:
        print("WRONG " + text)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
