#!/usr/bin/env python3
"""Two nodes with two networks each, a mesh of 10 Mbit/s and a modem: how commands and telemetry get through while one of
them dies, flaps or is all there is. gateway/paths has what is measured. Needs root.

Usage: paths.py LEDGER_NODE TRANSPORT cuts|flap|thin|both [--tries N] [--rate HZ] [--seconds N] [--modem KBIT] [--budget B/s]

cuts: the network in use is cut for 3 s, again and again. flap: the mesh is there and gone in turns, compared with the
modem alone. thin: the mesh is cut for a minute, while notes of 20 kB of class bulk wait. both: bytes on each network while
both are there, and of the mesh alone."""

import argparse
import pathlib
import signal
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integration"))
import field  # noqa: E402
import judge  # noqa: E402
import paths_test  # noqa: E402

PAYLOAD = 50
MESH_KBIT = 10_000
DEVICES = paths_test.DEVICES


def percentile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))] if values else float("nan")


def wait_for(what, limit_s):
    begin = time.monotonic()
    while not what():
        assert time.monotonic() - begin < limit_s, "not within the limit"
        time.sleep(0.05)


def ledger(ground, node):
    path = pathlib.Path(ground.folder, node + ".ledger")
    return path.read_text() if path.exists() else ""


def now():
    return time.clock_gettime(time.CLOCK_MONOTONIC)


class Networks(paths_test.TwoNetworks):
    def _connect(self):
        super()._connect()
        for node in self.nodes:
            self.shape(node, MESH_KBIT)

    def sent_by_all(self):
        return {name: sum(self.sent(node, device) for node in self.nodes) for name, device in DEVICES.items()}

    def rates(self, seconds):
        """Bytes a second on each network."""
        before = self.sent_by_all()
        time.sleep(seconds)
        return {name: (after - before[name]) / seconds for name, after in self.sent_by_all().items()}

    def in_use(self):
        rates = self.rates(0.5)
        return max(rates, key=rates.get)


class Flight:
    """The ground station sends commands to uav1, which publishes ten ticks a second."""

    def __init__(self, ground, options, paths=("mesh", "modem"), more=()):
        self.ground = ground
        for node in ground.nodes:
            arguments = [options.ledger_node, "--node", node, "--ledger", f"{ground.folder}/{node}.ledger", "--ticks"]
            for path in paths:
                budget = f":{options.budget}" if path == "modem" and options.budget else ""
                arguments += ["--path", f"{path}:{options.transport}:{DEVICES[path]}{budget}"]
            if node == "ground":
                arguments += ["--to", "uav1", "--count", "1000000000", "--rate", str(options.rate), "--capacity", "5000",
                              "--payload", str(PAYLOAD)]
                arguments += ["--tick-period-ns", "10000000000", *more]
            else:
                arguments += ["--take-pictures"] if more else []
            ground.start(node, arguments)
        wait_for(lambda: " delivered " in ledger(ground, "uav1"), 30)
        time.sleep(4)

    def end(self):
        """Stops both, the sender first, and returns their lives, by node."""
        for node in self.ground.nodes:
            self.ground.signal(node, signal.SIGINT)
            time.sleep(1)
        wait_for(lambda: not any(p.running() for p in self.ground.processes.values()), 20)
        return {node: judge.read_ledger(ledger(self.ground, node)) for node in self.ground.nodes}


def sent_and_delivered(lives):
    """(when sent, when delivered) of each command, in seconds."""
    sent = {event.number("id"): event.time for life in lives["ground"] for event in life.of("intent")}
    return sorted((sent[event.number("id")] * 1e-9, event.time * 1e-9)
                  for life in lives["uav1"] for event in life.of("delivered"))


def wrong_in(lives):
    """Lost ones among those sent until a second before the end, those twice and those out of order."""
    ids = [event.number("id") for life in lives["uav1"] for event in life.of("delivered")]
    accepted = [event.number("id") for life in lives["ground"] for event in life.of("accepted")]
    lost = len([number for number in accepted if number <= max(ids)]) - len(set(ids))
    return {"commands": len(ids), "lost": lost, "twice": len(ids) - len(set(ids)),
            "out of order": sum(later < earlier for earlier, later in zip(ids, ids[1:]))}


def ages(lives, begin, end):
    """The age of the newest tick at the ground station, twenty times a second."""
    made = [(event.time * 1e-9, float(event["age_s"])) for life in lives["ground"] for event in life.of("tick")]
    found = []
    index = 0
    moment = begin
    while moment < end and made:
        while index + 1 < len(made) and made[index + 1][0] <= moment:
            index += 1
        found.append(moment - made[index][0] + made[index][1])
        moment += 0.05
    return found


