"""A network of namespaces on one bridge, with faults, for whole-system tests. Needs root, iproute2 and nftables.

Every name carries the process id of its maker. All is removed when the `with` block is left, also through SIGINT and
SIGTERM; what a SIGKILL of the maker leaves (empty namespaces, for the nodes die with their maker) is removed by the
next Field."""

import contextlib
import os
import re
import shutil
import signal
import subprocess
import tempfile

import harness
from rabit_lab.radio import Unsupported

PREFIX = "rbtfield"
NAME = re.compile(PREFIX + r"-(\d+)-")


@contextlib.contextmanager
def skipping():
    """Ends the test as skipped, with the reason, if the machine does not allow what is needed."""
    try:
        yield
    except Unsupported as reason:
        harness.skip(reason)


def run(*argv, text=None):
    return subprocess.run(argv, input=text, text=True, check=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT).stdout


def run_in(space, *argv, text=None):
    return run("ip", "netns", "exec", space, *argv, text=text)


def dead(name):
    match = NAME.match(name)
    return match and not os.path.exists(f"/proc/{match.group(1)}")


def namespaces():
    """All namespaces that any Field made."""
    listed = run("ip", "netns", "list")
    return [line.split()[0] for line in listed.splitlines() if NAME.match(line)]


def folders():
    """All folders that any Field made."""
    root = tempfile.gettempdir()
    return [os.path.join(root, name) for name in os.listdir(root) if NAME.match(name)]


def sweep():
    """Removes what makers that are dead left behind."""
    for name in namespaces():
        if dead(name):
            subprocess.run(["ip", "netns", "del", name], check=False)
    for path in folders():
        if dead(os.path.basename(path)):
            shutil.rmtree(path, ignore_errors=True)


def stop(number, _frame):
    raise SystemExit(128 + number)


