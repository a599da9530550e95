"""Ledger nodes with keys: a fleet for each case, in a domain of its own. A ledger is what a node writes down
(../../integration/README.md)."""

import contextlib
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integration"))
import fleet_keys  # noqa: E402
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
ENDLESS = ["--count", 1000000, "--rate", 20]


class Node:
    """A running node and its ledger."""

    def __init__(self, case, name, *options, keys=None, env=None):
        self.name = name
        self.ledger = case.folder / f"{len(case.started)}.ledger"
        self.ledger.touch()
        self.process = case.processes.start(
            [case.ledger_node, "--node", name, "--transport", case.transports[name], "--domain", case.domain, "--interface",
             "127.0.0.1", "--ledger", self.ledger, *(["--keys", keys] if keys else []), *options], env=env)
        case.started.append(self)

    def events(self):
        """(CLOCK_MONOTONIC in ns, text) of each line."""
        lines = self.ledger.read_text(encoding="utf-8").split("\n")[:-1]
        # A life begins with an empty line.
        return [(int(when), text) for when, _, text in (line.partition(" ") for line in lines if line)]

    def lines(self):
        return [text for _, text in self.events()]

    def find(self, pattern):
        return [line for line in self.lines() if re.fullmatch(pattern, line)]

    def wait_for(self, pattern, more_than=0):
        """Lines of the ledger, once there are more than so many."""
        with contextlib.suppress(AssertionError):  # told below
            harness.until(lambda: len(self.find(pattern)) > more_than or not self.process.running(), LIMIT_S)
        lines = self.find(pattern)
        if len(lines) > more_than:
            return lines
        raise AssertionError(f"{self.name} did not write `{pattern}`, but {self.lines()[-12:]}, and said "
                             f"{[text for _, text in self.process.lines[-6:]]}")

    def never(self, *patterns):
        found = [line for pattern in patterns for line in self.find(pattern)]
        if found:
            raise AssertionError(f"{self.name} wrote {found[:5]}")

    def says(self, text):
        """Waits until it has this problem."""
        self.wait_for(f"problem .*reason=\".*{re.escape(text)}.*")

    def state_of(self, other):
        """UP, STALE or LOST; None: it was never heard of."""
        lines = self.find(f"peer node={other} .*")
        return re.search(r"state=(\w+)", lines[-1]).group(1) if lines else None


class Case:
    """A fleet of its own, {node: backend}, of which `outsiders` get no keys. `act(case)` does what is tried."""

    def __init__(self, programs, domain, transports, act, outsiders=()):
        self.rabit, self.ledger_node = programs
        self.domain, self.transports, self.act = domain, transports, act
        self.keyed = [node for node in transports if node not in outsiders]
        self.keys, self.started = {}, []
        self.folder = self.processes = self.failure = None

    def __str__(self):
        return f"{self.act.__doc__}, {' '.join(f'{node}:{transport}' for node, transport in self.transports.items())}"

    def run(self):
        try:
            with tempfile.TemporaryDirectory() as folder, harness.Processes() as self.processes:
                self.folder = pathlib.Path(folder)
                if self.keyed:
                    self.keys = fleet_keys.make(self.rabit, self.folder, self.keyed)
                self.act(self)
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)

    def run_keys(self, *words):
        done = subprocess.run([self.rabit, "keys", *map(str, words)], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise AssertionError(f"{words}: {done.stdout}{done.stderr}")

    def node(self, name, *options, env=None):
        """One with its own keys, which posts ticks."""
        return Node(self, name, "--ticks", *options, keys=self.keys.get(name), env=env)

    def talkers(self, *names, env_of=lambda name: None):
        """Nodes that send each other notes without end, once they have met."""
        nodes = [self.node(name, *(word for other in names if other != name for word in ("--to", other)), *ENDLESS,
                           env=env_of(name)) for name in names]
        meet(*nodes)
        return nodes


def meet(*nodes):
    for node in nodes:
        for other in nodes:
            if other is not node:
                node.wait_for(f"peer node={other.name} state=UP .*")


def exchange(*nodes, count=20):
    """Each gets so many more notes and ticks of each."""
    awaited = [(node, pattern, len(node.find(pattern)) + count) for node in nodes for other in nodes if other is not node
               for pattern in (f"delivered from={other.name} .*", f"tick from={other.name} .*")]
    for node, pattern, more_than in awaited:
        node.wait_for(pattern, more_than)


def once_and_in_order(*nodes):
    """No note came twice, or before an earlier one of its life."""
    for node in nodes:
        last = {}
        for line in node.find("delivered .*"):
            sender, number = re.match(r"delivered from=(\S+ life=\d+) id=(\d+)", line).groups()
            if int(number) <= last.get(sender, 0):
                raise AssertionError(f"{node.name}: note {number} of {sender} came after note {last[sender]}")
            last[sender] = int(number)


def run(cases):
    """Runs all at once, prints what became of each, and returns how many failed."""
    harness.run_at_once(cases)
    for case in cases:
        print(f"{case}: {case.failure or 'as it should be'}")
    return sum(1 for case in cases if case.failure)
