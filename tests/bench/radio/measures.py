"""What can be measured of a fleet on a radio. Each function runs one fleet on a field that is there and returns the
figures by name; a figure that could not be had, since what it waits for did not happen, is None.

Bytes are those that nodes gave to their radios (offered), or those that were on the air (sent), whole Ethernet frames;
figures that begin with ip_ count IP packets alone, as budgets do."""

import os
import pathlib
import signal
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
import contestants  # noqa: E402  (which finds tests/integration)
import expectations  # noqa: E402
import judge  # noqa: E402

from rows import PLAIN, RABIT  # noqa: E402

DOMAIN = 0
LIMIT_S = 60  # of waiting for a fleet to come together
# A datagram that fits a frame, as the gateway's default is.
DATAGRAM = 1400


class Fleet:
    """Programs of one kind on one field."""

    def __init__(self, ground, folder, contestant, transport):
        self.ground = ground
        self.contestant = contestant
        self.transport = transport
        self._folder = pathlib.Path(folder)
        self._programs = contestants.Contestants(folder, DOMAIN)

    def start_member(self, node, number, options):
        raw = {PLAIN: contestants.RAW_WORKER, RABIT: contestants.NODE}[self.contestant]
        argv = self._programs.argv(raw, self.transport, "member", {
            "carriage": "telemetry", "payload": 100, **options, "member": number,
            "interface": self.ground.address(node), "datagram": DATAGRAM})
        return self.ground.start(node, argv)

    def start_ledger(self, node, *options):
        state = pathlib.Path(self.ground.folder, node + ".state")
        state.mkdir(exist_ok=True)
        return self.ground.start(node, [self._folder / "ledger_node", "--node", node, "--ledger", self._path(node),
                                        "--state-dir", state, "--transport", self.transport, *options])

    def ledgers(self):
        return expectations.Run({node: self._path(node).read_text() if self._path(node).exists() else ""
                                 for node in self.ground.nodes}, [])

    def wait_until_all_up(self, limit_s):
        """Seconds from the last start until all saw all others UP for the first time; None: not within the limit."""
        end = time.monotonic() + limit_s
        while True:
            lives = [lives[0] for lives in self.ledgers().lives.values() if lives]
            firsts = [{} for _ in lives]
            for first, life in zip(firsts, lives):
                for event in life.of("peer"):
                    if event["state"] == "UP":
                        first.setdefault(event["node"], event.time)
            others = len(self.ground.nodes) - 1
            if len(lives) == others + 1 and all(len(first) == others for first in firsts):
                return (max(max(first.values()) for first in firsts) - max(life.begin for life in lives)) * 1e-9
            if time.monotonic() > end:
                return None
            time.sleep(0.2)

    def _path(self, node):
        return pathlib.Path(self.ground.folder, node + ".ledger")


def traffic(counters):
    """The figures that every measure has."""
    seconds, nodes = counters["seconds"], counters["nodes"].values()
    offered = sum(node["offered"]["bytes"] for node in nodes)
    dropped = sum(node["dropped"]["bytes"] for node in nodes)
    figures = {"offered_kB_s": offered / seconds / 1000, "sent_kB_s": counters["sent"]["bytes"] / seconds / 1000,
               "dropped_pct": 100 * dropped / max(offered, 1), "used_pct": 100 * counters["utilisation"],
               "longest_wait_ms": max(node["longest_wait_ms"] for node in nodes)}
    if counters["bits_per_s"]:
        figures["offered_pct"] = 100 * 8 * offered / seconds / counters["bits_per_s"]
    return figures


def reports(processes):
    """A report of each member, of about the same moment."""
    found = []
    for process in processes:
        asked = time.monotonic()
        os.kill(process.pid, signal.SIGUSR1)
        found.append(process.wait_for(lambda text: '"at_ns"' in text and contestants.json.loads(text), LIMIT_S, asked)[1])
    return found


def all_to_all(fleet, members, settle_s, seconds):
    """Each publishes ten times a second and follows all others."""
    nodes = fleet.ground.nodes
    started = [fleet.start_member(node, number, {"members": members, "period": 100_000_000})
               for number, node in enumerate(nodes, 1)]
    began = time.monotonic()
    time.sleep(settle_s)
    before = reports(started)
    fleet.ground.reset()
    time.sleep(seconds)
    counters, after = fleet.ground.counters(), reports(started)
    sent = [a["sent"] - b["sent"] for b, a in zip(before, after)]
    due = sum(sent) * (members - 1)
    arrived = sum(a["received"] - b["received"] for b, a in zip(before, after))
    heard = [next((when for when, text in process.lines if "all_heard_at_ns" in text), None) for process in started]
    return {"arrives_pct": 100 * arrived / max(due, 1), "all_heard_s": max(heard) - began if all(heard) else None,
            **traffic(counters)}


