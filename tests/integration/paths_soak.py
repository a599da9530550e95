#!/usr/bin/env python3
"""A ground station and two aircraft with two radios each, a mesh and a modem with a budget, for an hour. The mesh loses
packets, is cut, and flaps; both are cut; and the programs of a node are killed and start again, in turn, one a minute.

On each node run a ledger node, which exchanges commands both ways, and a node that records itself; the aircraft post and the
ground station requests what it missed. Judged are outcomes alone: no command is lost, comes twice or out of order; each post in a
recording of an aircraft is in that of the ground station, once, byte for byte; the modem carries no more than the budgets.

Usage: paths_soak.py PROGRAMS [--seconds N] [--keys RABIT] [--transport MESH[,MODEM]]...
Several --transport fly at once, each in a network of its own. Exit code 0: as it has to be; 1: something is wrong; 77: this
machine does not allow it."""

import argparse
import itertools
import pathlib
import sys
import threading
import time

import field
import fleet_keys
import harness
import judge
import paths_test
import run_scenario

sys.path.insert(0, str(harness.ROOT / "tests/gateway/backfill"))
import backfill_fleet  # noqa: E402  pylint: disable=wrong-import-position

NODES = ["ground", "uav1", "uav2"]
AIRCRAFT = NODES[1:]
MODEM_KBIT = 1000
BUDGET = 8000  # bytes a second on the modem, of each of the two programs of a node
LOSS = 10  # percent, of the mesh
RATE = 5  # commands a second, each way
POSTS = ["--rate", "10"]
MINUTE_S = 60
SETTLE_S = 300
MEETING_S = 5

ETHERNET = 14  # bytes of each packet that are no part of a budget
WINDOW_S = 10  # a budget holds in any second; the counters are read a little late now and then
BEYOND = 1.05


class Recorders(backfill_fleet.Fleet):
    """The programs that record themselves, with both radios."""

    def __init__(self, ground, programs, transports, rabit):
        super().__init__(ground, programs, transports["mesh"], ground.folder)
        self._transports, self._rabit = transports, rabit

    def write(self, node, more=""):
        super().write(node, more)
        if self._rabit:
            fleet_keys.add(self._rabit, self.folder, node)

    def network(self, node):
        security = f"security: {{keys: {fleet_keys.of(self.folder, node)}}}\n" if self._rabit else ""
        return security + "paths:\n" + "".join(
            f"  - {{name: {name}, interfaces: [{device}], transport: {self._transports[name]}"
            + (f", radio: {{budget: {BUDGET}B/s}}" if name == "modem" else "") + "}\n"
            for name, device in paths_test.DEVICES.items())

    def fly(self, node):
        return self.start(node, *(POSTS if node != "ground" else []))


class Modem(threading.Thread):
    """Reads once a second how much each node has sent on the modem."""

    def __init__(self, ground):
        super().__init__(daemon=True)
        self._ground = ground
        self._read = {node: [] for node in NODES}  # (time, bytes of IP)
        self._over = threading.Event()
        self.start()

    def run(self):
        while not self._over.wait(1):
            for node, read in self._read.items():
                before = time.monotonic()
                packets = self._ground.sent(node, "eth1", "packets")
                read.append((before, self._ground.sent(node, "eth1") - ETHERNET * packets, time.monotonic()))

    def end(self):
        """What is wrong, and the most bytes a second of each node."""
        self._over.set()
        self.join()
        wrong, most = [], {}
        for node, read in self._read.items():
            for earlier, later in zip(read, read[WINDOW_S:]):
                # The time that may have passed, and a second more: a program that starts has a budget of its own.
                seconds = later[2] - earlier[0]
                sent = later[1] - earlier[1]
                most[node] = max(most.get(node, 0), round(sent / (later[0] - earlier[0])))
                if sent > 2 * BUDGET * (seconds + 1) * BEYOND:
                    wrong.append(f"{node} sent {sent} bytes on the modem in {seconds:.1f} s; its budgets are {2 * BUDGET} B/s")
        return wrong, most


