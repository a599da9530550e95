#!/usr/bin/env python3
"""An aircraft and a ground station. In the end the recording of the ground station has each post that is in the
aircraft's, once, byte for byte, at its time.

Usage: backfill_nodes_test.py CASE PROGRAMS TRANSPORT"""

import subprocess
import sys
import time

import backfill_fleet as bf

POSTS = ["--rate", "20", "--posts", "300"]
# All clocks are this machine's, and each node knows that of the other one by half a round trip: 1 ms on an idle machine. A
# busy machine adds what the nodes waited for a processor.
WORST_TIME_MS = 100


def begin(fleet, more=""):
    for node in fleet.ground.nodes:
        fleet.write(node, more)
    # The ground station first: what the test does is to happen while the aircraft posts.
    ground = fleet.start("ground")
    ground.wait_for(lambda text: "gateway: " in text, bf.LIMIT)  # it misses the aircraft
    fleet.start("uav1", *POSTS)
    ground.wait_for(lambda text: text.startswith("age uav1"), bf.LIMIT)
    return ground


def end(fleet, least):
    took, figures = fleet.wait_until_whole(["uav1"], bf.LIMIT, least)
    waited_ms = 1000 * fleet.waits.between(0, time.monotonic())
    print(f"whole after {took:.0f} s, waited for a processor for {waited_ms:.0f} ms: {figures}")
    for row in figures:
        assert row["posted"] >= (least if row["message"] == "Sample" else least // 10), row
        assert row["twice"] == 0 and row["other_bytes"] == 0, row
        assert row["backfilled"] > 0, row
        assert row["worst_time_ms"] < WORST_TIME_MS + waited_ms, row


def killed(fleet):
    """A cut between them, and a kill -9 of each."""
    ground = begin(fleet)
    time.sleep(3)
    fleet.ground.cut("uav1")
    time.sleep(8)
    fleet.ground.heal()
    time.sleep(2)
    fleet.ground.kill("uav1")
    fleet.start("uav1", *POSTS)
    since = time.monotonic()
    ground.wait_for(lambda text: text.startswith("age uav1"), bf.LIMIT, since)
    time.sleep(2)
    fleet.ground.kill("ground")
    time.sleep(3)
    fleet.start("ground")
    time.sleep(20)  # the second life of the aircraft has posted all
    end(fleet, 400)


def full_disk(fleet):
    """The disk of the ground station is full for a while."""
    recordings = fleet.recordings("ground")
    recordings.mkdir(parents=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", "size=40m", "tmpfs", recordings], check=True)
    try:
        ground = begin(fleet)
        time.sleep(2)
        # 16 MB stay free whatever the configuration says.
        (recordings / "filler").write_bytes(bytes(30_000_000))
        ground.wait_for(lambda text: "nothing is recorded" in text, bf.LIMIT)
        ground.wait_for(lambda text: "nothing is requested, since nothing can be recorded" in text, bf.LIMIT)
        ground.wait_for(lambda text: text.startswith("age uav1"), bf.LIMIT, time.monotonic())  # it goes on
        (recordings / "filler").unlink()
        time.sleep(16)
        end(fleet, 290)
        assert ground.running()
    finally:
        fleet.ground.kill("ground")
        subprocess.run(["umount", recordings], check=True)


def secured(fleet):
    """With keys only the nodes that `backfill_to` names may request."""
    def rabit(*words):
        subprocess.run([fleet.programs / "rabit", "keys", *words], cwd=fleet.folder, check=True, capture_output=True)

    rabit("init")
    for node in fleet.ground.nodes:
        fleet.write(node)
        rabit("add", node, "--config", f"{node}.yaml")
    keys = "security: {{keys: {}/keys/{}}}\n"
    for node in fleet.ground.nodes:
        fleet.write(node, keys.format(fleet.folder, node))
    fleet.start("uav1", *POSTS)
    ground = fleet.start("ground")
    ground.wait_for(lambda text: "it does not let this node have them" in text, bf.LIMIT)
    fleet.ground.kill("uav1")
    with open(fleet.folder / "uav1.yaml", "a", encoding="ascii") as file:
        file.write("  backfill_to: [ground]\n")
    since = time.monotonic()
    fleet.start("uav1", *POSTS)
    ground.wait_for(lambda text: text.startswith("age uav1"), bf.LIMIT, since)
    time.sleep(2)
    fleet.ground.cut("uav1")
    time.sleep(5)
    fleet.ground.heal()
    time.sleep(10)
    end(fleet, 290)


CASES = {"killed": killed, "full_disk": full_disk, "secured": secured}


def main():
    case, programs, transport = sys.argv[1:]
    with bf.field.skipping():
        with bf.field.Field(["uav1", "ground"]) as ground:
            CASES[case](bf.Fleet(ground, programs, transport, ground.folder))
    return 0


if __name__ == "__main__":
    sys.exit(main())