def told(lives, begin, end):
    delays = [got - sent for sent, got in sent_and_delivered(lives) if begin <= sent < end]
    old = ages(lives, begin, end)
    return (f"command p50 {percentile(delays, 0.5) * 1000:.0f} p90 {percentile(delays, 0.9) * 1000:.0f} "
            f"p99 {percentile(delays, 0.99) * 1000:.0f} worst {max(delays) * 1000:.0f} ms; tick's age p50 "
            f"{percentile(old, 0.5) * 1000:.0f} p90 {percentile(old, 0.9) * 1000:.0f} p99 {percentile(old, 0.99) * 1000:.0f} ms; "
            f"{len(delays)} commands")


def cuts(options):
    with Networks(["ground", "uav1"], options.modem) as ground:
        flight = Flight(ground, options)
        times = []
        of = {name: 0 for name in DEVICES}
        for _ in range(options.tries):
            name = ground.in_use()
            of[name] += 1
            times.append(now())
            ground.cut_network(name)
            time.sleep(3)
            ground.heal_network()
            time.sleep(3)
        lives = flight.end()
    at = [got for _, got in sent_and_delivered(lives)]
    gaps = []
    for cut in times:
        moments = [moment for moment in at if cut - 0.2 <= moment <= cut + 3]
        gaps.append(max(later - earlier for earlier, later in zip(moments, moments[1:])))
    print(f"{options.tries} cuts ({of}): gap p50 {percentile(gaps, 0.5) * 1000:.0f} p90 {percentile(gaps, 0.9) * 1000:.0f} "
          f"p99 {percentile(gaps, 0.99) * 1000:.0f} worst {max(gaps) * 1000:.0f} ms; {wrong_in(lives)}")


def flap(options):
    with Networks(["ground", "uav1"], options.modem) as ground:
        flight = Flight(ground, options)
        spans = []
        ground.cut_network("mesh")
        time.sleep(5)
        spans.append(("the modem alone", now(), now() + options.seconds))
        time.sleep(options.seconds)
        ground.heal_network()
        for period in (1, 2):
            time.sleep(65)  # until the mesh counts as sound again
            begin = now()
            while now() - begin < options.seconds:
                ground.cut_network("mesh")
                time.sleep(period)
                ground.heal_network()
                time.sleep(period)
            spans.append((f"the mesh {period} s gone, {period} s there", begin, now()))
        lives = flight.end()
    for name, begin, end in spans:
        print(f"{name}: {told(lives, begin, end)}")
    print(wrong_in(lives))


def thin(options):
    with Networks(["ground", "uav1"], options.modem) as ground:
        flight = Flight(ground, options, more=["--pictures-to", "uav1", "--pictures", "1000", "--picture-bytes", "20000", "--picture-period-ns", "2000000000"])
        spans = [("both", now(), now() + 10)]
        time.sleep(10)
        ground.cut_network("mesh")
        time.sleep(5)
        begin = now()
        rates = ground.rates(60)
        spans.append(("the modem alone", begin, now()))
        ground.heal_network()
        time.sleep(10)
        lives = flight.end()
    pictures = [event.time * 1e-9 for life in lives["uav1"] for event in life.of("picture")]
    for name, start, end in spans:
        print(f"{name}: {told(lives, start, end)}; bulk {sum(start <= at < end for at in pictures)}")
    changes = sum(event.time * 1e-9 > begin for life in lives["ground"] for event in life.of("peer"))
    print(f"modem {rates['modem']:.0f} B/s of both nodes, limit {options.modem * 125:.0f} B/s a node; "
          f"{changes} changes of uav1's state; {wrong_in(lives)}")


def both(options):
    for paths in (("mesh", "modem"), ("mesh",)):
        with Networks(["ground", "uav1"], options.modem) as ground:
            flight = Flight(ground, options, paths)
            rates = ground.rates(options.seconds)
            flight.end()
        print(f"{' and '.join(paths)}: {' '.join(f'{name} {rate:.0f} B/s' for name, rate in rates.items())}, "
              f"together {sum(rates.values()):.0f} B/s")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("ledger_node")
    parser.add_argument("transport")
    parser.add_argument("what", choices=["cuts", "flap", "thin", "both"])
    parser.add_argument("--tries", type=int, default=100)
    parser.add_argument("--rate", type=float, default=50, help="commands a second")
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--modem", type=float, default=1000, help="kbit/s")
    parser.add_argument("--budget", type=int, help="bytes a second on the modem")
    options = parser.parse_args()
    {"cuts": cuts, "flap": flap, "thin": thin, "both": both}[options.what](options)


if __name__ == "__main__":
    with field.skipping():
        main()
