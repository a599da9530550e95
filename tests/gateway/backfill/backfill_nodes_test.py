#!/usr/bin/env python3
"""An aircraft and a ground station. In the end the recording of the ground station has each post that is in the
aircraft's, once, byte for byte. BackfillSimulationTest judges at which time.

Usage: backfill_nodes_test.py CASE PROGRAMS TRANSPORT"""

import subprocess
import sys
import time

import backfill_fleet as bf

POSTS = ["--rate", "20", "--posts", 300]  # samples; ten times as few findings
MOST = 290  # of these: what two threads post at once, the recorder may count in place of recording it


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
    figures = fleet.wait_until_whole(["uav1"], least)
    print(f"whole: {figures}")
    for row in figures:
        assert row["posted"] >= (least if row["message"] == "Sample" else least // 10), row
        assert row["twice"] == 0 and row["other_bytes"] == 0, row
        assert row["backfilled"] > 0, row


def kill_and_start(fleet, ground):
    """Of the aircraft. Returns the number of samples of its lives before."""
    fleet.ground.kill("uav1")
    posts = fleet.posted("uav1")
    since = time.monotonic()
    fleet.start("uav1", *POSTS)
    ground.wait_for(lambda text: text.startswith("age uav1"), bf.LIMIT, since)
    return posts


def killed(fleet):
    """A cut between them, and a kill -9 of each."""
    ground = begin(fleet)
    fleet.until_posted("uav1", 60)
    fleet.ground.cut("uav1")
    fleet.until_posted("uav1", 220)
    fleet.ground.heal()
    bf.harness.until(lambda: any(row["backfilled"] for row in fleet.judge("uav1")))
    posts = kill_and_start(fleet, ground)
    fleet.until_posted("uav1", posts + 40)
    fleet.ground.kill("ground")
    fleet.until_posted("uav1", posts + 100)
    fleet.start("ground")
    end(fleet, posts + MOST)


def full_disk(fleet):
    """The disk of the ground station is full for a while."""
    recordings = fleet.recordings("ground")
    recordings.mkdir(parents=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", "size=40m", "tmpfs", recordings], check=True)
    try:
        ground = begin(fleet)
        fleet.until_posted("uav1", 40)
        # 16 MB stay free whatever the configuration says.
        (recordings / "filler").write_bytes(bytes(30_000_000))
        ground.wait_for(lambda text: "nothing is recorded" in text, bf.LIMIT)
        ground.wait_for(lambda text: "nothing is requested, since nothing can be recorded" in text, bf.LIMIT)
        ground.wait_for(lambda text: text.startswith("age uav1"), bf.LIMIT, time.monotonic())  # it goes on
        (recordings / "filler").unlink()
        end(fleet, MOST)
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
    with open(fleet.folder / "uav1.yaml", "a", encoding="ascii") as file:
        file.write("  backfill_to: [ground]\n")
    posts = kill_and_start(fleet, ground)
    fleet.until_posted("uav1", posts + 40)
    fleet.ground.cut("uav1")
    fleet.until_posted("uav1", posts + 140)
    fleet.ground.heal()
    end(fleet, posts + MOST)


CASES = {"killed": killed, "full_disk": full_disk, "secured": secured}


def main():
    case, programs, transport = sys.argv[1:]
    with bf.field.skipping():
        with bf.field.Field(["uav1", "ground"]) as ground:
            CASES[case](bf.Fleet(ground, programs, transport, ground.folder))
    return 0


if __name__ == "__main__":
    sys.exit(main())
