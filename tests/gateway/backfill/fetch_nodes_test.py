#!/usr/bin/env python3
"""A file is fetched from an aircraft while the tool and the aircraft are killed, and is whole in the end; and who may not
fetch gets nothing.

Usage: fetch_nodes_test.py PROGRAMS TRANSPORT"""

import hashlib
import json
import os
import random
import subprocess
import sys

import backfill_fleet as bf

SIZE = 3_000_000
KBIT = 4000


def hash_of(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


class Tool:
    def __init__(self, fleet):
        self.fleet = fleet

    def argv(self, what, to):
        return [self.fleet.programs / "rabit", "fetch", what, "--to", to, "--json", "--transport", self.fleet.transport,
                "--domain", "0", "--interface", self.fleet.ground.address("ground"), "--wait", "60"]

    def start(self, what, to):
        return self.fleet.ground.start("tool", self.argv(what, to), "ground")


def fetch_with_kills(fleet, folder):
    original = fleet.files("uav1") / "map.bin"
    original.write_bytes(random.Random(1).randbytes(SIZE))
    to = folder / "map.bin"
    part = folder / "map.bin.part"
    tool = Tool(fleet)

    def until_has(share):
        bf.harness.until(lambda: part.exists() and part.stat().st_size >= share * SIZE, bf.LIMIT)

    process = tool.start("uav1:map.bin", to)
    until_has(0.2)
    process.kill()
    assert not to.exists()
    kept = part.stat().st_size
    process = tool.start("uav1:map.bin", to)
    until_has(0.5)
    assert part.stat().st_size >= kept
    fleet.ground.kill("uav1")
    fleet.start("uav1", "--rate", "1")
    assert process.exit_code(bf.LIMIT) == 0, process.lines
    assert hash_of(to) == hash_of(original)
    assert not part.exists()
    shown = json.loads(process.lines[-1][1])
    print(shown)
    assert shown["bytes"] == SIZE
    # The part that was under way at the kill of the aircraft may have come.
    assert shown["repeated_bytes"] <= 2 * 64 * 1024, shown


def refuse(fleet, folder):
    secret = folder / "secret"
    secret.write_text("secret")
    os.symlink(secret, fleet.files("uav1") / "link")
    for name in ("link", "../secret", "none"):
        done = subprocess.run(["ip", "netns", "exec", fleet.ground.space("ground"),
                               *map(str, Tool(fleet).argv(f"uav1:{name}", folder / "refused"))],
                              capture_output=True, text=True, timeout=bf.LIMIT, check=False)
        assert done.returncode == 1, done
        assert "it has no such file" in done.stderr, done
        assert not (folder / "refused").exists()
        assert not (folder / "refused.part").exists()


def main():
    programs, transport = sys.argv[1:]
    with bf.field.skipping():
        with bf.field.Field(["uav1", "ground"]) as ground:
            fleet = bf.Fleet(ground, programs, transport, ground.folder)
            fleet.write("uav1")
            ground.shape("uav1", KBIT)
            fleet.start("uav1", "--rate", "1")
            fetch_with_kills(fleet, fleet.folder)
            refuse(fleet, fleet.folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
