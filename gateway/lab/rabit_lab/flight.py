"""What happened during a run, by the lab's clock: seconds since the fleet was started. Faults, processes, and what the nodes'
recordings tell."""

import bisect
import collections
import dataclasses
import typing

FOREVER = float("inf")


@dataclasses.dataclass
class Life:
    """One process of a node."""
    node: str
    number: int  # from 1
    began: float
    clock_step: int = 0  # seconds by which its wall clock was ahead when it began
    ended: typing.Optional[float] = None
    code: typing.Optional[int] = None
    by: str = ""  # what ended it: itself, kill, stop, end
    incarnation: typing.Optional[str] = None
    recorded: bool = False
    last_lines: list = dataclasses.field(default_factory=list)

    def is_there(self, time):
        return self.began <= time and (self.ended is None or time < self.ended)


@dataclasses.dataclass
class Fault:
    """A time in which something was done to the fleet."""
    began: float
    ended: float
    verb: str
    nodes: list  # those that it concerns; empty: all
    text: str

    def concerns(self, *nodes):
        """True if it was done to one of them; a fault of links, if to the link between them."""
        which = all if self.verb in ("loss", "delay", "deaf") else any
        return not self.nodes or which(node in self.nodes for node in nodes)


@dataclasses.dataclass
class Sent:
    """What became of a `send`."""
    outcome: str  # delivered, expired, in doubt, refused; empty: none came
    seconds: float
    reason: str


class Changes:
    """Values that hold from a time on."""

    def __init__(self):
        self.times = []
        self.values = []

    def put(self, time, value):
        at = bisect.bisect_right(self.times, time)
        self.times.insert(at, time)
        self.values.insert(at, value)

    def at(self, time):
        found = bisect.bisect_right(self.times, time) - 1
        return self.values[found] if found >= 0 else None

    def since(self, time):
        """(time, value): the one that holds at that time, and those that follow."""
        first = max(bisect.bisect_right(self.times, time) - 1, 0)
        return list(zip(self.times[first:], self.values[first:]))


@dataclasses.dataclass
class PeerState:
    state: str
    incarnation: str
    reason: str


