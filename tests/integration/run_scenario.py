#!/usr/bin/env python3
"""Runs one scenario: a fleet of ledger nodes in network namespaces, faults, and the judge's verdict.

Usage: run_scenario.py --ledger-node PROGRAM [--transport NAME] [--keep FOLDER] SCENARIO_FOLDER
The folder's scenario.json holds (README.md says more):
  nodes    {name: [argument of ledger_node, ...]}
  faults   [[what, argument, ...], ...], done in this order; see the class Faults
  limit_s  generous: how long after the last fault all notes may take
Exit code 0: as it has to be; 1: something is wrong; 77: this machine has no namespaces."""

import argparse
import collections
import json
import pathlib
import shutil
import signal
import sys
import time

import field
import judge

SKIPPED = 77


class Fleet:
    """The nodes of a scenario and their ledgers."""

    def __init__(self, ground, program, transport, nodes):
        self.field = ground
        self._program = program
        self._transport = transport
        self._nodes = nodes

    def start(self, node):
        state = pathlib.Path(self.field.folder, node + ".state")
        state.mkdir(exist_ok=True)
        state.chmod(0o777)  # in a container the node runs as another user
        self.field.start(node, [self._program, "--node", node, "--ledger", self._path(node), "--transport",
                                self._transport, "--state-dir", state, *self._nodes[node]])

    def ledgers(self):
        return {node: self._path(node).read_text() if self._path(node).exists() else "" for node in self._nodes}

    def stop(self):
        """SIGTERM to all that run; all must end well."""
        wrong = []
        for node, process in self.field.processes.items():
            if process.running():
                code = process.terminate()
                if code != 0:
                    wrong.append(f"{node} ended with {code}: {[text for _, text in process.lines[-5:]]}")
            else:
                wrong.append(f"{node} ended by itself: {[text for _, text in process.lines[-5:]]}")
        return wrong

    def wait_until_settled(self, limit_s):
        """Until the last life of each node has had all its notes accepted, and has an outcome of each."""
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            left = self._unsettled()
            if not left:
                return []
            time.sleep(0.5)
        return [f"not settled {limit_s} s after the last fault: {text}" for text in left]

    def _unsettled(self):
        left = []
        for node, text in self.ledgers().items():
            arguments = self._nodes[node]
            wanted = int(arguments[arguments.index("--count") + 1]) if "--count" in arguments else 0
            lives = judge.read_ledger(text)
            for to in (a for flag, a in zip(arguments, arguments[1:]) if flag == "--to"):
                now = (lives and lives[-1].counters(to)) or collections.Counter()
                if now["accepted"] < wanted or now["outbox"]:
                    left.append(f"{node} to {to}: {now['accepted']} of {wanted} accepted, {now['outbox']} open")
        return left

    def _path(self, node):
        return pathlib.Path(self.field.folder, node + ".ledger")


class Faults:
    """One method for each fault that a scenario may name."""

    def __init__(self, fleet):
        self._fleet = fleet
        self._field = fleet.field

    def run(self, steps):
        for what, *arguments in steps:
            getattr(self, what)(*arguments)

    def wait(self, seconds):
        time.sleep(seconds)

    def start(self, node):
        self._fleet.start(node)

    def kill(self, node):
        self._field.kill(node)

    def freeze(self, node):
        self._field.signal(node, signal.SIGSTOP)

    def thaw(self, node):
        self._field.signal(node, signal.SIGCONT)

    def lose(self, percent, origins=None, destinations=None):
        self._field.lose(percent, origins, destinations)

    def cut(self, node):
        self._field.cut(node)

    def heal(self):
        self._field.lose(0)

    def repeat(self, times, steps):
        for _ in range(times):
            self.run(steps)


def figures(ledgers):
    """One line for each link: what became of the notes, and how long they took."""
    lives = [life for text in ledgers.values() for life in judge.read_ledger(text)]
    for node in ledgers:
        mine = [life for life in lives if life.node == node]
        for to in sorted({event["to"] for life in mine for event in life.of("intent")}):
            starts = {(life.life, e.number("id")): e.time for life in mine for e in life.of("intent") if e["to"] == to}
            delays = sorted((e.time - starts[e.number("life"), e.number("id")]) * 1e-6
                            for life in lives if life.node == to for e in life.of("delivered")
                            if e["from"] == node and (e.number("life"), e.number("id")) in starts)
            total = collections.Counter()
            for life in mine:
                total.update(life.counters(to) or {})
            yield (f"{node} to {to}: lives {len(mine)}, accepted {total['accepted']}, delivered {total['delivered']}, "
                   f"expired {total['expired']}, in doubt {total['in_doubt']}, resent {total['resent']}"
                   + (f", delay p50 {delays[len(delays) // 2]:.1f} ms, p99 {delays[len(delays) * 99 // 100]:.1f} ms"
                      if delays else ""))


def expectations(wanted, ledgers):
    """`expect` of a scenario: {"expired": N} and {"delivered": N} are the least that must be counted in all."""
    total = collections.Counter()
    for text in ledgers.values():
        for life in judge.read_ledger(text):
            for to in {event["to"] for event in life.of("link")}:
                total.update(life.counters(to))
    return [f"{key}: at least {least} wanted, {total[key]} counted" for key, least in wanted.items()
            if total[key] < least]


def states_seen(wanted, ledgers):
    """`states` of a scenario: {node: {other: [state, ...]}} as the node's last life saw the other from its first UP on."""
    wrong = []
    for node, others in wanted.items():
        lives = judge.read_ledger(ledgers[node])
        for other, states in others.items():
            seen = [e["state"] for life in lives[-1:] for e in life.of("peer") if e["node"] == other]
            seen = seen[seen.index("UP"):] if "UP" in seen else []
            if seen != states:
                wrong.append(f"{node} saw {other} as {seen}, not {states}")
    return wrong


def run(options):
    scenario = json.loads(pathlib.Path(options.scenario, "scenario.json").read_text())
    with field.Field(scenario["nodes"]) as ground:
        return run_in(ground, scenario, options)


def run_in(ground, scenario, options):
    """Runs it in a field that is there: namespaces or containers."""
    fleet = Fleet(ground, options.ledger_node, options.transport, scenario["nodes"])
    began = time.monotonic()
    for node in scenario["nodes"]:
        fleet.start(node)
    Faults(fleet).run(scenario["faults"])
    wrong = fleet.wait_until_settled(scenario["limit_s"])
    seconds = time.monotonic() - began
    bytes_sent = {node: ground.traffic(node)[0] for node in scenario["nodes"]}
    # Before the stop, which the others see as LOST.
    wrong += states_seen(scenario.get("states", {}), fleet.ledgers())
    wrong += fleet.stop()
    ledgers = fleet.ledgers()
    if options.keep:
        shutil.copytree(ground.folder, options.keep, dirs_exist_ok=True)
    for line in figures(ledgers):
        print(line)
    print(f"{seconds:.0f} s; bytes sent: " + ", ".join(f"{node} {count}" for node, count in bytes_sent.items()))
    return wrong + judge.judge(ledgers.values()) + expectations(scenario.get("expect", {}), ledgers)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--ledger-node", required=True)
    parser.add_argument("--transport", default="fastdds")
    parser.add_argument("--keep", help="copy the ledgers into this folder")
    parser.add_argument("scenario")
    try:
        wrong = run(parser.parse_args())
    except field.Unsupported as reason:
        print(f"skipped: {reason}")
        sys.exit(SKIPPED)
    for text in wrong[:50]:
        print("WRONG " + text)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