def idle(fleet, nodes, settle_s, seconds):
    """Nothing is published. Nodes accept one queue; plain programs have a writer and a reader."""
    started = {}
    if fleet.contestant == RABIT:
        for node in fleet.ground.nodes:
            fleet.start_ledger(node)
        started = {"all_up_s": fleet.wait_until_all_up(LIMIT_S)}
    else:
        for number, node in enumerate(fleet.ground.nodes, 1):
            fleet.start_member(node, number, {"members": max(nodes, 2), "period": 3_600_000_000_000})
    time.sleep(settle_s)
    fleet.ground.reset()
    time.sleep(seconds)
    counters = fleet.ground.counters()
    rate = counters["sent"]["ip_bytes"] / counters["seconds"] / 1000
    return {"ip_kB_s": rate, "ip_B_s_each": 1000 * rate / nodes, "ip_kB_s_pair": rate / (nodes * (nodes - 1)),
            **started, **traffic(counters)}


def start(fleet, members):
    """What goes over the air until everybody has heard everybody, each with a sample a second."""
    nodes = fleet.ground.nodes
    fleet.ground.reset()
    began = time.monotonic()
    started = [fleet.start_member(node, number, {"members": members, "period": 1_000_000_000})
               for number, node in enumerate(nodes, 1)]
    megabytes = {}

    def heard(process):
        return any("all_heard_at_ns" in text for _, text in process.lines)
    while not all(map(heard, started)) and time.monotonic() - began < LIMIT_S:
        for second in (1, 2):
            if second not in megabytes and time.monotonic() - began > second:
                megabytes[second] = fleet.ground.counters()["sent"]["ip_bytes"] / 1e6
        time.sleep(0.02)
    passed, counters = time.monotonic() - began, fleet.ground.counters()
    complete = all(map(heard, started))
    return {"ip_MB": counters["sent"]["ip_bytes"] / 1e6 if complete else None,
            "all_heard_s": passed if complete else None, "ip_MB_1_s": megabytes.get(1), "ip_MB_2_s": megabytes.get(2),
            **traffic(counters)}


def start_fleet(fleet, a_second, *more):
    """The ground station and its aircraft at once."""
    uavs = [node for node in fleet.ground.nodes if node != "ground"]
    fleet.start_ledger("ground", "--ticks", *more, *(word for node in uavs for word in ("--to", node)),
                       "--count", 1_000_000, "--rate", a_second)
    for node in uavs:
        fleet.start_ledger(node, "--ticks", *more)
    return uavs


def shown_ages(run, since, until, observer="ground"):
    """Ages in s of the newest tick of each other node as the observer would show it ten times a second; infinite as
    long as it has none."""
    ages = []
    for origin in run.lives:
        if origin == observer:
            continue
        ticks = [(e.time * 1e-9, float(e.values["age_s"])) for e in run.events(observer, "tick") if e["from"] == origin]
        place, moment = -1, since
        while moment < until:
            while place + 1 < len(ticks) and ticks[place + 1][0] <= moment:
                place += 1
            ages.append(moment - ticks[place][0] + ticks[place][1] if place >= 0 else float("inf"))
            moment += 0.1
    return sorted(ages)


def command_delays(run, since, until, origin="ground"):
    """Sorted delays in s of the notes of that time, and how many were not delivered by the end of the ledgers."""
    delays, open_notes = [], 0
    delivered = {(e["from"], life.node, e.number("id")): e.time for life in run.all_lives() for e in life.of("delivered")}
    for event in run.events(origin, "accepted"):
        sent = event.time * 1e-9
        if since <= sent < until:
            came = delivered.get((origin, event["to"], event.number("id")))
            if came is None:
                open_notes += 1
            else:
                delays.append(came * 1e-9 - sent)
    return sorted(delays), open_notes