class Flight:
    """All that is known of a run."""

    def __init__(self, scenario):
        self.scenario = scenario
        self.end = scenario.run  # when the fleet was told to end
        self.lives = []
        self.faults = []
        self.peers = collections.defaultdict(Changes)  # (life index, other node) -> PeerState
        self.values = collections.defaultdict(list)  # (life index, origin, message) -> [(arrived, posted)]
        self.newest = collections.defaultdict(dict)  # life index -> {(origin, message): when its last value was posted}
        self.problems = []  # [node, subject, other, reason, since, until]
        self.logs = []  # (time, node, level, text): what nodes logged and recorded
        self.output = []  # (time, node, text)
        self.air = collections.defaultdict(list)  # node -> [(time, used, budget, capacity)]
        self.published = collections.defaultdict(list)  # (life index, message) -> [(time, posts, those that a newer one replaced)]
        self.outcomes = collections.defaultdict(collections.Counter)  # (node, other node, queue) -> {outcome: messages}
        self.radio = collections.defaultdict(list)  # network -> [(time, counters)]
        self.lateness = {}  # network -> the radio program's own lateness, at the end
        self.census = {}  # network -> kinds of frames, at the end
        self.positions = collections.defaultdict(list)  # node -> [(time, (x, y, z))] in metres
        self.distant = []  # (time, from, to, percent): changes of loss by distance, and each second while it is high
        self.sent = {}  # event -> Sent
        self.pauses = []  # (from, to) in which the machine stood still
        self.notes = []  # of the lab about itself
        self.about = {}  # node -> {"domain": ..., "transport": ...}

    def events(self):
        """What was done to the fleet, by time."""
        return sorted(self.faults, key=lambda fault: fault.began)

    def lives_of(self, node):
        return [life for life in self.lives if life.node == node]

    def life_at(self, node, time):
        for life in self.lives_of(node):
            if life.is_there(time):
                return life
        return None

    def observers(self, node):
        """Lives of other nodes that share a network with it and have recorded."""
        return [(index, life) for index, life in enumerate(self.lives)
                if life.recorded and life.node != node and self.scenario.share_network(node, life.node)]

    def last_fault(self, time, *nodes):
        """The fault of these nodes that began last before a time, or none."""
        before = [fault for fault in self.faults
                  if fault.began <= time and fault.verb != "send" and fault.concerns(*nodes)]
        return max(before, key=lambda fault: fault.began, default=None)

    def disturbed(self, begin, end, *nodes):
        """The fault of these nodes that explains silence in that time, or none."""
        for fault in self.faults:
            if fault.verb not in ("clock", "disk", "send", "start") and fault.concerns(*nodes) \
                    and fault.began <= end and fault.ended >= begin:
                return fault
        return None

    def out_of_range(self, begin, end, *nodes):
        """True if distance took half of the frames between two nodes, or more, at some time."""
        return any(begin <= time <= end and one in nodes and other in nodes and percent >= 50
                   for time, one, other, percent in self.distant)

    def frozen(self, node):
        return [(fault.began, fault.ended) for fault in self.faults if fault.verb == "freeze" and node in fault.nodes]

    def take(self, fact, life_index, to_lab):
        """One fact of lab_facts (facts/FlightFile.h); `to_lab` converts its times."""
        life = self.lives[life_index]
        life.recorded = True
        kind = fact["fact"]
        time = to_lab(fact["t"]) if "t" in fact else None
        if kind == "self":
            life.incarnation = fact["incarnation"]
        elif kind == "peer":
            state = PeerState(fact["state"], fact["incarnation"], fact["reason"])
            self.peers[life_index, fact["of"]].put(time, state)
        elif kind == "values":
            pairs = list(zip(map(to_lab, fact["at"]), map(to_lab, fact["posted"])))
            self.values[life_index, fact["node"], fact["message"]].extend(pairs)
            if pairs:
                self.newest[life_index][fact["node"], fact["message"]] = pairs[-1][1]
        elif kind == "problem":
            self.problems.append([life.node, fact["subject"], fact["node"], fact["reason"], time, None])
        elif kind == "solved":
            for problem in self.problems:
                if problem[:4] == [life.node, fact["subject"], fact["node"], fact["reason"]] and problem[5] is None:
                    problem[5] = time
        elif kind == "log":
            self.logs.append((time, life.node, fact["level"], str(fact["text"])))
        elif kind == "about":
            self.about[life.node] = {"domain": fact["domain"], "transport": fact["transport"]}
        elif kind == "publication":
            self.published[life_index, fact["message"]].append((time, fact["offered"], fact["replaced"]))
        elif kind == "outcome":
            self.outcomes[life.node, fact["node"], fact["queue"]][fact["outcome"]] += 1
        elif kind == "air":
            self.air[life.node].append((time, fact["used"], fact["budget"], fact["capacity"]))

    def ages(self, observer, origin, message, begin, end, since=0.0):
        """How old `origin`/`message` was at the observer: [(from, to, age at the beginning)]. Ages grow by 1 s each second.
        Before the first value of a life the age is the time that the life has waited, from `since` on. Times without the
        observer are left out."""
        pieces = []
        for index, life in enumerate(self.lives):
            if life.node != observer or not life.recorded:
                continue
            values = sorted(self.values.get((index, origin, message), []))
            waits = max(life.began, since)
            marks = [(waits, waits)] + values
            last = min(life.ended if life.ended is not None else FOREVER, end)
            for (at, posted), (until, _) in zip(marks, marks[1:] + [(last, 0)]):
                start, stop = max(at, begin), min(until, last)
                for first, second in without(self.frozen(observer), start, stop):
                    pieces.append((first, second, first - posted))
        return pieces

    def arrivals(self, observer, origin, message, begin, end):
        """(number of values, seconds in which the observer was there)"""
        count, there = 0, 0.0
        for index, life in enumerate(self.lives):
            if life.node == observer and life.recorded:
                first, last = max(begin, life.began), min(end, life.ended if life.ended is not None else FOREVER)
                there += sum(b - a for a, b in without(self.frozen(observer), first, last))
                count += sum(first <= at < last for at, _ in self.values.get((index, origin, message), []))
        return count, there


def without(gaps, begin, end):
    """The parts of a time that lie in no gap."""
    parts = [(begin, end)] if end > begin else []
    for first, last in gaps:
        parts = [(a, b) for p, q in parts for a, b in ((p, min(q, first)), (max(p, last), q)) if b > a]
    return parts


def age_below(pieces, share):
    """The age that was not exceeded for that share of the time, in s. Each piece passes through its ages at 1 s each second."""
    left = share * sum(last - first for first, last, _ in pieces)
    if left <= 0:
        return None
    edges = sorted([(age, 1) for _, _, age in pieces] + [(age + last - first, -1) for first, last, age in pieces])
    passing, before = 0, edges[0][0]
    for age, change in edges:
        if passing * (age - before) >= left:
            return before + left / passing
        left -= passing * (age - before)
        passing, before = passing + change, age
    return before


def oldest(pieces):
    """(age, time) of the oldest moment."""
    return max(((age + last - first, last) for first, last, age in pieces), default=(None, None))
