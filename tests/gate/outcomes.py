"""What the nodes of a smoke test have seen, and what they still have to see. All functions read the ledgers of
../integration/README.md as they are now; none knows a time limit. Each returns what is missing or wrong, in words."""

import collections
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "integration"))
import judge  # noqa: E402  pylint: disable=wrong-import-position
import sight  # noqa: E402  pylint: disable=wrong-import-position
from sight import old_states, pairs, strayed  # noqa: E402  pylint: disable=wrong-import-position

STATE = "State0"


def not_met(sights, nodes):
    """Each node shows each other one UP, a pose of its newest life, and the newest State."""
    return sight.not_met(sights, nodes, nodes) + unposted(sights, nodes, dict.fromkeys(nodes, 1)) + old_states(sights, nodes)


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
    return [f"{node} posted {sights[node].posted[STATE]} States" for node in nodes if sights[node].posted[STATE] < states[node]]


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
