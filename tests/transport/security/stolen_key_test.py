#!/usr/bin/env python3
"""What somebody gets with the keys of uav2, in whole nodes, in a fleet of uav1 and ground: what uav2 may, in its name,
and nothing in another's. First each of it is done to nodes without keys, to show that it works where the door is open.

Usage: stolen_key_test.py RABIT LEDGER_NODE TRANSPORT...
Prints for each case who said what. A ledger is what a node writes down (../../integration/README.md)."""

import contextlib
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
CONFIG = """node: {name}
domain: {domain}
transport: {transport}
publish:
  - {{message: Tick, type: Ledger::Tick, qos: telemetry}}
subscribe:
  - {{message: Tick, type: Ledger::Tick}}
accept:
  - {{queue: Notes, types: [Ledger::Note], from: [ground]}}
"""
# That a node left, or is another one now: one that falls silent was heard more than 3 s before it is LOST.
LEFT = r"peer node={} state=LOST heard_s=([0-2](\.\d+)?|\S+e-\d+)"
WARNINGS = re.compile("rabit: warning: (.*)")


class Node:
    """A running node, its ledger and what it said."""

    def __init__(self, case, name, transport, *options, env=None):
        self.case, self.name, self.transport = case, name, transport
        self.ledger = case.folder / f"{len(case.started)}.ledger"
        self.ledger.touch()
        self.process = case.processes.start(
            [case.ledger_node, "--node", name, "--transport", transport, "--domain", case.domain, "--interface",
             "127.0.0.1", "--ledger", self.ledger, *options], env=env)
        case.started.append(self)

    def lines(self):
        return [line.partition(" ")[2] for line in self.ledger.read_text(encoding="utf-8").split("\n")[:-1]]

    def find(self, pattern):
        return [line for line in self.lines() if re.fullmatch(pattern, line)]

    def wait_for(self, pattern, more_than=0):
        """Lines of the ledger, once there are more than so many."""
        with contextlib.suppress(AssertionError):  # told below
            harness.until(lambda: len(self.find(pattern)) > more_than or not self.process.running(), LIMIT_S)
        lines = self.find(pattern)
        if len(lines) > more_than:
            return lines
        raise AssertionError(f"{self.name} did not write `{pattern}`, but {self.lines()[-12:]}, and said {self.said()[-6:]}")

    def said(self):
        found = (WARNINGS.fullmatch(text) for _, text in self.process.lines)
        return [match.group(1) for match in found if match]

    def says(self, pattern):
        """Waits until it does."""
        return self.process.wait_for(re.compile(f"rabit: warning: (.*{pattern}.*)").fullmatch, LIMIT_S)[1].group(1)


