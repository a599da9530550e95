"""What the whole-system tests share: processes that end with the test whatever happens to it, their lines as they
come, and a network of the test's own where the machine allows it."""

import functools
import os
import pathlib
import platform
import socket
import subprocess
import sys
import threading

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "gateway" / "lab"), str(ROOT / "tests")]
# pylint: disable=wrong-import-position,unused-import
from rabit_lab.processes import Pauses, Process, Processes, die_with_parent, full_pipe, until  # noqa: E402,F401
from skipped import SKIPPED, skip  # noqa: E402,F401

IN_NAMESPACE = "RABIT_TEST_IN_NAMESPACE"
LEASES = []  # of domains; they end with this program


def can_make_namespaces():
    """True if this process may make network namespaces and set up devices in them: it needs two capabilities."""
    try:
        return subprocess.run(["unshare", "--net", "ip", "link", "set", "lo", "up", "multicast", "on"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False).returncode == 0
    except FileNotFoundError:
        return False


def debian():
    """The name of this machine's release of Debian: bookworm is 12, trixie 13. What is built here runs on that release."""
    return platform.freedesktop_os_release().get("VERSION_CODENAME")


def enter_namespace():
    """Starts this script again in a network namespace of its own, which vanishes with it, if that is allowed here;
    otherwise the test goes on with the machine's loopback."""
    if os.environ.get(IN_NAMESPACE):
        return
    if not can_make_namespaces():
        os.environ[IN_NAMESPACE] = "no"
        return
    os.environ[IN_NAMESPACE] = "yes"
    os.execvp("unshare", ["unshare", "--net", "sh", "-c",
                          "ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo && exec \"$@\"",
                          "sh", sys.executable, *sys.argv])


def enter_namespace_or_skip():
    """As enter_namespace, but the test is skipped where the machine allows no namespace."""
    enter_namespace()
    if os.environ[IN_NAMESPACE] != "yes":
        skip("no network namespace can be made")


@functools.cache
def domain():
    """A DDS domain: the first one in a namespace; elsewhere one that no other test has until this program ends, as
    tests/transport/conformance/DomainLease. The ports of domains from 100 on are among those that the kernel gives to any
    socket."""
    if os.environ.get(IN_NAMESPACE) == "yes":
        return 0
    for number in range(20, 100):
        lease = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        try:
            lease.bind(f"\0rabit-test-domain-{number}")
        except OSError:
            lease.close()
            continue
        LEASES.append(lease)
        return number
    raise RuntimeError("all DDS domains for tests are taken")


def reason(error):
    """Returns an error in words, which are never empty: an error without a text must not pass for none."""
    return str(error) or repr(error)


def run_at_once(cases):
    """Runs each case's `run` on a thread of its own, and returns when all have. A case keeps what went wrong itself."""
    threads = [threading.Thread(target=case.run) for case in cases]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