class Flight:
    """All programs on the nodes, and their faults."""

    def __init__(self, ground, programs, transports, seconds, rabit):
        self.ground = ground
        self._until = time.monotonic() + seconds
        self._paths = [word for name, device in paths_test.DEVICES.items() for word in
                       ("--path", f"{name}:{transports[name]}:{device}" + (f":{BUDGET}" if name == "modem" else ""))]
        self._keys = fleet_keys.make(rabit, ground.folder, [self.orders(node) for node in NODES]) if rabit else {}
        self._scenario = {"nodes": {self.orders(node): [] for node in NODES},
                          "inside": {self.orders(node): node for node in NODES}}
        self.ledgers = run_scenario.Fleet(ground, pathlib.Path(programs, "ledger_node"), transports["mesh"], self._scenario)
        self.recorders = Recorders(ground, programs, transports, rabit)
        for node in NODES:
            self.recorders.write(node)
            self.start(node)

    @staticmethod
    def orders(node):
        """The name of its ledger node."""
        return node + ".orders"

    def start(self, node):
        left_s = max(1.0, self._until - time.monotonic())
        to = [word for other in (AIRCRAFT if node == "ground" else ["ground"]) for word in ("--to", self.orders(other))]
        self._scenario["nodes"][self.orders(node)] = [*self._paths, *fleet_keys.arguments(self._keys, self.orders(node)), *to,
                                                      "--count", str(int(RATE * left_s)), "--rate", str(RATE)]
        self.ledgers.start(self.orders(node))
        self.recorders.fly(node)

    def kill(self, node):
        self.ground.kill(node)
        self.ledgers.kill(self.orders(node))
        time.sleep(3)
        self.start(node)

    def cut(self, *names, seconds):
        self.ground.cut_network(*names)
        time.sleep(seconds)
        self.ground.heal_network()

    def flap(self):
        for _ in range(8):
            self.cut("mesh", seconds=2)
            time.sleep(2)

    def kill_while_both_are_cut(self, node):
        self.ground.cut_network("mesh", "modem")
        time.sleep(5)
        self.kill(node)
        time.sleep(10)
        self.ground.heal_network()

    def faults(self):
        """Without end: what, and its action. Faults and nodes take turns of their own."""
        for one, other in itertools.cycle(zip(NODES, NODES[1:] + NODES[:1])):
            yield "both cut", lambda: self.cut("mesh", "modem", seconds=25)
            yield f"{one} killed", lambda node=one: self.kill(node)
            yield "mesh cut", lambda: self.cut("mesh", seconds=25)
            yield f"both cut, {other} killed", lambda node=other: self.kill_while_both_are_cut(node)
            yield "mesh flaps", self.flap

    def endure(self):
        """Until the time is over, whole faults alone. Returns their number."""
        time.sleep(MEETING_S)
        self.ground.lose(LOSS)
        for number, (what, act) in enumerate(self.faults()):
            if time.monotonic() + MINUTE_S / 2 > self._until:
                return number
            begin = time.monotonic()
            act()
            print(f"{what}: {number + 1} faults, {self._until - time.monotonic():.0f} s left", flush=True)
            time.sleep(max(0.0, min(begin + MINUTE_S, self._until) - time.monotonic()))

    def settle(self):
        """What is missing of the commands."""
        try:
            self.ledgers.until(self.ledgers.unsettled, SETTLE_S)
        except run_scenario.NeverSeen as never:
            return list(never.args)
        return []

    def posts(self):
        """What is wrong with the recordings of the ground station, and the figures."""
        try:
            figures = self.recorders.wait_until_whole_so_far(AIRCRAFT, SETTLE_S)
        except AssertionError as error:
            return [str(error)], []
        wrong = [f"{row['node']}: {row}" for row in figures if row["twice"] or row["other_bytes"]]
        if not any(row["backfilled"] for row in figures):
            wrong.append("no post came later: the radios were never cut for the recordings")
        return wrong, figures


def read(ledgers):
    for path in ledgers.paths().values():
        with open(path, encoding="ascii") as lines:
            yield from judge.read_ledger(lines)


def soak(programs, transport, seconds, rabit):
    """What is wrong, by what was judged."""
    mesh, modem = (transport.split(",") * 2)[:2]
    verdicts = {}
    with paths_test.TwoNetworks(NODES, MODEM_KBIT) as ground:
        modem_watch = Modem(ground)
        flight = Flight(ground, programs, {"mesh": mesh, "modem": modem}, seconds, rabit)
        faults = flight.endure()
        ground.heal()
        verdicts["settled"] = flight.settle()
        verdicts["posts"], figures = flight.posts()
        verdicts["modem"], most = modem_watch.end()
        verdicts["ended well"] = flight.ledgers.stop()
        lives = list(read(flight.ledgers))
    verdicts["commands"] = judge.judge_lives(lives)
    arrived = sum(len(life.of("delivered")) for life in lives)
    if arrived < RATE * seconds:
        verdicts["commands"].append(f"only {arrived} commands arrived")
    print(f"{faults} faults; {arrived} commands arrived; at most {most} B/s on the modem; posts: {figures}")
    return verdicts


def fly_all(options):
    """A process each, since each makes a network."""
    own = [sys.executable, __file__, options.programs, "--seconds", str(options.seconds),
           *(["--keys", options.keys] if options.keys else [])]
    flights = [harness.Process([*own, "--transport", transport],
                               on_line=lambda text, name=transport: print(f"{name}: {text}", flush=True))
               for transport in options.transport]
    codes = {flight.exit_code(options.seconds + 4 * SETTLE_S) for flight in flights}
    if codes - {0, harness.SKIPPED}:
        return 1
    return max(codes)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", help="folder of ledger_node, backfill_node and backfill_judge")
    parser.add_argument("--seconds", type=int, default=3600)
    parser.add_argument("--keys", metavar="RABIT", help="all programs have keys, which this program makes")
    parser.add_argument("--transport", action="append", required=True, help="of the mesh, and of the modem if that has another")
    options = parser.parse_args()
    if len(options.transport) > 1:
        sys.exit(fly_all(options))
    with field.skipping():
        verdicts = soak(options.programs, options.transport[0], options.seconds, options.keys)
    for name, wrong in verdicts.items():
        print(f"{name}: {'as it has to be' if not wrong else f'{len(wrong)} wrong'}")
        for text in wrong[:20]:
            print("WRONG " + text)
    sys.exit(1 if any(verdicts.values()) else 0)


if __name__ == "__main__":
    main()
