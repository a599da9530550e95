"""What the whole-system tests share: processes that end with the test whatever happens to it, their lines as they
come, and a network of the test's own where the machine allows it."""

import os
import pathlib
import platform
import subprocess
import sys
import threading

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "gateway" / "lab"))
# pylint: disable=wrong-import-position,unused-import
from rabit_lab.processes import Pauses, Process, Processes, die_with_parent, full_pipe, until  # noqa: E402,F401

IN_NAMESPACE = "RABIT_TEST_IN_NAMESPACE"


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


def domain():
    """A DDS domain: the first one in a namespace, one that depends on the process elsewhere."""
    return 0 if os.environ.get(IN_NAMESPACE) == "yes" else 100 + os.getpid() % 100


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