class Case:
    """A fleet of its own; `act` makes what is tried."""

    def __init__(self, programs, domain, transports, act, secured):
        self.rabit, self.ledger_node = programs
        self.domain, self.transports, self.act, self.secured = domain, transports, act, secured
        self.failure = None
        self.noted = []
        self.started = []

    def __str__(self):
        keys = "With the keys of uav2 over" if self.secured else "Without keys over"
        return (f"{keys} {self.transports['uav2']} somebody {self.act.__doc__} uav1 is over {self.transports['uav1']}, "
                f"ground over {self.transports['ground']}:")

    def run(self):
        try:
            with tempfile.TemporaryDirectory() as folder, harness.Processes() as self.processes:
                self.folder = pathlib.Path(folder)
                if self.secured:
                    self.make_keys()
                self.act(self)
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)

    def run_keys(self, *words):
        done = subprocess.run([self.rabit, "keys", *map(str, words)], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise AssertionError(f"{words}: {done.stdout}{done.stderr}")

    def make_keys(self):
        self.run_keys("init", self.folder / "keys")
        for name, transport in self.transports.items():
            config = self.folder / f"{name}.yaml"
            config.write_text(CONFIG.format(name=name, transport=transport, domain=self.domain))
            self.run_keys("add", name, "--keys", self.folder / "keys", "--config", config)

    def node(self, name, *options):
        """One with its own keys."""
        own = ["--keys", self.folder / "keys" / name] if self.secured else []
        return Node(self, name, self.transports[name], *own, *options)

    def thief(self, name, *options):
        """One that calls itself so, with the keys of uav2."""
        stolen = ["--stolen", self.folder / "keys" / "uav2"] if self.secured else []
        return Node(self, name, self.transports["uav2"], *stolen, *options)

    def note(self, who, line):
        self.noted.append(f"{who.transport}: {line}")


def meet(*nodes):
    for node in nodes:
        for other in nodes:
            if other is not node:
                node.wait_for(f"peer node={other.name} state=UP .*")


def never(node, *patterns):
    found = [line for pattern in patterns for line in node.find(pattern)]
    if found:
        raise AssertionError(f"{node.name} wrote {found[:5]}")


def life_of(node):
    return re.search(r"life=(\d+)", node.wait_for("start node=.*")[0]).group(1)


def exchange(case):
    """uav1 and ground, which send each other notes; uav1 takes them of ground alone."""
    endless = ["--count", 1000000, "--rate", 20]
    uav1 = case.node("uav1", "--accept-from", "ground", "--to", "ground", *endless)
    ground = case.node("ground", "--ticks", "--to", "uav1", *endless)
    meet(uav1, ground)
    return uav1, ground


def goes_on(uav1, ground):
    """Whatever was tried has not come between them."""
    for node, other in ((uav1, "ground"), (ground, "uav1")):
        delivered = f"delivered from={other} .*"
        node.wait_for(delivered, len(node.find(delivered)) + 10)
        harness.until(lambda node=node, other=other: " state=UP " in node.find(f"peer node={other} .*")[-1], LIMIT_S)
        never(node, LEFT.format(other), "problem .*live node.*")


NOTES = ["--to", "uav1", "--count", 1000000, "--rate", 50]


def says_it_is_ground(case):
    """says that it is ground, beats so, sends notes so, and says goodbye so;"""
    if not case.secured:
        uav1 = case.node("uav1", "--accept-from", "ground")
        thief = case.thief("ground", *NOTES)
        uav1.wait_for(f"delivered from=ground life={life_of(thief)} .*")
        return
    uav1, ground = exchange(case)
    thief = case.thief("ground", *NOTES)
    thief.wait_for("peer node=uav1 state=UP .*")
    # No node answers the thief, but it hears the answers to a newcomer.
    case.node("uav3")
    thief.wait_for("accepted to=uav1 .*", 20)
    uav1.wait_for("malformed count=.*", 4)
    case.note(uav1, uav1.says("calls itself ground and has not the keys of ground"))
    life = life_of(thief)
    thief.process.terminate()
    goes_on(uav1, ground)
    never(uav1, f"delivered from=ground life={life} .*")
    never(thief, "outcome .* is=\"delivered\"")


def says_it_is_uav1(case):
    """says that it is uav1, beats so, posts so, and says goodbye so;"""
    if not case.secured:
        ground = case.node("ground", "--ticks")
        case.thief("uav1", "--ticks")
        ground.wait_for("tick from=uav1 .*")
        return
    uav1, ground = exchange(case)
    thief = case.thief("uav1", "--ticks")
    refused = ground.wait_for("topic message=Tick from= .*refused=[1-9].*", 2)
    case.note(ground, "Gateway/Fleet: " + refused[-1])
    case.note(ground, ground.says("calls itself uav1 and has not the keys of uav1"))
    thief.process.terminate()
    goes_on(uav1, ground)
    never(ground, "tick from=uav1 .*")


def does_not_ask(case):
    """calls itself uav2 and has notes on their way to who takes none of uav2 by then;"""
    uav1 = case.node("uav1")
    thief = case.thief("uav2", *NOTES)
    uav1.wait_for("delivered from=uav2 .*", 10)
    uav1.process.kill()
    thief.wait_for("peer node=uav1 state=LOST .*")
    thief.wait_for("accepted to=uav1 .*", len(thief.find("accepted to=uav1 .*")) + 50)
    uav1, ground = exchange(case)
    refused = thief.wait_for("outcome to=uav1 .* is=\"refused\"", 10)
    case.note(thief, "itself: " + refused[-1])
    case.note(uav1, uav1.says("uav2 sends messages to queue `Notes`, which accepts none of it"))
    goes_on(uav1, ground)
    never(uav1, "delivered from=uav2 .*")


def is_uav2(case):
    """calls itself uav2 and does what uav2 may;"""
    uav1, ground = exchange(case)
    thief = case.thief("uav2", "--ticks", "--to", "ground", *NOTES)
    ground.wait_for(f"delivered from=uav2 life={life_of(thief)} .*", 10)
    ground.wait_for("tick from=uav2 .*", 10)
    thief.wait_for("refused to=uav1 .*")
    problem = thief.wait_for("problem node=uav1 .*accepts no messages of this node.*")
    case.note(thief, "itself: " + problem[-1])
    goes_on(uav1, ground)
    never(uav1, "delivered from=uav2 .*")


def main():
    programs, transports = sys.argv[1:3], sys.argv[3:]
    harness.enter_namespace()
    fleets = [{"uav1": first, "ground": second, "uav2": thief, "uav3": first}
              for thief in transports for first, second in zip(transports, reversed(transports))]
    failures = number = 0
    for act, secured in ((says_it_is_ground, False), (says_it_is_uav1, False), (says_it_is_ground, True),
                         (says_it_is_uav1, True), (does_not_ask, True), (is_uav2, True)):
        cases = [Case(programs, (harness.domain() + 3 * (number + i)) % 180, fleet, act, secured)
                 for i, fleet in enumerate(fleets)]
        number += len(cases)
        harness.run_at_once(cases)
        for case in cases:
            print(f"{case} {case.failure or 'as it should be'}")
            for line in case.noted:
                print(f"    {line}")
            failures += 1 if case.failure else 0
    print(f"{number} cases, {failures} failed")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
