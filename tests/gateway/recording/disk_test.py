#!/usr/bin/env python3
"""Disks that are full, or stall for 30 s, while whole processes record: what is left, and what is said.

Usage: disk_test.py CASE RABIT SENSOR STALLED_DISK
CASE is full_while_a_node_records, full_while_the_tool_records or stalls. STALLED_DISK is the library of stalled_disk.c.
A full disk is a small tmpfs in a mount namespace of the test's own. Exit code 77: the machine does not allow that."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integration"))
import harness  # noqa: E402

# Only keeps a broken program from hanging.
LIMIT = 300
STALLED = 30  # readings, one a second: longer than a disk may take unnoticed
MIB = 1 << 20
IN_MOUNTS = "RABIT_TEST_IN_MOUNTS"


def enter_mounts():
    """Starts this script again in a mount namespace of its own, so that its disks vanish with it."""
    if os.environ.get(IN_MOUNTS):
        return
    probe = subprocess.run(["unshare", "--mount", "mount", "-t", "tmpfs", "none", "/mnt"], stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL, check=False)
    if probe.returncode != 0:
        harness.skip("no mount namespace can be made")
    os.environ[IN_MOUNTS] = "yes"
    os.execvp("unshare", ["unshare", "--mount", sys.executable, *sys.argv])


def small_disk(folder, mib):
    folder.mkdir()
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={mib}m", "none", folder], check=True)
    return folder


def put(file, mib):
    with open(file, "wb") as stream:
        os.posix_fallocate(stream.fileno(), 0, mib * MIB)
    return file


def names(folder):
    return sorted(file.name for file in folder.glob("*.mcap"))


def info(rabit, file):
    done = subprocess.run([rabit, "info", "--json", file], capture_output=True, text=True, timeout=LIMIT, check=False)
    return json.loads(done.stdout), done.returncode


def readings(rabit, folder, of):
    about = [info(rabit, file)[0] for file in sorted(folder.glob(f"{of}_*.mcap"))]
    return sum(row["messages"] for one in about for row in one["topics"] if row["topic"] == "sensor/Reading")


class Fleet:
    def __init__(self, rabit, sensor, folder, processes):
        self.rabit, self.sensor, self.folder, self.processes = rabit, sensor, folder, processes
        self.network = ["--interface", "lo", "--domain", str(harness.domain())]

    def fly(self, record, env=None):
        """The sensor, which posts once a second and records itself."""
        config = self.folder / "sensor.yaml"
        config.write_text(f"node: sensor\ndomain: {harness.domain()}\ninterfaces: [lo]\n"
                          "publish:\n  - {message: Reading, type: TwoNodes::Reading}\n"
                          f"record: {{{record}}}\n")
        return self.processes.start([self.sensor, "--config", config], env)

    def record(self, *options):
        return self.processes.start([self.rabit, "record", *self.network, "--wait", "60", *options, "sensor/Reading"])


def full_while_a_node_records(fleet, _):
    disk = small_disk(fleet.folder / "disk", 64)
    earlier = put(disk / "sensor_000001_20250101T000000Z.mcap", 8).name
    node = fleet.fly(f"folder: {disk}, free: 20MB")
    harness.until(lambda: len(names(disk)) == 2, LIMIT)
    full = put(disk / "other", 40)
    node.wait_for(lambda line: "nothing is recorded: only" in line and "move earlier recordings away" in line, LIMIT)
    assert len(names(disk)) == 2 and names(disk)[0] == earlier, names(disk)
    about, code = info(fleet.rabit, disk / names(disk)[1])
    assert code == 0 and about["ended"], about
    full.unlink()
    harness.until(lambda: len(names(disk)) == 3, LIMIT)
    assert node.terminate() == 0
    about, _ = info(fleet.rabit, disk / names(disk)[2])
    assert about["ended"] and about["lost"], about
    assert names(disk)[0] == earlier, names(disk)


def full_while_the_tool_records(fleet, _):
    disk = small_disk(fleet.folder / "disk", 64)
    earlier = [put(disk / f"fleet_00000{number}_20250101T000000Z.mcap", 8).name for number in (1, 2)]
    fleet.fly(f"folder: {fleet.folder}/own, free: 0B")
    tool = fleet.record("--to", disk)
    tool.wait_for(lambda line: "nothing is recorded: only" in line, LIMIT)
    tool.signal(signal.SIGINT)
    assert tool.exit_code(LIMIT) == 1, tool.lines
    assert names(disk) == earlier, names(disk)


def turn(switch, to):
    """Keeps the length of the file: the node has mapped it, and would end with SIGBUS where it has no byte."""
    with open(switch, "r+b") as file:
        file.write(to)


def stalls(fleet, stalled_disk):
    switch = fleet.folder / "switch"
    switch.write_bytes(b"\0")
    own = fleet.folder / "own"
    node = fleet.fly(f"folder: {own}, free: 0B", {"LD_PRELOAD": stalled_disk, "STALLED_DISK": str(switch)})
    outside = fleet.folder / "outside"
    tool = fleet.record("--to", outside)
    harness.until(lambda: readings(fleet.rabit, own, "sensor") > 2 and readings(fleet.rabit, outside, "fleet") > 2, LIMIT)
    turn(switch, b"\1")
    before = readings(fleet.rabit, outside, "fleet")
    # Others go on to hear it.
    harness.until(lambda: readings(fleet.rabit, outside, "fleet") >= before + STALLED, LIMIT)
    at_stall = readings(fleet.rabit, own, "sensor")
    turn(switch, b"\0")
    harness.until(lambda: readings(fleet.rabit, own, "sensor") >= at_stall + STALLED - 5, LIMIT)
    tool.signal(signal.SIGINT)
    assert tool.exit_code(LIMIT) == 0, tool.lines
    assert node.terminate() == 0
    assert not [text for _, text in node.lines if "recorded" in text], node.lines
    assert readings(fleet.rabit, own, "sensor") >= readings(fleet.rabit, outside, "fleet")


def main():
    case = {do.__name__: do for do in (full_while_a_node_records, full_while_the_tool_records, stalls)}[sys.argv[1]]
    rabit, sensor, stalled_disk = sys.argv[2:5]
    if case is not stalls:
        enter_mounts()
    harness.enter_namespace()
    with tempfile.TemporaryDirectory() as folder:
        try:
            with harness.Processes() as processes:
                case(Fleet(rabit, sensor, pathlib.Path(folder), processes), stalled_disk)
        finally:
            if os.path.ismount(pathlib.Path(folder) / "disk"):
                subprocess.run(["umount", pathlib.Path(folder) / "disk"], check=True)
    print("ok")


if __name__ == "__main__":
    main()