def percentile(values, percent):
    """Of sorted values; None also where that is infinite."""
    value = values[min(len(values) * percent // 100, len(values) - 1)] if values else None
    return None if value == float("inf") else value


def fly(fleet, uavs, seconds, a_second):
    """Presence, commands and poses of a fleet that starts at once."""
    fleet.ground.reset()
    start_fleet(fleet, a_second)
    up = fleet.wait_until_all_up(LIMIT_S)
    since = time.monotonic()
    time.sleep(seconds)
    until = time.monotonic()
    counters = fleet.ground.counters()
    time.sleep(2)  # what was sent last may still come
    run = fleet.ledgers()
    peers = [e for life in run.all_lives() for e in life.of("peer")]
    shares = [run.share_of_ticks("ground", node)[0] for node in fleet.ground.nodes if node != "ground"]
    delays, missing = command_delays(run, since, until - 2)
    p99 = percentile(delays + [float("inf")] * missing, 99)
    age = percentile(shown_ages(run, since, until), 90)
    return {"all_up_s": up, "stale": sum(e["state"] == "STALE" for e in peers),
            "lost": sum(e["state"] == "LOST" for e in peers), "ticks_pct": 100 * sum(shares) / len(shares),
            "commands": len(delays) + missing, "commands_p99_ms": p99 and 1000 * p99, "age_p90_s": age,
            **traffic(counters)}


def fall(fleet, uavs, to_kbit, for_s):
    """Bulk to each aircraft as fast as the links take it, beside the poses; the medium becomes slow and fast again."""
    start_fleet(fleet, 1000, "--payload", 1000)
    fleet.wait_until_all_up(LIMIT_S)
    time.sleep(20)
    kbit = fleet.ground.counters()["bits_per_s"] / 1000
    fleet.ground.rate(to_kbit)
    time.sleep(5)
    fleet.ground.reset()
    time.sleep(for_s - 5)
    slow = traffic(fleet.ground.counters())
    fleet.ground.rate(kbit)
    time.sleep(15)
    fleet.ground.reset()
    time.sleep(15)
    fast = traffic(fleet.ground.counters())
    return {"wait_ms": slow["longest_wait_ms"], **{key: fast[key] for key in ("used_pct", "offered_kB_s", "dropped_pct")}}


def outage(fleet, uavs, for_s):
    """How old the first pose is that the ground station sees after the outage."""
    start_fleet(fleet, 2)
    fleet.wait_until_all_up(LIMIT_S)
    time.sleep(10)
    fleet.ground.outage("on")
    time.sleep(for_s)
    fleet.ground.reset()
    began = time.monotonic()
    fleet.ground.outage("off")
    time.sleep(30)
    counters, run = fleet.ground.counters(), fleet.ledgers()
    firsts = {}
    for event in run.events("ground", "tick"):
        if event.time * 1e-9 > began:
            firsts.setdefault(event["from"], (event.time * 1e-9 - began, float(event.values["age_s"])))
    complete = len(firsts) == uavs
    return {"first_age_s": max(age for _, age in firsts.values()) if complete else None,
            "all_seen_s": max(after for after, _ in firsts.values()) if complete else None,
            "worst_second_kB": max(n["most_ip_in_a_second"] for n in counters["nodes"].values()) / 1000,
            **traffic(counters)}


def send_notes(fleet, count, rate, payload, expire, limit_s, capacity):
    """Notes from the ground station to one aircraft; (run, seconds from the first one until all have an outcome or the
    limit, counters of that time)."""
    extra = ["--payload", payload, "--capacity", capacity]
    fleet.start_ledger("uav1", "--payload", payload, "--queue-room", 100_000)
    fleet.start_ledger("ground", *extra, "--to", "uav1", "--count", count, "--rate", rate,
                       *(("--expire", expire) if expire else ()))
    fleet.wait_until_all_up(LIMIT_S)
    fleet.ground.reset()
    end = time.monotonic() + limit_s
    while time.monotonic() < end:
        run = fleet.ledgers()
        if len(run.events("ground", "outcome")) >= count:
            break
        time.sleep(0.2)
    counters, run = fleet.ground.counters(), fleet.ledgers()
    intents, last = run.events("ground", "intent"), run.events("ground", "outcome")
    seconds = (last[-1].time - intents[0].time) * 1e-9 if len(last) >= count else None
    return run, seconds, counters


def link(fleet, payload, count, rate, limit_s, expire=0):
    run, seconds, counters = send_notes(fleet, count, rate, payload, expire, limit_s, max(count, 16))
    sent = counters["sent"]["ip_bytes"]
    delivered = len(run.events("uav1", "delivered"))
    return {"seconds": seconds, "delivered": delivered, "sent_MB": sent / 1e6,
            "sent_per_payload": sent / (delivered * payload) if delivered else None, **traffic(counters)}


def commands(fleet, rate, count):
    run, _, counters = send_notes(fleet, count, rate, 12, 0, 60, 1000)
    delays = sorted(delay for _, delay in run.links()["ground", "uav1"])
    refused = run.events("ground", "refused")
    first = next(iter(run.events("ground", "accepted")), None)
    return {**{f"p{p}_ms": 1000 * percentile(delays, p) if delays else None for p in (50, 90, 99)},
            "delivered": len(delays), "refused": sum(first is not None and e.time > first.time for e in refused),
            **traffic(counters)}


def nodes_of(row):
    """The names of the nodes that a row needs."""
    options = row.options
    if "members" in options or "nodes" in options:
        return [f"n{k}" for k in range(1, options.get("members", options.get("nodes")) + 1)]
    return ["ground", *(f"uav{k}" for k in range(1, options.get("uavs", 1) + 1))]
