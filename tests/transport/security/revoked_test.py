#!/usr/bin/env python3
"""A node is revoked in flight. One node of the fleet gets the bulletin as a file, passes it on, and the revoked node is not heard
any more. The other half of the fleet comes later, with keys from before, and learns the same.

Usage: revoked_test.py RABIT LEDGER_NODE TRANSPORT..."""

import re
import shutil
import sys

import keyed_fleet
from keyed_fleet import ENDLESS, LIMIT_S, exchange, harness, meet, once_and_in_order

REVOKED = "uav2"
EARLY, LATE = ("ground", "uav1"), ("uav3", "uav4")
BULLETIN = re.compile("-----BEGIN RABIT BULLETIN-----.*?-----END RABIT BULLETIN-----", re.DOTALL)


def newest_in(file):
    return BULLETIN.findall(file.read_text(encoding="ascii"))[-1]


def await_bulletin(case, names, newest):
    for name in names:
        harness.until(lambda name=name: newest_in(case.keys[name] / "bulletin") == newest, LIMIT_S)


def is_gone(*nodes):
    """None shows the revoked node any more, and none gets anything more of it."""
    harness.until(lambda: all(node.state_of(REVOKED) in (None, "LOST") for node in nodes), LIMIT_S)
    heard = f"(delivered|tick) from={REVOKED} .*"
    before = [len(node.find(heard)) for node in nodes]
    exchange(*nodes)
    after = [len(node.find(heard)) for node in nodes]
    assert after == before, f"the revoked node was heard: {before}, {after}"
    assert all(node.state_of(REVOKED) in (None, "LOST") for node in nodes), "the revoked node was met"


def revoke(case):
    """a node is revoked in flight"""
    # Each node's host has its own copy.
    for name, folder in case.keys.items():
        case.keys[name] = shutil.copytree(folder, case.folder / "hosts" / name)
    ground, uav1, revoked = case.talkers(*EARLY, REVOKED)
    exchange(ground, uav1, revoked)
    case.run_keys("revoke", REVOKED, "--keys", case.folder / "keys")
    bulletin = case.folder / "keys" / "authority" / "bulletin"
    newest = newest_in(bulletin)
    assert ground.process.terminate() == 0
    shutil.copy(bulletin, case.keys["ground"])
    to = {name: [word for other in (*EARLY, *LATE) if other != name for word in ("--to", other)] for name in (*EARLY, *LATE)}
    ground = case.node("ground", *to["ground"], *ENDLESS)
    await_bulletin(case, ["uav1"], newest)
    meet(ground, uav1)
    is_gone(ground, uav1)
    for node in (ground, uav1):
        node.says("its certificate is revoked, and it is not heard")
    late = [case.node(name, *to[name], *ENDLESS) for name in LATE]
    await_bulletin(case, LATE, newest)
    # uav1 sends to the nodes that it knew at its start.
    assert uav1.process.terminate() == 0
    uav1 = case.node("uav1", *to["uav1"], *ENDLESS)
    meet(ground, uav1, *late)
    is_gone(ground, uav1, *late)
    ground.never(f"peer node={REVOKED} state=UP .*", f"(delivered|tick) from={REVOKED} .*")
    once_and_in_order(ground, uav1, *late)
    assert revoked.process.running(), "the revoked node ended by itself"


def main():
    programs, transports = sys.argv[1:3], sys.argv[3:]
    harness.enter_namespace()
    fleets = [dict.fromkeys((REVOKED, LATE[0]), other) | {"ground": first, "uav1": second, LATE[1]: second}
              for other in transports for first, second in zip(transports, reversed(transports))]
    cases = [keyed_fleet.Case(programs, harness.domain() + 3 * i, fleet, revoke) for i, fleet in enumerate(fleets)]
    sys.exit(1 if keyed_fleet.run(cases) else 0)


if __name__ == "__main__":
    main()
