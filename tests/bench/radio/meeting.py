"""How long nodes take to find each other, and to find each other again. Each function makes many tries on one field and
returns p50, p90, p99 and the worst of the times, in s; a try that did not end within the limit counts as infinite.

The times of ledgers and time.monotonic() are of one clock."""

import time

import judge  # found by measures
from figures import percentile
from rows import PLAIN

LIMIT_S = 30
LOOK_S = 0.02


def spread(times, **more):
    """The figures of a list of times."""
    ordered = sorted(times)
    return {"tries": len(ordered), **{f"p{percent}_s": percentile(ordered, percent) for percent in (50, 90, 99)},
            "worst_s": percentile(ordered, 100), "failed": ordered.count(float("inf")), **more}


def wait(seen, limit_s=LIMIT_S):
    """What `seen` returns once that is not None; infinite after the limit."""
    end = time.monotonic() + limit_s
    while time.monotonic() < end:
        found = seen()
        if found is not None:
            return found
        time.sleep(LOOK_S)
    return float("inf")


class Follower:
    """Reads the ledgers of a fleet as they grow, each line once."""

    def __init__(self, fleet):
        self._paths = {node: fleet.ledger(node) for node in fleet.ground.nodes}
        self._offsets = dict.fromkeys(self._paths, 0)
        self.begins = {node: [] for node in self._paths}  # of each incarnation, in ns
        self.outcomes = {}  # node -> time of its first
        self.ticks = []  # (receiver, origin, time in ns, number)
        self.lost = []  # (time in ns, observer, node)

    def read(self):
        for node, path in self._paths.items():
            if not path.exists():
                continue
            with open(path, "rb") as file:
                file.seek(self._offsets[node])
                lines, newline, _ = file.read().rpartition(b"\n")
            self._offsets[node] += len(lines) + len(newline)
            for event in filter(None, map(judge.read_line, (lines + newline).decode().splitlines(keepends=True))):
                self._take(node, event)
        return self

    def _take(self, node, event):
        if event.kind == "start":
            self.begins[node].append(event.time)
        elif event.kind == "outcome":
            self.outcomes.setdefault(node, event.time)
        elif event.kind == "tick":
            self.ticks.append((node, event["from"], event.time, event.number("number")))
        elif event.kind == "peer" and event["state"] == "LOST":
            self.lost.append((event.time, node, event["node"]))

    def first_ticks(self, since=0):
        """{(receiver, origin): time in ns} of the first after that."""
        firsts = {}
        for receiver, origin, when, _ in self.ticks:
            if when > since:
                firsts.setdefault((receiver, origin), when)
        return firsts

    def all_heard_s(self):
        """From the last start until each node has heard each other; None: not yet."""
        nodes, firsts = len(self._paths), self.first_ticks()
        if len(firsts) < nodes * (nodes - 1):
            return None
        return (max(firsts.values()) - max(begins[-1] for begins in self.begins.values())) * 1e-9


def meet(fleet, members, tries):
    """Two nodes start at once: until a command of each was delivered at the other, and both know."""
    return spread([_meet_plain(fleet) if fleet.contestant == PLAIN else _meet(fleet) for _ in range(tries)])


def _meet(fleet):
    fleet.ground.forget_neighbours()
    for node, other in zip(fleet.ground.nodes, reversed(fleet.ground.nodes)):
        fleet.start_ledger(node, "--to", other, "--count", 1, "--rate", 100)
    follower = Follower(fleet)

    def seen():
        if len(follower.read().outcomes) < 2:
            return None
        return (max(follower.outcomes.values()) - max(begins[0] for begins in follower.begins.values())) * 1e-9
    took = wait(seen)
    fleet.stop_ledgers()
    return took


def _meet_plain(fleet):
    """Plain programs have no commands: until each has heard a sample of the other."""
    began = time.monotonic()
    started = [fleet.start_member(node, number, {"members": 2, "period": 20_000_000})
               for number, node in enumerate(fleet.ground.nodes, 1)]

    def seen():
        heard = [next((when for when, text in process.lines if "all_heard_at_ns" in text), None) for process in started]
        return max(heard) - began if all(heard) else None
    took = wait(seen)
    for node in fleet.ground.nodes:
        fleet.ground.kill(node)
    return took


