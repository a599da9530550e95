"""The same as field.py with a radio in place of the bridge: one shared half-duplex channel that the lab's program
gateway/lab/radio emulates. Medium.h there says what it does and leaves out, Report.h what its counters are.

ARP is frames on the air, as it is with real radios, unless the medium has static neighbours."""

import field
from rabit_lab import radio

# The settings of a medium, and their defaults.
MEDIUM = {
    "kbit": 0,  # of the whole medium; 0 is unlimited
    "queue": 16000,  # bytes for each node
    "overhead": 0,  # bytes that each frame takes on the air beyond its own
    "delay_ms": 0,
    "jitter_ms": 0,
    "loss": 0,  # percent, at each receiver
    "duplicate": 0,  # percent of the frames heard, at each receiver
    "seed": 1,
    "static_neighbours": False,
    "pcap": None,  # path of a recording
}


def summary(counters):
    """One line of what was on the air."""
    seconds, sent = counters["seconds"], counters["sent"]
    offered = sum(node["offered"]["bytes"] for node in counters["nodes"].values())
    dropped = sum(node["dropped"]["bytes"] for node in counters["nodes"].values())
    waits = max(node["longest_wait_ms"] for node in counters["nodes"].values())
    return (f"air: {seconds:.0f} s, offered {offered / seconds / 1000:.1f} kB/s, sent {sent['bytes'] / seconds / 1000:.1f} "
            f"kB/s, queues dropped {100 * dropped / max(offered, 1):.0f} %, used {100 * counters['utilisation']:.0f} %, "
            f"longest in a queue {waits:.0f} ms")


class RadioField(field.Field):
    """with RadioField(program, ["ground", "uav1"], {"kbit": 250}) as field: field.start(...); field.rate(100)"""

    def __init__(self, program, nodes, medium=None, multicast=True):
        super().__init__(nodes, multicast)
        unknown = set(medium or {}) - set(MEDIUM)
        if unknown:
            raise ValueError(f"a medium has no {', '.join(sorted(unknown))}")
        self.radio = program
        self._medium = {**MEDIUM, **(medium or {})}
        self._air = None

    def rate(self, kbit):
        """0 is unlimited."""
        self.tell(f"rate {round(1000 * kbit)}" if kbit else "rate unlimited")

    def queue(self, size, node="*"):
        """Bytes."""
        self.tell(f"queue {size} {node}")

    def delay(self, ms, jitter_ms=0, origin="*", destination="*"):
        self.tell(f"delay {ms} jitter {jitter_ms} {origin} {destination}")

    def lose(self, percent, origins=None, destinations=None):
        for origin in origins or "*":
            for destination in destinations or "*":
                self.tell(f"loss {percent} {origin} {destination}")

    def deaf(self, node, origin="*"):
        """The node hears nothing of the origin, which goes on hearing it."""
        self.tell(f"deaf {node} {origin}")

    def hear(self, node, origin="*"):
        self.tell(f"hear {node} {origin}")

    def forget_neighbours(self):
        """The nodes' kernels know no hardware addresses any more, as where nodes have never met."""
        for node in self.nodes:
            field.run("ip", "-n", self.space(node), "neighbour", "flush", "all")

    def outage(self, switched):
        """"on" or "off": nobody hears anything, and the senders do not notice."""
        self.tell(f"outage {switched}")

    def heal(self):
        """Ends all loss, deafness and outage."""
        self.lose(0)
        self.hear("*")
        self.outage("off")

    def counters(self):
        return self.tell("counters")

    def kinds(self):
        """{node: {kind of frame: [frames, bytes]}}"""
        return self.tell("kinds")

    def reset(self):
        """All counters from zero."""
        self.tell("reset")

    def lateness(self):
        """By how much the program itself was late since this was asked last."""
        return self.tell("lateness")

    def overrun(self):
        """Frames that the kernel dropped because the program was too slow: more than none makes a measurement void."""
        return sum(int(field.run_in(self.space(node), "cat", "/sys/class/net/eth0/statistics/tx_dropped"))
                   for node in self.nodes)

    def tell(self, line):
        """A command of radio/Console.h, and the answer."""
        return self._air.tell(line)

    def _connect(self):
        for node in self.nodes:
            self._make_space(node)
        medium = self._medium
        self._air = radio.Radio(self.radio, {node: self.space(node) for node in self.nodes}, 1000 * medium["kbit"],
                                medium["queue"], medium["overhead"], medium["seed"], medium["pcap"])
        for node in self.nodes:
            self._switch_on(node)
            if medium["static_neighbours"]:
                self._introduce(node, self._air.ready["addresses"])
        self.delay(medium["delay_ms"], medium["jitter_ms"])
        self.lose(medium["loss"])
        self.tell(f"duplicate {medium['duplicate']}")

    def _introduce(self, node, addresses):
        for other in self.nodes:
            if other != node:
                field.run("ip", "-n", self.space(node), "neighbour", "add", self.address(other),
                          "lladdr", addresses[other], "dev", "eth0", "nud", "permanent")

    def _remove(self):
        super()._remove()
        if self._air and self._air.running():
            self._air.kill()
