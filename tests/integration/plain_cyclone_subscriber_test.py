#!/usr/bin/env python3
"""A plain Cyclone program with the same IDL sees the poses of all aircraft on the default partition.

Usage: plain_cyclone_subscriber_test.py UAV SUBSCRIBER"""

import sys

import harness

# Loopback only. Unicast to this host finds the nodes even where loopback does not do multicast.
CYCLONE = """<CycloneDDS><Domain><General><Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>50</MaxAutoParticipantIndex>
<Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain></CycloneDDS>"""
AIRCRAFT = 3
POSES_OF_EACH = 5


def main():
    harness.enter_namespace()
    uav, subscriber = sys.argv[1:]
    domain = harness.domain()
    with harness.Processes() as processes:
        for number in range(1, AIRCRAFT + 1):
            processes.start([uav, "--config", harness.ROOT / "examples/swarm/uav.yaml", "--node", f"uav{number}",
                             "--domain", domain])
        plain = processes.start([subscriber, domain, 60], {"CYCLONEDDS_URI": CYCLONE})
        counts = {}

        def enough(text):
            words = text.split()
            if len(words) == 5 and words[0] == "pose":
                assert -90 <= float(words[2]) <= 90 and -180 <= float(words[3]) <= 180, text
                counts[words[1]] = counts.get(words[1], 0) + 1
            return len([c for c in counts.values() if c >= POSES_OF_EACH]) == AIRCRAFT

        plain.wait_for(enough, 60)
        print(f"poses by writer: {counts}")


if __name__ == "__main__":
    main()
