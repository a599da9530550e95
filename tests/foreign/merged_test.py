#!/usr/bin/env python3
"""Plain programs of each vendor read the samples that a node with a budget sends several to a datagram.

Usage: merged_test.py NODE TRANSPORT,... PLAIN_PROGRAM...
Ends with 77 where no network namespace can be made, or no packets can be captured."""

import pathlib
import socket
import struct
import sys
import tempfile
import threading

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "integration"), str(HERE.parent / "bench" / "radio")]
import harness  # noqa: E402
from census import SAMPLES, TO_THE_END  # noqa: E402
from foreign_test import CYCLONE, LIMIT_S  # noqa: E402

CONFIG = """
node: uav1
domain: {domain}
transport: {transport}
interfaces: [127.0.0.1]
radio: {{budget: 20kB/s}}
foreign:
  - {{publish: Setpoint, topic: rt/fmu/in/trajectory_setpoint, type: px4_msgs::msg::TrajectorySetpoint, names: ros2,
     reliability: best_effort}}
  - {{publish: Words, topic: words, type: std_msgs::msg::String, names: ros2, reliability: best_effort}}
  - {{publish: Names, topic: names, type: std_msgs::msg::String, names: ros2, reliability: best_effort}}
  - {{publish: Orders, topic: orders, type: std_msgs::msg::String, names: ros2, each: queue}}
"""
TOPICS = ["read:rt/fmu/in/trajectory_setpoint:setpoint:best_effort:volatile",
          "read:rt/words:string:best_effort:volatile",
          "read:rt/names:string:best_effort:volatile",
          "read:rt/orders:string:reliable:volatile"]
MANY = 100  # samples of each topic
FEW = 20  # datagrams of several samples
EVERYTHING = 3  # Ethernet: all protocols


def writers_in(message):
    """The writers of the topics whose samples an RTPS message has, each once."""
    found = set()
    at = 20
    while at + 4 <= len(message):
        kind, flags = message[at], message[at + 1]
        size = struct.unpack_from("<H" if flags & 1 else ">H", message, at + 2)[0]
        if size == 0 and kind not in TO_THE_END:
            size = len(message) - at - 4
        if kind in SAMPLES and size >= 12:
            writer = struct.unpack_from(">I", message, at + 4 + 8)[0]
            found.update([writer] if writer & 0xc0 == 0 else [])
        at += 4 + size
    return found


class Capture(threading.Thread):
    """Counts the datagrams on the loopback that have samples of several writers."""

    def __init__(self):
        super().__init__(daemon=True)
        self.merged = 0
        self._heard = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(EVERYTHING))
        self._heard.bind(("lo", 0))

    def run(self):
        while True:
            frame = self._heard.recv(65536)
            packet = frame[14:]
            if frame[12:14] != b"\x08\x00" or len(packet) < 28 or packet[9] != socket.IPPROTO_UDP:
                continue
            message = packet[(packet[0] & 15) * 4 + 8:]
            if message[:4] == b"RTPS" and len(writers_in(message)) > 1:
                self.merged += 1


def numbers(process, topic):
    """The numbers that the program read on the topic, in their order."""
    texts = [text.split() for _, text in process.lines if text.startswith(f"got {topic} ")]
    return [int(words[2]) for words in texts]


def exchange(node, transport, plain, folder, domain):
    """Lets the program read MANY samples of each topic, in datagrams of several."""
    config = folder / f"{domain}.yaml"
    config.write_text(CONFIG.format(domain=domain, transport=transport))
    capture = Capture()
    capture.start()
    topics = [description.split(":")[1] for description in TOPICS]
    with harness.Processes() as processes:
        reader = processes.start([plain, domain, *TOPICS], {"CYCLONEDDS_URI": CYCLONE})
        processes.start([node, config])

        def many_came():
            return all(len(numbers(reader, topic)) >= MANY for topic in topics) and capture.merged >= FEW
        harness.until(many_came, LIMIT_S)
        read = {topic: numbers(reader, topic) for topic in topics}
    for topic, values in read.items():
        assert all(a < b for a, b in zip(values, values[1:])), f"{topic}: {values}"
    orders = read["rt/orders"]
    assert orders == list(range(orders[0], orders[0] + len(orders))), orders


def main():
    node, transports, plain = sys.argv[1], sys.argv[2].split(","), sys.argv[3:]
    harness.enter_namespace_or_skip()
    try:
        Capture()
    except PermissionError:
        harness.skip("no packets can be captured")
    failures = []
    pairs = [(transport, program) for transport in transports for program in plain]
    with tempfile.TemporaryDirectory(prefix="rabit_merged_") as folder:
        for i, (transport, program) in enumerate(pairs):
            try:
                exchange(node, transport, program, pathlib.Path(folder), 5 * i)
            except Exception as error:  # the others go on  pylint: disable=broad-except
                failures.append(f"{transport} beside {pathlib.Path(program).name}: {harness.reason(error)}")
    print("\n".join(failures) or f"{len(pairs)} pairs")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
