#!/usr/bin/env python3
"""The radio, measured with datagrams between namespaces. Judged by its counters, which are of virtual air time, and by
what arrives; how fast this machine is decides nothing, as long as the senders keep their queues filled.

Usage: radio_test.py RADIO"""

import ctypes
import json
import os
import socket
import sys
import threading
import time

import field
import harness
import radio_field

NODES = ["ground", "uav1", "uav2"]
GROUP, PORT = "239.255.0.1", 7400
PAYLOAD = 1000
FRAME = PAYLOAD + 8 + 20 + 14  # UDP, IPv4, Ethernet
QUEUE = 16000
LIMIT_S = 300  # only keeps a broken test from hanging
CLONE_NEWNET = 0x40000000


def socket_of(ground, node):
    """A socket in the node's namespace, bound to PORT and a member of GROUP. A namespace is a thread's."""
    made = []

    def make():
        with open(f"/run/netns/{ground.space(node)}", "rb") as space:
            if ctypes.CDLL(None, use_errno=True).setns(space.fileno(), CLONE_NEWNET) != 0:
                raise OSError(ctypes.get_errno(), "setns")
        made.append(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))

    thread = threading.Thread(target=make)
    thread.start()
    thread.join()
    one = made[0]
    one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
    one.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP, 0)
    one.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(ground.address(node)))
    one.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                   socket.inet_aton(GROUP) + socket.inet_aton(ground.address(node)))
    one.bind(("", PORT))
    one.setblocking(False)
    return one


def drain(one):
    """How many datagrams have come."""
    count = 0
    while True:
        try:
            one.recv(65536)
            count += 1
        except BlockingIOError:
            return count


def wait_until(holds, what):
    end = time.monotonic() + LIMIT_S
    while not holds():
        if time.monotonic() > end:
            raise AssertionError(f"not within {LIMIT_S} s: {what}")
        time.sleep(0.05)


def near(value, wanted, tolerance, what):
    assert abs(value - wanted) <= tolerance * wanted, f"{what}: {value}, wanted {wanted}"
    print(f"{what}: {value:.4g}, wanted {wanted:.4g}")


def quiet(ground):
    """Until nothing waits and nothing was on the air for a while: joins and ARP are over."""
    def still():
        before = ground.counters()["sent"]["frames"]
        time.sleep(1)
        after = ground.counters()
        return after["sent"]["frames"] == before and not any(node["queued"] for node in after["nodes"].values())
    wait_until(still, "a quiet medium")
    ground.reset()


class Flood:
    """with Flood(...): sends twice what the medium carries."""

    def __init__(self, one, address, kbit):
        self._one, self._address, self._period = one, address, FRAME * 8 / (2000 * kbit)
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._over.set()
        self._thread.join()

    def _run(self):
        while not self._over.wait(self._period):
            try:
                self._one.sendto(bytes(PAYLOAD), (self._address, PORT))
            except BlockingIOError:
                pass  # the socket is full as well


def measure(ground, sockets, seconds):
    """The counters of that time, at the beginning of which the sender's queue is full, and how many datagrams came."""
    wait_until(lambda: ground.counters()["nodes"]["uav1"]["dropped"]["frames"] > 0, "a full queue")
    drain(sockets["ground"])
    ground.reset()
    time.sleep(seconds)
    return ground.counters(), drain(sockets["ground"])


def rate_and_queue(ground, sockets):
    """Twice the rate is offered: the rate arrives, the queue is as long as it may be, and a new rate takes effect."""
    kbit = 100
    ground.rate(kbit)
    with Flood(sockets["uav1"], ground.address("ground"), kbit):
        counters, heard = measure(ground, sockets, 4)
        sender = counters["nodes"]["uav1"]
        near(8 * counters["sent"]["bytes"] / counters["seconds"], 1000 * kbit, 0.03, "bit/s on the air")
        near(8 * heard * FRAME / counters["seconds"], 1000 * kbit, 0.05, "bit/s heard, a frame more or less")
        near(sender["longest_wait_ms"], 8 * QUEUE / kbit, 0.08, "longest wait in the queue, ms")
        near(sender["most_in_a_second"], 125 * kbit, 0.09, "bytes in the worst second, a frame more or less")
        assert sender["dropped"]["frames"] > 0, sender
        ground.rate(kbit / 2)
        counters, _ = measure(ground, sockets, 4)
        near(8 * counters["sent"]["bytes"] / counters["busy_s"], 500 * kbit, 0.03, "bit/s at half the rate")
        assert counters["utilisation"] > 0.97, counters
    ground.rate(0)
    quiet(ground)
    drain(sockets["ground"])


