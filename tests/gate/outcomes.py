"""What the nodes of a smoke test have seen, and what they still have to see. All functions read the ledgers of
../integration/README.md as they are now; none knows a time limit. Each returns what is missing or wrong, in words."""

import collections
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "integration"))
import judge  # noqa: E402  pylint: disable=wrong-import-position
import run_scenario  # noqa: E402  pylint: disable=wrong-import-position

STATE = "State0"


class Sight(run_scenario.LedgerEnd):
    """What the newest life of a node has done and seen so far."""

    def __init__(self, path):
        super().__init__(path)
        self.heard_of = set()  # nodes of which anything arrived in any life
        self.await_life()

    def await_life(self):
        """Forgets the newest life, which was killed, until the next one begins."""
        self._begin(0)

    def _begin(self, time):
        self.begun = time  # 0: no life yet
        self.peers = {}  # node -> its state of presence
        self.poses = {}  # node -> time of its newest tick
        self.states = {}  # node -> the event of its newest State
        self.posted = 0  # number of its own newest State
        self.accepted = collections.Counter()  # node -> commands
        self.outcomes = collections.defaultdict(list)  # node -> [(id, outcome)]

    def follow(self, event):
        super().follow(event)
        origin = event.values.get("from", event["node"] if event.kind == "peer" else None)
        if origin is not None and event.kind in ("peer", "tick", "state", "delivered"):
            self.heard_of.add(origin)
        if event.kind == "start":
            self._begin(event.time)
        elif event.kind == "peer":
            self.peers[origin] = event["state"]
        elif event.kind == "tick":
            self.poses[origin] = event.time
        elif event.kind == "state":
            self.states[origin] = event
        elif event.kind == "state_posted":
            self.posted = event.number("number")
        elif event.kind == "accepted":
            self.accepted[event["to"]] += 1
        elif event.kind == "outcome":
            self.outcomes[event["to"]].append((event.number("id"), event["is"]))


def pairs(nodes):
    return [(node, other) for node in nodes for other in nodes if node != other]


def not_met(sights, nodes):
    """Each node shows each other one UP, a pose of its newest life, and the newest State."""
    missing = []
    for node, other in pairs(nodes):
        mine, theirs = sights[node], sights[other]
        if mine.peers.get(other) != "UP":
            missing.append(f"{node} shows {other} {mine.peers.get(other, 'not at all')}")
        if not theirs.begun or mine.poses.get(other, 0) <= theirs.begun:
            missing.append(f"{node} has no pose of this life of {other}")
    return missing + old_states(sights, nodes)


def old_states(sights, nodes):
    """Each node shows the newest State of each other one."""
    missing = []
    for node, other in pairs(nodes):
        state = sights[node].states.get(other)
        if state is None or not sights[other].begun or state.time <= sights[other].begun:
            missing.append(f"{node} has no State of this life of {other}")
        elif state.number("number") != sights[other].posted:
            missing.append(f"{node} shows State {state['number']} of {other}, which posted {sights[other].posted}")
    return missing


def not_accepted(sights, nodes, ordered):
    """The newest life of each node has had `ordered[node]` commands accepted for each other node."""
    return [f"{node} has had {sights[node].accepted[other]} commands to {other} accepted" for node, other in pairs(nodes)
            if sights[node].accepted[other] < ordered[node]]


def unanswered(sights, nodes, ordered):
    """Each ordered command of the newest life of each node has its outcome."""
    return [f"{node} knows outcomes of {len(sights[node].outcomes[other])} commands to {other}"
            for node, other in pairs(nodes) if len(sights[node].outcomes[other]) < ordered[node]]


def unposted(sights, nodes, states):
    """The newest life of each node has posted so many States."""
    return [f"{node} posted {sights[node].posted} States" for node in nodes if sights[node].posted < states[node]]


def undelivered(sights, nodes, last):
    """The last so many commands of each node to each other one were delivered."""
    return [f"{node} was told of command {number} to {other}: {outcome}" for node, other in pairs(nodes)
            for number, outcome in sights[node].outcomes[other][-last:] if outcome != "delivered"]


def unsettled(sights, nodes):
    """The counters in each ledger tell the outcome of each accepted command."""
    missing = []
    for node, other in pairs(nodes):
        accepted = sights[node].accepted[other]
        link = sights[node].links.get((other, judge.NOTES), collections.Counter())
        told = sum(link[key] for key in ("delivered", "expired", "in_doubt", "undeliverable"))
        if link["accepted"] != accepted or told != accepted:
            missing.append(f"{node} counts {link['accepted']} accepted, {told} with an outcome, to {other}: {accepted} accepted")
    return missing


def strayed(sights, nodes, strangers):
    """Nothing of a stranger reached a node, and nothing of a node reached a stranger."""
    return [f"{one} heard of {other}" for one in [*nodes, *strangers] for other in sorted(sights[one].heard_of)
            if (one in nodes) != (other in nodes)]