class Field:
    """with Field(["ground", "uav1"]) as field: field.start("uav1", [program, argument, ...])"""

    def __init__(self, nodes, multicast=True):
        self.nodes = list(nodes)
        self._multicast = multicast
        self._moves = {}  # node -> how often it was given a new address
        self.folder = None
        self.processes = {}
        self._drops = {}  # (from, to) -> percent
        self._prefix = f"{PREFIX}-{os.getpid()}-"
        self._made = []

    def __enter__(self):
        if os.geteuid() != 0 or not all(map(shutil.which, ("ip", "nft"))):
            raise Unsupported("needs root, iproute2 and nftables")
        if not harness.can_make_namespaces():
            raise Unsupported("no network namespaces can be made here")
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, stop)
        sweep()
        try:
            self._build()
        except BaseException:
            self._remove()
            raise
        return self

    def __exit__(self, *_):
        self._remove()

    def address(self, node):
        return f"10.77.{self._moves.get(node, 0)}.{self.nodes.index(node) + 1}"

    def move(self, node):
        """Another address, in place of the one that it had."""
        inside = ["ip", "-n", self.space(node), "address"]
        run(*inside, "del", self.address(node) + "/16", "dev", "eth0")
        self._moves[node] = self._moves.get(node, 0) + 1
        run(*inside, "add", self.address(node) + "/16", "dev", "eth0")
        for other in self.nodes:
            self._write_rules(other)

    def start(self, node, argv, space=None, **how):
        """Starts a program as that node, or inside another one's namespace. It dies with this process. `how` is for
        harness.Process."""
        process = harness.Process(["ip", "netns", "exec", self.space(space or node), *argv], **how)
        self.processes[node] = process
        return process

    def kill(self, node):
        """kill -9, and waits for the end."""
        self.processes[node].kill()

    def signal(self, node, number):
        """For instance SIGSTOP and SIGCONT, which freeze a node."""
        os.kill(self.processes[node].pid, number)

    def lose(self, percent, origins=None, destinations=None):
        """Drops that share of all packets, at random, between the nodes named (default: all); 100 is a cut."""
        for origin in origins or self.nodes:
            for destination in destinations or self.nodes:
                if origin != destination:
                    self._drops[origin, destination] = percent
        for node in self.nodes:
            self._write_rules(node)

    def cut(self, node):
        """Both ways."""
        self.lose(100, [node])
        self.lose(100, None, [node])

    def heal(self):
        """Ends all loss."""
        self.lose(0)

    def shape(self, node, kbit):
        """Slows down the node's way out. Its packets wait in the kernel, which drops none and so blocks the socket when
        the socket's buffer is full."""
        run("tc", "-n", self.space(node), "qdisc", "replace", "dev", "eth0", "root", "tbf", "rate", f"{kbit}kbit", "burst",
            "2000", "limit", "100000000")

    def arp(self, switched):
        """"off": no node learns or keeps a hardware address (ARP, RFC 826) of another, so that it reaches the others by
        broadcast and multicast alone."""
        policy = "accept" if switched == "on" else "drop"
        text = ("table arp field {\n chain arriving {\n"
                f"  type filter hook input priority 0; policy {policy};\n }}\n}}\n")
        for node in self.nodes:
            try:
                run_in(self.space(node), "nft", "-f", "-", text=text)
            except subprocess.CalledProcessError as error:
                raise Unsupported(f"nftables does not filter ARP here: {error.stdout}") from error
            run("ip", "-n", self.space(node), "neighbour", "flush", "all")

    def traffic(self, node):
        """Bytes that the node has sent and received so far."""
        counts = [run_in(self.space(node), "cat", f"/sys/class/net/eth0/statistics/{name}")
                  for name in ("tx_bytes", "rx_bytes")]
        return tuple(map(int, counts))

    def dropped(self, node):
        """Packets on their way to the node that were dropped since the rules changed last."""
        rules = run_in(self.space(node), "nft", "list", "table", "ip", "field")
        return sum(map(int, re.findall(r"counter packets (\d+)", rules)))

    def space(self, name):
        return self._prefix + name

    def _make_space(self, name):
        # Listed before the namespace is made, so that it is removed even if a signal comes in between.
        self._made.append(self.space(name))
        try:
            run("ip", "netns", "add", self.space(name))
        except subprocess.CalledProcessError as error:
            raise Unsupported(f"no network namespaces here: {error.stdout}") from error

    def _build(self):
        self.folder = tempfile.mkdtemp(prefix=self._prefix)
        self._connect()
        self._probe_rules()
        for node in self.nodes:
            self._write_rules(node)

    # The probes alone tell what this machine does not allow. A later command that fails is a mistake in this file, and
    # must not skip the test.
    def _probe_devices(self):
        inside = ["ip", "-n", self.space("switch"), "link"]
        try:
            run(*inside, "add", "probe0", "type", "bridge")
            run(*inside, "add", "probe1", "type", "veth", "peer", "name", "probe2")
        except subprocess.CalledProcessError as error:
            raise Unsupported(f"no network of namespaces can be made here: {error.stdout}") from error
        for device in ("probe0", "probe1"):
            run(*inside, "del", device)

    def _probe_rules(self):
        text = ("table ip probe {\n chain arriving {\n  type filter hook input priority 0;\n }\n}\n"
                "delete table ip probe\n")
        try:
            run_in(self.space(self.nodes[0]), "nft", "-f", "-", text=text)
        except subprocess.CalledProcessError as error:
            raise Unsupported(f"nftables does not work here: {error.stdout}") from error

    def _connect(self):
        """Makes each node's namespace, and in it a device eth0 that reaches all others."""
        self._make_space("switch")
        self._probe_devices()
        switch = ["ip", "-n", self.space("switch"), "link"]
        run(*switch, "add", "br0", "type", "bridge", "mcast_snooping", "0")
        run(*switch, "set", "br0", "up")
        for number, node in enumerate(self.nodes):
            self._make_space(node)
            run(*switch, "add", f"p{number}", "type", "veth", "peer", "name", "eth0", "netns", self.space(node))
            run(*switch, "set", f"p{number}", "master", "br0", "up")
            self._switch_on(node)

    def _switch_on(self, node):
        inside = ["ip", "-n", self.space(node)]
        run(*inside, "address", "add", self.address(node) + "/16", "dev", "eth0")
        run(*inside, "link", "set", "lo", "up")
        run(*inside, "link", "set", "eth0", "up")
        if self._multicast:
            run(*inside, "route", "add", "224.0.0.0/4", "dev", "eth0")

    # Dropped on arrival: the kernel would report a drop on the way out to the sender's socket.
    def _write_rules(self, node):
        rules = [] if self._multicast else ["ip daddr 224.0.0.0/4 drop"]
        for (origin, destination), percent in self._drops.items():
            if destination == node and percent > 0:
                share = "" if percent >= 100 else f"numgen random mod 100 < {percent} "
                rules.append(f"ip saddr {self.address(origin)} {share}counter drop")
        text = ("add table ip field\ndelete table ip field\ntable ip field {\n chain arriving {\n"
                "  type filter hook input priority 0;\n  " + "\n  ".join(rules) + "\n }\n}\n")
        run_in(self.space(node), "nft", "-f", "-", text=text)

    def _remove(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)
        for process in self.processes.values():
            if process.running():
                process.kill()
        for name in self._made:
            subprocess.run(["ip", "netns", "del", name], check=False, stderr=subprocess.DEVNULL)
        if self.folder:
            shutil.rmtree(self.folder, ignore_errors=True)
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_DFL)
