"""Figures from what was seen: ledgers, what a ground station showed, and counters of the radio. No function here runs
anything."""

import re
from dataclasses import dataclass


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


def worst_second(counters):
    """The most bytes of IP that one node gave to its radio within a second."""
    return max(node["most_ip_in_a_second"] for node in counters["nodes"].values())


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


@dataclass
class Shown:
    """What the ground station showed of an aircraft at one moment, in s since its start."""
    time: float
    node: str
    state: str
    age: float


SHOWN = re.compile(r"^ *([\d.]+) s  (\S+) +(WAITING|UP|STALE|LOST)\b.*?(?:\(age ([\d.]+) s\)|no pose yet)")
HEARD = re.compile(r"heard \d+ of \d+ poses \(([\d.]+) %\)")


def shown_rows(lines):
    """The rows among the lines that the ground station writes where there is no terminal."""
    return [Shown(float(found[1]), found[2], found[3], float(found[4] or "inf"))
            for _, text in lines if (found := SHOWN.match(text))]


def first_all_up(rows, names):
    """When all of them were UP with a pose at once for the first time; None: never."""
    states = {}
    for row in rows:
        states[row.node] = row.state if row.age != float("inf") else "WAITING"
        if all(states.get(name) == "UP" for name in names):
            return row.time
    return None


def poses_heard(lines):
    """Percent, of the aircraft that was heard worst, by the ground station's summary; None: there is no summary."""
    heard = [float(found[1]) for _, text in lines if (found := HEARD.search(text))]
    return min(heard) if heard else None