def multicast_once(ground, sockets):
    ground.rate(1000)
    for _ in range(10):
        sockets["uav1"].sendto(bytes(PAYLOAD), (GROUP, PORT))
    heard = {node: 0 for node in NODES}

    def all_heard():
        for node in ("ground", "uav2"):
            heard[node] += drain(sockets[node])
        return heard["ground"] == heard["uav2"] == 10
    wait_until(all_heard, "ten datagrams at each of the others")
    counters = ground.counters()
    near(counters["busy_s"], 10 * FRAME * 8 / 1e6, 0.001, "air of ten multicast datagrams for two, s")
    assert counters["nodes"]["uav1"]["multicast"]["frames"] == 10, counters
    assert counters["nodes"]["uav1"]["unicast"]["frames"] == 0, counters


def deaf_one_way(ground, sockets):
    """uav1 does not hear uav2, which hears it; the ground station hears and is heard by both."""
    ground.deaf("uav1", "uav2")
    quiet(ground)
    for node in NODES:
        sockets[node].sendto(bytes(PAYLOAD), (GROUP, PORT))
    wait_until(lambda: ground.counters()["sent"]["frames"] == 3, "three frames on the air")
    quiet(ground)
    heard = {node: drain(sockets[node]) for node in NODES}
    assert heard == {"ground": 2, "uav1": 1, "uav2": 2}, heard
    ground.heal()


def outage(ground, sockets):
    ground.outage("on")
    sockets["uav1"].sendto(bytes(PAYLOAD), (GROUP, PORT))
    wait_until(lambda: ground.counters()["nodes"]["ground"]["missed"] == 1, "a frame that nobody hears")
    ground.heal()
    sockets["uav1"].sendto(bytes(PAYLOAD), (GROUP, PORT))
    wait_until(lambda: ground.counters()["nodes"]["ground"]["heard"]["frames"] == 1, "a frame after it")
    quiet(ground)
    heard = {node: drain(sockets[node]) for node in NODES}
    assert heard == {"ground": 1, "uav1": 0, "uav2": 1}, heard


def delay(ground, sockets):
    """A datagram is not heard before its delay is over."""
    ground.delay(1000)
    sockets["uav1"].sendto(bytes(PAYLOAD), (GROUP, PORT))
    sent = time.monotonic()
    wait_until(lambda: drain(sockets["ground"]) == 1, "a datagram")
    assert time.monotonic() - sent >= 1, "too early"
    ground.delay(0)


def control_socket(ground, _sockets):
    """A second radio, told by a Unix socket: two at once, a line that is too long, and its end by SIGTERM."""
    path = os.path.join(ground.folder, "control")
    radio = harness.Process([ground.radio, "--node", f"only={ground.space('ground')}", "--device", "air1",
                             "--control", path])
    radio.wait_for(lambda text: '"ready":true' in text, LIMIT_S)
    with socket.socket(socket.AF_UNIX) as first, socket.socket(socket.AF_UNIX) as second:
        first.connect(path)
        second.connect(path)
        for one, line, answer in ((first, b"rate 5000\n", {"ok": True}),
                                  (second, b"fly\n", {"error": "unknown command: fly"})):
            one.sendall(line)
            assert json.loads(one.makefile().readline()) == answer
        second.sendall(bytes(5000))
        try:
            assert second.recv(100) == b"", "a line that is too long was answered"
        except ConnectionResetError:
            pass  # with what it has not read
        first.sendall(b"counters\n")
        assert json.loads(first.makefile().readline())["bits_per_s"] == 5000
    assert radio.terminate() == 0, radio.lines
    assert not os.path.exists(path), "the socket is left"


def silence(ground):
    """Devices that nobody uses say nothing."""
    time.sleep(3)
    assert ground.counters()["sent"]["frames"] == 0, ground.kinds()


def main():
    with field.skipping():
        with radio_field.RadioField(os.path.abspath(sys.argv[1]), NODES) as ground:
            silence(ground)
            sockets = {node: socket_of(ground, node) for node in NODES}
            for node in ("uav1", "uav2"):  # ARP
                sockets[node].sendto(b"", (ground.address("ground"), PORT))
            quiet(ground)
            for node in NODES:
                drain(sockets[node])
            for part in (rate_and_queue, multicast_once, deaf_one_way, outage, delay, control_socket):
                quiet(ground)
                part(ground, sockets)
                print(f"ok: {part.__name__}")
            print(f"lateness of the program: {ground.lateness()}")
            assert ground.overrun() == 0, "the program was too slow for this machine"


if __name__ == "__main__":
    main()