def crowd(fleet, members, tries):
    """All start at once: until each has heard a sample of each other."""
    times = []
    for _ in range(tries):
        fleet.ground.forget_neighbours()
        for node in fleet.ground.nodes:
            fleet.start_ledger(node, "--ticks")
        follower = Follower(fleet)
        times.append(wait(lambda: follower.read().all_heard_s()))
        fleet.stop_ledgers()
    return spread(times)


def restart(fleet, members, tries):
    """The last node starts, again and again, while the others have met: until it has heard a sample of each other, and
    each other one of its own. The others remember its former session."""
    *others, late = fleet.ground.nodes
    for node in others:
        fleet.start_ledger(node, "--ticks")
    follower = Follower(fleet)
    wait(lambda: all((one, other) in follower.read().first_ticks() for one in others for other in others
                     if one != other) or None, 2 * LIMIT_S)
    times = []
    for _ in range(tries):
        fleet.ground.forget_neighbours()
        follower.read().ticks.clear()
        fleet.start_ledger(late, "--ticks")
        ways = [way for other in others for way in ((late, other), (other, late))]

        def met():
            begin = max(follower.read().begins[late], default=float("inf"))
            firsts = follower.first_ticks(begin)
            if not all(way in firsts for way in ways):
                return None
            return (max(firsts[way] for way in ways) - begin) * 1e-9
        times.append(wait(met))
        fleet.ground.kill(late)
    return spread(times)


def back(fleet, members, for_s, tries):
    """One node hears nobody and is not heard for a while. From the end of that until a sample has come, for each of the
    two ways between it and each other node."""
    nodes = fleet.ground.nodes
    for node in nodes:
        fleet.start_ledger(node, "--ticks")
    follower = Follower(fleet)
    wait(lambda: follower.read().all_heard_s(), 2 * LIMIT_S)
    ways = [way for other in nodes[1:] for way in ((nodes[0], other), (other, nodes[0]))]
    times = []
    for _ in range(tries):
        time.sleep(2)
        _cut(fleet, nodes[0], True)
        time.sleep(for_s)
        follower.read().ticks.clear()
        healed = time.monotonic()
        _cut(fleet, nodes[0], False)

        def firsts():
            return follower.read().first_ticks(healed * 1e9)
        wait(lambda: all(way in firsts() for way in ways) or None)
        times += [firsts().get(way, float("inf")) * 1e-9 - healed for way in ways]
    return spread(times)


def _cut(fleet, node, yes):
    for receiver, origin in ((node, "*"), ("*", node)):
        (fleet.ground.deaf if yes else fleet.ground.hear)(receiver, origin)


def churn(fleet, members, seconds, every_s):
    """One node after the other is killed and started again at once. From its start until each other node that lives all
    that time has heard a sample of its new incarnation."""
    nodes = fleet.ground.nodes
    for node in nodes:
        fleet.start_ledger(node, "--ticks")
    follower = Follower(fleet)
    wait(lambda: follower.read().all_heard_s(), 2 * LIMIT_S)
    began = time.monotonic()
    turn = 0
    while time.monotonic() < began + seconds:
        fleet.restart_ledger(nodes[turn % len(nodes)], "--ticks")
        turn += 1
        time.sleep(max(0.0, began + turn * every_s - time.monotonic()))
    time.sleep(LIMIT_S)
    return spread(heard_of_incarnations(follower.read()), lost=sum(when * 1e-9 > began for when, _, _ in follower.lost))


def heard_of_incarnations(follower):
    """Seconds from each later start of a node until each other node heard it; infinite where it never did."""
    times = []
    for origin, begins in follower.begins.items():
        for begin, end in zip(begins[1:], [*begins[2:], float("inf")]):
            for observer, lives in follower.begins.items():
                if observer == origin or lives[0] > begin:
                    continue
                heard = min((when for receiver, node, when, _ in follower.ticks
                             if (receiver, node) == (observer, origin) and begin < when < end), default=float("inf"))
                restarted = min((life for life in lives if begin < life < end), default=float("inf"))
                if heard < restarted or restarted == float("inf"):
                    times.append((heard - begin) * 1e-9)
    return times
