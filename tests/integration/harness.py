"""What the whole-system tests share: processes that end with the test whatever happens to it, their lines as they
come, and a network of the test's own where the machine allows it."""

import bisect
import functools
import os
import pathlib
import platform
import re
import resource
import socket
import subprocess
import sys
import threading
import time
from xml.etree import ElementTree

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


class Waits:
    """How long processes were kept from running: what their threads waited for a processor, all together, and what this
    program woke up too late. Whatever these processes do in a time, the machine has delayed it by no more than that. On an
    idle machine it is some milliseconds a second. Times are those of the monotonic clock, in s."""

    LOOK_S = 0.25

    def __init__(self, pids):
        """`pids()`: the processes that run; this one is always among them."""
        self._pids = pids
        self._seen = {}  # (process, thread) -> s
        self._late = 0.0
        self._looks = [self._look()]  # (begin, end, s)
        self._ended = threading.Event()
        threading.Thread(target=self._follow, daemon=True).start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._ended.set()

    def _sum(self):
        for pid in {os.getpid(), *self._pids()}:
            for path in pathlib.Path(f"/proc/{pid}/task").glob("*/schedstat"):
                try:
                    self._seen[pid, path.parent.name] = int(path.read_text(encoding="ascii").split()[1]) * 1e-9
                except (OSError, IndexError):
                    pass  # it has ended, or the kernel does not count
        return sum(self._seen.values())

    def _look(self):
        begin = time.monotonic()
        waited = self._sum() + self._late
        return begin, time.monotonic(), waited

    def _follow(self):
        slept = time.monotonic()
        while not self._ended.wait(self.LOOK_S):
            self._late += time.monotonic() - slept - self.LOOK_S
            self._looks.append(self._look())
            slept = self._looks[-1][1]  # a look takes time that nothing waits for

    def between(self, begin, end):
        """From the last look that ended before the begin to the first one that began after the end, or to the last one."""
        looks = self._looks[:]
        first = max(bisect.bisect_right([ended for _, ended, _ in looks], begin) - 1, 0)
        last = min(bisect.bisect_left([began for began, _, _ in looks], end), len(looks) - 1)
        return max(looks[last][2] - looks[first][2], 0.0)


class Idle:
    """The share that other programs leave idle of the processors that this program may use, from when this was made on. What
    this program took, and its children that have ended, counts as idle: nodes that never rest do not make the machine busy."""

    BUSY = 0.4  # with less the machine is busy

    def __init__(self):
        self._began = self._now()

    @staticmethod
    def _now():
        ours = {f"cpu{number}" for number in os.sched_getaffinity(0)}
        rows = [line.split() for line in pathlib.Path("/proc/stat").read_text(encoding="ascii").splitlines()]
        times = [list(map(int, row[1:9])) for row in rows if row[0] in ours]
        used = [resource.getrusage(whose) for whose in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
        return (sum(row[3] + row[4] for row in times),  # idle, and waiting for a disk
                sum(one.ru_utime + one.ru_stime for one in used) * os.sysconf("SC_CLK_TCK"), sum(map(sum, times)))

    def share(self, with_ours=False):
        """`with_ours`: what this program took and its children counts as other programs' time."""
        idle, ours, all_of_it = (now - then for now, then in zip(self._now(), self._began))
        return min((idle + (0 if with_ours else ours)) / max(all_of_it, 1), 1.0)

    def is_busy(self, with_ours=False):
        return self.share(with_ours) < self.BUSY


def ended_badly(results):
    """The nodes of runs of the lab that ended by themselves, or with another exit code than the scenario expects, by the
    verdicts in that folder. No busy machine explains that."""
    found = set()
    for path in pathlib.Path(results).rglob("junit.xml"):
        for case in ElementTree.parse(path).getroot().iter("testcase"):
            failure = case.find("failure")
            if failure is not None and case.get("name").startswith(("no node ends by itself", "exit code")):
                found |= set(re.findall(r"(?:^|; )(\S+) ended (?:by itself )?with -?\d", failure.get("message")))
    return found


def run_at_once(cases):
    """Runs each case's `run` on a thread of its own, and returns when all have. A case keeps what went wrong itself."""
    threads = [threading.Thread(target=case.run) for case in cases]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
