#!/usr/bin/env python3
"""A killed aircraft is shown STALE, then LOST; when it comes back it is UP and obeys commands again. The others are
not disturbed.

Usage: kill_and_return_test.py UAV GROUND"""

import re
import sys
import time

import harness

ROW = re.compile(r"^\s*[\d.]+ s\s+(\S+)\s+(UP|STALE|LOST|WAITING)\s.*, commands (\d+) sent (\d+) acknowledged$")


def row_of(node, state, acknowledged=0):
    """Finds a line that shows the node in that state, with at least so many commands acknowledged."""
    def found(text):
        match = ROW.match(text)
        if match and match.group(1) == node and match.group(2) == state and int(match.group(4)) >= acknowledged:
            return int(match.group(4)) or True
        return None
    return found


def main():
    harness.enter_namespace()
    uav, ground = sys.argv[1:]
    domain = harness.domain()
    with harness.Processes() as processes:
        def fly(node):
            return processes.start([uav, "--config", harness.ROOT / "examples/swarm/uav.yaml", "--node", node,
                                    "--domain", domain])

        station = processes.start([ground, "--config", harness.ROOT / "examples/ground_station/ground.yaml",
                                   "--domain", domain, "--command-period", "1"])
        first = fly("uav1")
        fly("uav2")
        _, acknowledged = station.wait_for(row_of("uav1", "UP", 2), 60)
        station.wait_for(row_of("uav2", "UP", 2), 60)

        first.kill()
        killed = time.monotonic()
        stale, _ = station.wait_for(row_of("uav1", "STALE"), 30, killed)
        lost, _ = station.wait_for(row_of("uav1", "LOST"), 30, killed)
        assert stale < lost, "LOST came before STALE"
        print(f"STALE shown {stale - killed:.1f} s and LOST {lost - killed:.1f} s after the kill")

        back = time.monotonic()
        fly("uav1")
        up, _ = station.wait_for(row_of("uav1", "UP"), 60, back)
        _, now = station.wait_for(row_of("uav1", "UP", acknowledged + 3), 60, back)
        print(f"UP again {up - back:.1f} s after the restart; commands acknowledged: {acknowledged}, then {now}")

        disturbed = [text for when, text in station.lines
                     if when > killed and (row_of("uav2", "STALE")(text) or row_of("uav2", "LOST")(text))]
        assert not disturbed, f"uav2 was disturbed: {disturbed[0]}"


if __name__ == "__main__":
    main()
