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
import fleet_keys  # noqa: E402
import judge  # noqa: E402

from figures import (command_delays, first_all_up, percentile, poses_heard, shown_ages, shown_rows,  # noqa: E402
                     traffic, worst_second)
from rows import MIXED, PLAIN, RABIT  # noqa: E402

DOMAIN = 0
BACKENDS = ("fastdds", "cyclonedds")
EXAMPLES = pathlib.Path(__file__).resolve().parents[3] / "examples"
LIMIT_S = 60  # of waiting for a fleet to come together
# Bytes of a pose beside its padding: headers from IP to CDR, and its number.
OVERHEAD = 88 + 12
# The time that the largest datagram takes at its budget.
LARGEST_AT_A_BUDGET_S = 0.25
# A datagram that fits a frame: the gateway's default.
DATAGRAM = 1400


class Fleet:
    """Programs of one kind on one field. The transport MIXED gives the nodes the two backends in turns."""

    def __init__(self, ground, folder, contestant, transport, has_keys=False, budget=None):
        self.ground = ground
        self._budget = budget
        self._rabit = pathlib.Path(folder, "rabit") if has_keys else None
        if has_keys:
            fleet_keys.make(self._rabit, ground.folder, [])
        self.contestant = contestant
        self.transport = transport
        self._folder = pathlib.Path(folder)
        self._programs = contestants.Contestants(folder, DOMAIN)

    def transport_of(self, node):
        return BACKENDS[self.ground.nodes.index(node) % 2] if self.transport == MIXED else self.transport

    def start_member(self, node, number, options):
        raw = {PLAIN: contestants.RAW_WORKER, RABIT: contestants.NODE}[self.contestant]
        argv = self._programs.argv(raw, self.transport_of(node), "member", {
            "carriage": "telemetry", "payload": 100, **options, "member": number,
            "interface": self.ground.address(node), "datagram": DATAGRAM})
        return self.ground.start(node, argv)

    def start_ledger(self, node, *options):
        state = pathlib.Path(self.ground.folder, node + ".state")
        state.mkdir(exist_ok=True)
        pathlib.Path(self.ground.folder, node + ".yaml").write_text(fleet_keys.CONFIG.format(node=node))
        return self.ground.start(node, [self._folder / "ledger_node", "--node", node, "--ledger", self.ledger(node),
                                        "--state-dir", state, "--transport", self.transport_of(node), *self._keys(node), *options])

    def _keys(self, node):
        """Options of the program of a node whose configuration has been written."""
        if self._rabit is None:
            return []
        folder = fleet_keys.of(self.ground.folder, node)
        if not folder.exists():
            fleet_keys.add(self._rabit, self.ground.folder, node)
        return ["--keys", folder]

    def restart_ledger(self, node, *options):
        self.ground.kill(node)
        self.start_ledger(node, *options)

    def stop_ledgers(self):
        """All of them; what they wrote is forgotten."""
        for node in self.ground.nodes:
            self.ground.kill(node)
            self.ledger(node).unlink()

    def start_example(self, node, config, *options):
        """A program of examples/, named as its node or else an aircraft, with its configuration for any interface."""
        text = (EXAMPLES / config).read_text()
        path = pathlib.Path(self.ground.folder, node + ".yaml")
        path.write_text("".join(line for line in text.splitlines(keepends=True) if not line.startswith("interfaces:")) +
                        (f"\nradio: {{budget: {self._budget}}}\n" if self._budget else ""))
        program = "ground" if node == "ground" else "uav"
        return self.ground.start(node, [self._folder / program, "--config", path, "--node", node, "--domain", DOMAIN,
                                        "--transport", self.transport_of(node), *self._keys(node), *options])

    def ledgers(self):
        return expectations.Run({node: self.ledger(node).read_text() if self.ledger(node).exists() else ""
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

    def ledger(self, node):
        return pathlib.Path(self.ground.folder, node + ".ledger")


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


def idle(fleet, nodes, settle_s, seconds, budget=None):
    """Nothing is published. Nodes accept one queue; plain programs have a writer and a reader."""
    started = {}
    if fleet.contestant == RABIT:
        for node in fleet.ground.nodes:
            fleet.start_ledger(node, *(("--budget", budget) if budget else ()))
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


def share_of_ticks(run, node, origin):
    """Of the ticks from the first to the last that the node saw, those that it saw."""
    seen = {event.number("number") for event in run.events(node, "tick") if event["from"] == origin}
    return len(seen) / (max(seen) - min(seen) + 1) if seen else 0.0


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
    shares = [share_of_ticks(run, "ground", node) for node in fleet.ground.nodes if node != "ground"]
    delays, missing = command_delays(run, since, until - 2)
    p99 = percentile(delays + [float("inf")] * missing, 99)
    age = percentile(shown_ages(run, since, until), 90)
    return {"all_up_s": up, "stale": sum(e["state"] == "STALE" for e in peers),
            "lost": sum(e["state"] == "LOST" for e in peers), "ticks_pct": 100 * sum(shares) / len(shares),
            "commands": len(delays) + missing, "commands_p99_ms": p99 and 1000 * p99, "age_p90_s": age,
            **traffic(counters)}


def swarm(fleet, uavs, seconds):
    """The example itself: aircraft that search, and the ground station, which says once a second what it shows."""
    fleet.ground.reset()
    names = [node for node in fleet.ground.nodes if node != "ground"]
    station = fleet.start_example("ground", "ground_station/ground.yaml", "--seconds", int(seconds) + LIMIT_S,
                                  "--command-period", 2, *(word for node in names for word in ("--expect", node)))
    began = time.monotonic()
    for node in names:
        fleet.start_example(node, "swarm/uav.yaml")
    up, rows = None, []
    while time.monotonic() < began + LIMIT_S + seconds and (up is None or time.monotonic() < began + up + seconds):
        time.sleep(0.5)
        rows = shown_rows(station.lines)
        up = up if up is not None else first_all_up(rows, names)
        if up is None and time.monotonic() > began + LIMIT_S:
            break
    counters = fleet.ground.counters()
    os.kill(station.pid, signal.SIGINT)
    station.exit_code(20)
    since = [row for row in shown_rows(station.lines) if up is not None and row.time >= up]
    ages = sorted(row.age for row in since)
    return {"all_up_s": up, "stale": sum(row.state == "STALE" for row in since),
            "lost": sum(row.state == "LOST" for row in since), "poses_pct": poses_heard(station.lines),
            "age_p90_s": percentile(ages, 90), **traffic(counters)}


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


def picture(fleet, uavs, size, limit_s, budget):
    """A picture from an aircraft to the ground station beside poses and commands, on a budget each."""
    more = ["--budget", budget, "--take-pictures"]
    fleet.ground.reset()
    start_fleet(fleet, 0.5, *more)
    up = fleet.wait_until_all_up(LIMIT_S)
    if up is None:
        return {"all_up_s": None, "picture_s": None, **traffic(fleet.ground.counters())}
    fleet.restart_ledger("uav1", "--ticks", *more, "--pictures-to", "ground", "--picture-bytes", size)
    fleet.ground.reset()
    since = time.monotonic()
    came = None
    while came is None and time.monotonic() < since + limit_s:
        time.sleep(0.5)
        run = fleet.ledgers()
        came = next((e.time * 1e-9 for e in run.events("ground", "picture")), None)
    until = time.monotonic()
    counters = fleet.ground.counters()
    time.sleep(5)
    run = fleet.ledgers()
    sent = next((e.time * 1e-9 for e in run.events("uav1", "picture_sent")), None)
    since = max(since, sent or 0)
    delays, missing = command_delays(run, since, until - 5)
    p99 = percentile(delays + [float("inf")] * missing, 99)
    return {"all_up_s": up, "picture_s": came - sent if came and sent else None,
            "lost": sum(e["state"] == "LOST" and e.time * 1e-9 > since + 5 for life in run.all_lives() for e in life.of("peer")),
            "commands": len(delays) + missing, "commands_p99_ms": p99 and 1000 * p99,
            "age_max_s": percentile(shown_ages(run, since, until), 100),
            "worst_second_B": worst_second(counters), **traffic(counters)}


def overload(fleet, uavs, budget, times, seconds):
    """Aircraft that offer more poses than their budgets allow, beside commands; the same fleet without poses first."""
    def watch(*more):
        start_fleet(fleet, 2, "--budget", budget, *more)
        up = fleet.wait_until_all_up(LIMIT_S)
        time.sleep(10)
        fleet.ground.reset()
        since = time.monotonic()
        time.sleep(seconds)
        counters, until = fleet.ground.counters(), time.monotonic()
        time.sleep(5)
        run = fleet.ledgers()
        delays, missing = command_delays(run, since, until)
        states = [e["state"] for life in run.all_lives() for e in life.of("peer") if e.time * 1e-9 > since]
        return up, percentile(delays + [float("inf")] * missing, 99), states, counters
    _, idle_p99, _, _ = watch()
    fleet.stop_ledgers()
    payload = 400
    period_ns = round(1e9 * (payload + OVERHEAD) / (times * budget))
    up, p99, states, counters = watch("--tick-payload", payload, "--tick-period-ns", period_ns)
    bound = idle_p99 and 2 * (idle_p99 + LARGEST_AT_A_BUDGET_S)
    return {"all_up_s": up, "stale": states.count("STALE"), "lost": states.count("LOST"),
            "idle_p99_ms": idle_p99 and 1000 * idle_p99, "commands_p99_ms": p99 and 1000 * p99,
            "p99_of_allowed_pct": p99 and bound and 100 * p99 / bound,
            "worst_second_pct": 100 * worst_second(counters) / budget, **traffic(counters)}


def throughput(fleet, payload, seconds):
    """What a link that always has something to send delivers, of what the medium carries, from 10 s after its start."""
    fleet.start_ledger("uav1", "--payload", payload, "--queue-room", 100_000)
    fleet.start_ledger("ground", "--payload", payload, "--capacity", 1000, "--to", "uav1", "--count", 10_000_000,
                       "--rate", 100_000)
    fleet.wait_until_all_up(LIMIT_S)
    began = time.monotonic() + 10
    time.sleep(10)
    fleet.ground.reset()
    time.sleep(seconds)
    counters, until = fleet.ground.counters(), time.monotonic()
    delivered = sum(began <= e.time * 1e-9 < until for e in fleet.ledgers().events("uav1", "delivered"))
    goodput = 8 * delivered * payload / (until - began)
    return {"goodput_kbit_s": goodput / 1000, "goodput_pct": 100 * goodput / counters["bits_per_s"], **traffic(counters)}


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
