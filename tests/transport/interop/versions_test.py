#!/usr/bin/env python3
"""Nodes of this Debian beside nodes of the other one (12 and 13), over every pair of backends: what interop_test.py and
../security/pairs_test.py do. With --arm64, beside nodes of Debian 12 for arm64 under qemu-user, whose unit tests are run first.

Usage: versions_test.py [--arm64] RABIT NODE TRANSPORT...
Makes a root of the other Debian and builds the node in it, which takes half an hour and more; with RABIT_OTHER_ROOT it
uses a root that docker/bare.sh has kept. Ends with 77 where it cannot make one, or no network namespace."""

import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "security"), str(HERE.parents[1] / "integration")]
import harness  # noqa: E402
from interop_test import Row, print_table  # noqa: E402
from pairs_test import Fleet  # noqa: E402

AT_ONCE = 4  # pairs of nodes
AT_ONCE_ARM64 = 1  # an emulated node takes about ten times the processor time
OTHER_ROOT = "RABIT_OTHER_ROOT"
RELEASES = {"bookworm": "trixie", "trixie": "bookworm"}
BUILD = "docker/install-packages.sh && docker/build-preset.sh release interop_node"
BUILT_NODE = ["/rabit/build/release/bin/interop_node"]
# qemu before 8 has no IP_MULTICAST_IF.
BUILD_ARM64 = ("dpkg --add-architecture arm64 && "
               "echo deb http://deb.debian.org/debian bookworm-backports main >/etc/apt/sources.list.d/backports.list && "
               "apt-get update && apt-get install -y --no-install-recommends -t bookworm-backports qemu-user && "
               "./tests/run.sh --quick arm64 && "
               "docker/build-preset.sh arm64 interop_node")
BUILT_NODE_ARM64 = ["qemu-aarch64", "/rabit/build/arm64/bin/interop_node"]
# The nodes of both roots find their keys under the same names.
INSIDE = 'mount --rbind /dev "$0/dev"; mount --bind "$1" "$0/tmp"; root=$0; shift; exec chroot "$root" "$@"'


def make_root(folder, arm64):
    """Returns the exit code of bare.sh."""
    release = "bookworm" if arm64 else RELEASES.get(harness.debian())
    if release is None:
        harness.skip("needs Debian 12 or 13")
    return subprocess.run([HERE.parents[2] / "docker" / "bare.sh", "--own-ccache", "--keep", folder, release,
                           BUILD_ARM64 if arm64 else BUILD], check=False).returncode


def run(cases, at_once):
    for i in range(0, len(cases), at_once):
        harness.run_at_once(cases[i:i + at_once])
    return [f"{case.label}: {case.failure}" for case in cases if case.failure]


def labelled(case, label):
    case.label = label
    return case


def compare(rabit, node, root, built_node, transports, at_once):
    here = [node]
    there = ["unshare", "--mount", "sh", "-ec", INSIDE, root, tempfile.gettempdir(), *built_node]
    pairs = [(first, second) for first in transports for second in transports]
    rows = [labelled(Row(nodes, *pair, 7 * i), f"{pair} {name}")
            for i, (nodes, pair, name) in enumerate((nodes, pair, name) for pair in pairs for nodes, name in
                                                    (((here, there), "here, other"), ((there, here), "other, here")))]
    fleets = [labelled(Fleet(rabit, (here, there), pair, 7 * i), f"{pair} here, other, with keys") for i, pair in enumerate(pairs)]
    failures = run(rows, at_once)
    print("By turns the first node is of this machine, and of the other root:")
    print_table(rows)
    failures += run(fleets, at_once)
    print(f"{len(fleets)} fleets with keys, {sum(1 for fleet in fleets if fleet.failure)} failed")
    print("\n".join(failures))
    return 1 if failures else 0


def main():
    arm64 = sys.argv[1] == "--arm64"
    rabit, node, *transports = sys.argv[2:] if arm64 else sys.argv[1:]
    if os.geteuid() != 0 or not harness.can_make_namespaces():
        harness.skip("needs root and network namespaces")
    if OTHER_ROOT in os.environ:
        harness.enter_namespace()
        sys.exit(compare(rabit, node, os.environ[OTHER_ROOT],
                         BUILT_NODE_ARM64 if arm64 else BUILT_NODE, transports,
                         AT_ONCE_ARM64 if arm64 else AT_ONCE))
    with tempfile.TemporaryDirectory(prefix="rabit_versions_") as folder:
        code = make_root(folder, arm64)
        if code != 0:
            sys.exit(code)
        sys.exit(subprocess.run([sys.executable, *sys.argv], env={**os.environ, OTHER_ROOT: f"{folder}/root"},
                                check=False).returncode)


if __name__ == "__main__":
    main()
