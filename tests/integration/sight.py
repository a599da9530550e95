"""What a node has done and seen so far, by its ledger as it grows."""

import collections

import judge


class Sight:
    """Follows a ledger without reading any line twice. Only `total`, `heard_of` and `problems` are of all lives."""

    def __init__(self, path):
        self._path = path
        self._offset = 0
        self.total = collections.Counter()  # kind -> lines
        self.heard_of = set()  # nodes of which anything arrived
        self.problems = []  # reasons
        self.await_life()

    def await_life(self):
        """Forgets the newest life, which was killed, until the next one begins."""
        self._begin(0)

    def _begin(self, time):
        self.begun = time  # 0: no life yet
        self.in_life = collections.Counter()  # kind -> lines
        self.links = {}  # (node, queue) -> counters
        self.peers = {}  # node -> its state of presence
        self.poses = {}  # node -> time of its newest tick
        self.states = {}  # (node, message) -> the event of its newest State
        self.posted = collections.Counter()  # message -> number of its own newest State
        self.accepted = collections.Counter()  # node -> commands
        self.refused = collections.Counter()  # node -> commands refused after one was accepted
        self.outcomes = collections.defaultdict(list)  # node -> [(id, outcome)]
        self.strange_samples = 0  # more than 0 once a sample of a program that is no node was refused

    def read(self):
        if not self._path.exists():
            return
        with open(self._path, "rb") as file:
            file.seek(self._offset)
            lines, newline, _ = file.read().rpartition(b"\n")
        self._offset += len(lines) + len(newline)
        for event in filter(None, map(judge.read_line, (lines + newline).decode().splitlines(keepends=True))):
            self._follow(event)

    def _follow(self, event):
        if event.kind == "start":
            self._begin(event.time)
        self.in_life[event.kind] += 1
        self.total[event.kind] += 1
        follow = getattr(self, "_on_" + event.kind, None)
        if follow:
            follow(event)

    def _on_link(self, event):
        self.links[event["to"], event.values.get("queue", judge.NOTES)] = judge.counters_of(event)

    def _on_peer(self, event):
        self.heard_of.add(event["node"])
        self.peers[event["node"]] = event["state"]

    def _on_tick(self, event):
        self.heard_of.add(event["from"])
        self.poses[event["from"]] = event.time

    def _on_state(self, event):
        self.heard_of.add(event["from"])
        self.states[event["from"], event["message"]] = event

    def _on_delivered(self, event):
        self.heard_of.add(event["from"])

    def _on_state_posted(self, event):
        self.posted[event["message"]] = event.number("number")

    def _on_accepted(self, event):
        self.accepted[event["to"]] += 1

    def _on_refused(self, event):
        self.refused[event["to"]] += self.accepted[event["to"]] > 0

    def _on_outcome(self, event):
        self.outcomes[event["to"]].append((event.number("id"), event["is"]))

    def _on_problem(self, event):
        self.problems.append(event["reason"])

    def _on_topic(self, event):
        self.strange_samples += event.number("refused") if event["from"] == "" else 0


def not_met(sights, nodes, ticking=()):
    """What is missing until each node shows each other one UP, and a pose of its newest life if both are among `ticking`."""
    missing = []
    for node, other in pairs(nodes):
        shown = sights[node].peers.get(other, "not at all")
        if shown != "UP":
            missing.append(f"{node} shows {other} {shown}")
        if {node, other} <= set(ticking) and not 0 < sights[other].begun < sights[node].poses.get(other, 0):
            missing.append(f"{node} has no pose of this life of {other}")
    return missing


def old_states(sights, nodes):
    """What is missing until each node shows the newest of each State of each other one."""
    missing = []
    for node, other in pairs(nodes):
        for message, number in sights[other].posted.items():
            shown = sights[node].states.get((other, message))
            if shown is None or shown.time <= sights[other].begun:
                missing.append(f"{node} has no {message} of this life of {other}")
            elif shown.number("number") != number:
                missing.append(f"{node} shows {message} {shown['number']} of {other}, which posted {number}")
    return missing


def strayed(sights, groups):
    """What passed from a node of one group to one of another, in any life."""
    return [f"{node} heard of {other}" for group in groups for node in group for other in sorted(sights[node].heard_of)
            if any(other in apart for apart in groups if apart is not group)]


def pairs(nodes):
    return [(node, other) for node in nodes for other in nodes if node != other]
