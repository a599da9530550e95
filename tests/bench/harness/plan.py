"""What is measured: cases, each with its contestants. A case is run again and again, its contestants in turn, so that
what disturbs the machine disturbs all of them."""

from dataclasses import dataclass, field

from contestants import LOCAL, NODE, RAW_LISTENER, RAW_THREADS, RAW_WORKER

SIZES = {"100 B": 100, "1 kB": 1000, "64 kB": 65536, "1 MB": 1_000_000}
ROUND_TRIPS = {"100 B": 10000, "1 kB": 5000, "64 kB": 2000, "1 MB": 300}
IN_ONE_DIRECTION = {"100 B": 200_000, "64 kB": 3000, "1 MB": 200}
FLEETS = [2, 5, 10, 20, 40]
# Sizes of the fleets of a short run, which takes the first transport alone.
QUICK_FLEETS = [2, 5]


# The parts, each measured, written and compared by itself.
PAIRS = "pairs"
PARTS = (PAIRS, "fleet", "instructions")


@dataclass
class Case:
    measure: str  # latency, throughput, start-up, idle, fleet, instructions
    transport: str
    carriage: str = ""
    size: str = ""
    contestants: list = field(default_factory=list)
    options: dict = field(default_factory=dict)

    def part(self):
        """The part of the results that it belongs to."""
        return self.measure if self.measure in PARTS else PAIRS

    def key(self):
        return " ".join(part for part in (self.measure, self.transport, self.carriage, self.size) if part)


def options_of(carriage, size, count):
    return {"carriage": carriage, "payload": SIZES[size], "count": count, "warm-up": max(count // 10, 20)}


def latency(transports, scale):
    for carriage, sizes in (("state", SIZES), ("queue", SIZES), ("telemetry", ["100 B", "1 kB"])):
        for size in sizes:
            options = options_of(carriage, size, max(int(ROUND_TRIPS[size] * scale), 100))
            for transport in transports:
                contestants = [RAW_WORKER, NODE, RAW_THREADS, RAW_LISTENER]
                if (carriage, transport) == ("queue", "cyclonedds"):
                    # It may wait until it gives up, and ends: a listener of Cyclone DDS that writes waits for
                    # acknowledgements, which the same thread would receive.
                    contestants.remove(RAW_LISTENER)
                yield Case("latency", transport, carriage, size, contestants, options)
            if carriage != "telemetry":
                yield Case("latency", "none", carriage, size, [LOCAL], options)


def throughput(transports, scale):
    for size, count in IN_ONE_DIRECTION.items():
        for transport in transports:
            options = options_of("queue", size, max(int(count * scale), 100))
            yield Case("throughput", transport, "queue", size, [RAW_WORKER, NODE], options)


def fleet(transports):
    for carriage, hertz in (("state", 10), ("telemetry", 10), ("state", 2)):
        for transport in transports:
            for size in FLEETS:
                options = {"carriage": carriage, "payload": SIZES["100 B"], "members": size,
                           "period": 1_000_000_000 // hertz}
                yield Case("fleet", transport, carriage, f"{size} nodes at {hertz} Hz", [RAW_WORKER, NODE], options)


def instructions(transports):
    for carriage in ("state", "telemetry", "queue"):
        for transport in transports:
            options = {"carriage": carriage, "payload": SIZES["100 B"], "warm-up": 100}
            yield Case("instructions", transport, carriage, "100 B", [RAW_WORKER, NODE], options)


def all_cases(transports, scale):
    yield from latency(transports, scale)
    yield from throughput(transports, scale)
    for transport in transports:
        yield Case("start-up", transport, contestants=[RAW_WORKER, NODE])
    for transport in transports:
        yield Case("idle alone", transport, contestants=[RAW_WORKER, NODE])
        yield Case("idle pair", transport, contestants=[RAW_WORKER, NODE])
    yield from fleet(transports)
    yield from instructions(transports)


def a_few(cases):
    """Of each measure one case for each transport and carriage, the smallest one; of fleets two and of instructions
    none, which take long."""
    seen = set()
    few = []
    for case in cases:
        kind = (case.measure, case.transport, case.carriage)
        if case.measure == "fleet" and case.options["members"] in QUICK_FLEETS:
            kind = (case.measure, case.options["members"])
        elif case.measure in ("fleet", "instructions"):
            continue
        if kind not in seen:
            seen.add(kind)
            few.append(case)
    return few
