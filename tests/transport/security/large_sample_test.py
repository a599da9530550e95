#!/usr/bin/env python3
"""A State of 4 MB with keys, from Cyclone DDS to Fast DDS: each fragment takes one datagram, as without keys.

Usage: large_sample_test.py RABIT NODE
Skipped (exit code 77) where no network namespace can be made: other programs' datagrams would count."""

import collections
import pathlib
import re
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402
import loopback  # noqa: E402
from interop_keys import make_keys  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
NODES = (("first", "fastdds"), ("second", "cyclonedds"))
MAX_DATAGRAM = 1400
FRAME = 4_000_000


def main():
    rabit, node = sys.argv[1:]
    harness.enter_namespace_or_skip()
    sizes = collections.defaultdict(list)  # of datagrams, by their source port
    loopback.Watch(lambda source, _, datagram: sizes[source].append(len(datagram)))
    with tempfile.TemporaryDirectory() as folder, harness.Processes() as processes:
        folder = pathlib.Path(folder)
        make_keys(rabit, folder, NODES, 0)
        names = [name for name, _ in NODES]
        nodes = [processes.start([node, "--node", name, "--other", other, "--transport", transport, "--domain", 0,
                                  "--interface", "127.0.0.1", "--count", 1, "--keys", folder / "keys" / name])
                 for (name, transport), other in zip(NODES, reversed(names))]
        nodes[0].wait_for(re.compile(r"frame life=\d+").fullmatch, LIMIT_S)
    cyclone = [found for found in list(sizes.values()) if sum(found) > FRAME / 2 and max(found) <= MAX_DATAGRAM]
    assert len(cyclone) == 1, {port: (len(found), max(found)) for port, found in sizes.items()}
    mean = sum(cyclone[0]) / len(cyclone[0])
    print(f"{len(cyclone[0])} datagrams of {mean:.0f} bytes on average, the largest {max(cyclone[0])}")
    assert mean > 0.7 * MAX_DATAGRAM, "the fragments share their datagrams with nothing"


if __name__ == "__main__":
    main()
