#!/usr/bin/env python3
"""Datagrams of published faults of the vendors, sent by a stranger on loopback. Prints for each fault what the installed
vendor does without the guard: a process of its own, which may end. Fails only if nodes with the guard end, or do not hear
each other and a newcomer afterwards.

Usage: vendor_faults_test.py DATAGRAMS PEER TRANSPORT,... PROGRAM...
DATAGRAMS lists the faults; PEER is a session, PROGRAMs are the plain ones of ../../foreign.
Needs to make network namespaces; ends with 77 where it may not."""

import pathlib
import re
import signal
import socket
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
# For the report alone: how long a process without the guard may take to end or to grow.
LOOK_S = 2
# A process that wants more ends.
MOST_BYTES = 4 << 30
AT_ONCE = 4
# Its last datagram is the goodbye.
FORGED_GOODBYE = "CVE-2023-50257"


class Fault:
    def __init__(self, line):
        self.name, self.vendor, *datagrams = line.split()
        self.datagrams = [bytes.fromhex(each) for each in datagrams]
        self.result = self.failure = None

    def send(self, domain):
        """To all ports that participants of the domain on this host may have (RTPS 2.3, 9.6.1)."""
        first = 7400 + 250 * domain
        ends = [("239.255.0.1", first)]
        ends += [("127.0.0.1", first + 10 + 2 * number + user) for number in range(4) for user in (0, 1)]
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
            stranger.bind(("127.0.0.1", 0))
            stranger.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
            for datagram in self.datagrams:
                for end in ends:
                    try:
                        stranger.sendto(datagram, end)
                    except ConnectionRefusedError:  # of the datagram before: nobody has that port
                        stranger.sendto(datagram, end)
                # The vendors read an announcement and what follows it from different sockets.
                time.sleep(0.1)


def prefix_of(message):
    """The participant in the header of a message (RTPS 2.3, 9.4.4)."""
    return message[8:20]


def prefixes(domain, count, stranger):
    """The participants that announce themselves to all, once there are so many."""
    found = set()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ear:
        ear.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        ear.bind(("239.255.0.1", 7400 + 250 * domain))
        ear.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                       socket.inet_aton("239.255.0.1") + socket.inet_aton("127.0.0.1"))
        ear.settimeout(LIMIT_S)
        while len(found) < count:
            message = ear.recv(65536)
            if message.startswith(b"RTPS") and prefix_of(message) != stranger:
                found.add(prefix_of(message))
    return found


def memory_mb(process):
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text(encoding="ascii")
    found = re.search(r"VmHWM:\s+(\d+) kB", status)
    return int(found.group(1)) // 1024 if found else 0


def watch(process):
    """What becomes of a process that has got a fault."""
    before = largest = memory_mb(process)
    end = time.monotonic() + LOOK_S
    while time.monotonic() < end and process.running():
        largest = max(largest, memory_mb(process))
        time.sleep(0.05)
    if not process.running():
        code = process.exit_code(LIMIT_S)
        how = signal.Signals(-code).name if code < 0 else f"exit code {code}"
        said = [text for _, text in process.lines if re.search("Assert|what|free|corrupt", text)]
        return f"ends with {how}" + (f": {said[-1][-100:]}" if said else "")
    return f"lives, and grows from {before} to {largest} MB" if largest > 2 * before else "lives"


def without_guard(fault, domain, plain):
    """A program of the vendor alone."""
    with harness.Processes() as processes:
        victim = processes.start(["prlimit", f"--as={MOST_BYTES}", plain[fault.vendor], domain,
                                  "read:State:string:reliable:volatile"])
        victim.wait_for(re.compile("ready").fullmatch, LIMIT_S)
        fault.send(domain)
        return watch(victim)


class Unguarded:
    """Faults one after the other, each in a domain of its own."""

    def __init__(self, faults, domain, plain):
        self.faults, self.domain, self.plain = faults, domain, plain

    def run(self):
        for number, fault in enumerate(self.faults):
            try:
                fault.result = without_guard(fault, self.domain + number, self.plain)
            except Exception as error:  # the others go on
                fault.result = f"not tried: {error}"


class Guarded:
    """Two nodes over a vendor, with keys or without, which get all faults, then meet a third one. Those without keys at last get
    goodbyes in each other's names. They hear each other all the while, or again."""

    def __init__(self, faults, transport, keys, domain, peer):
        self.faults, self.transport, self.keys, self.domain, self.peer = faults, transport, keys, domain, peer
        self.failure = None

    def run(self):
        try:
            with harness.Processes() as processes:
                self.meet(processes)
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)

    def hears_more(self, node, other):
        heard = [int(text.split()[2]) for _, text in node.lines if text.startswith(f"heard {other} ")]
        # From the tenth on, every tenth sample is told of.
        node.wait_for(re.compile(f"heard {other} {(heard[-1] // 10 + 3) * 10 if heard else 20}").fullmatch, LIMIT_S)

    def start(self, processes, name):
        return processes.start([self.peer, self.transport, name, self.domain, *(["fleet"] if self.keys else [])])

    def meet(self, processes):
        names = ("first", "second")
        nodes = [self.start(processes, name) for name in names]
        pairs = list(zip(nodes, reversed(names)))
        for node, other in pairs:
            self.hears_more(node, other)
        for fault in self.faults:
            fault.send(self.domain)
            for node, name in zip(nodes, names):
                if not node.running():
                    raise AssertionError(f"{name} ended with {node.exit_code(LIMIT_S)} after {fault.name}")
        for node, other in pairs:
            self.hears_more(node, other)
        newcomer = self.start(processes, "newcomer")
        for node, name in zip(nodes, names):
            self.hears_more(node, "newcomer")
            self.hears_more(newcomer, name)
        if self.keys:
            return  # no datagram shows their participants
        self.forge_goodbyes()
        for node, other in pairs:
            gone = [when for when, text in node.lines if text == f"gone {other}"]
            if gone:
                node.wait_for(f"appeared {other}".__eq__, LIMIT_S, gone[-1])
            self.hears_more(node, other)

    def forge_goodbyes(self):
        fault = next(fault for fault in self.faults if fault.name == FORGED_GOODBYE)
        *_, goodbye = fault.datagrams
        forged = Fault(f"{fault.name} {fault.vendor}")
        for name in prefixes(self.domain, 3, stranger=prefix_of(goodbye)):
            forged.datagrams.append(goodbye.replace(prefix_of(goodbye), name))
        forged.send(self.domain)


def main():
    datagrams, peer = sys.argv[1:3]
    transports = sys.argv[3].split(",")
    plain = {("fastdds" if "fastdds" in path else "cyclonedds"): path for path in sys.argv[4:]}
    harness.enter_namespace_or_skip()
    listed = subprocess.run([datagrams], check=True, capture_output=True, text=True).stdout
    faults = [Fault(line) for line in listed.splitlines()]
    installed = [fault for fault in faults if fault.vendor in transports]
    # Nodes get the faults of both vendors: the guard is the same.
    guarded = [Guarded(faults, transport, keys, 60 + 2 * i + keys, peer)
               for i, transport in enumerate(transports) for keys in (False, True)]
    harness.run_at_once([*guarded, *(Unguarded(installed[i::AT_ONCE], 1 + 10 * i, plain) for i in range(AT_ONCE))])
    for fault in installed:
        print(f"{fault.vendor} {fault.name}, without the guard: {fault.result}")
    for case in guarded:
        print(f"nodes over {case.transport}{' with keys' if case.keys else ''}: {case.failure or 'live and hear each other'}")
    sys.exit(1 if any(case.failure for case in guarded) else 0)


if __name__ == "__main__":
    main()
