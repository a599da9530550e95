#!/usr/bin/env python3
"""A fleet in the field for an hour: a ground station and four aircraft, a fifth of all packets lost, an aircraft killed
and started again each minute, commands both ways, States, and a picture from each aircraft a minute. Prints a line a
minute and writes the result as JSON.

The ground station and uav1 live throughout; memory and processor time are judged of these two.

Usage: soak.py --ledger-node PROGRAM [--minutes N] [--transports BACKEND or NODE=BACKEND,...] [--result FILE]
Exit code 0: as it has to be; 1: something is wrong; 77: this machine does not allow it."""

import argparse
import collections
import datetime
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import threading
import time

import expectations
import field
import harness
import judge
import run_scenario

MIXED = {"ground": "fastdds", "uav1": "cyclonedds", "uav2": "fastdds", "uav3": "cyclonedds", "uav4": "fastdds"}
NODES = list(MIXED)
LONG_LIVED = ["ground", "uav1"]
KILLED = ["uav2", "uav3", "uav4"]  # in turn
DOWN_S = [0, 2, 6]  # in turn; the last one is long enough to be LOST
KILL_AT_S = 20  # of each minute

MEETING_S = 5  # before the loss begins
LOSS = 20  # percent
RATE = 20  # commands a second, each way
STATES = 2  # of each node, each posted once a second
POSTED = 0.98  # of the time that is left: each post comes a little later than due, and the last post is to be seen
PICTURE_BYTES = 200_000
PICTURE_PERIOD_S = 60

SETTLE_S = 120
HEALED_S = 5  # after the loss has ended all are UP
AGE_WRONG_S = 0.1
DELAY_P99_MS = 300  # twice the aim of 150 ms at this loss, as in the scenarios
WARM_MINUTES = 5
LEAST_OF_MINUTES = 5  # memory: pictures under way come and go
LEAST_MINUTES = 15  # a shorter run says nothing of memory and processor time
MEMORY_GROWTH = 0.02
PROCESSOR_GROWTH = 0.1

STALE_S = 1.5
LOST_S = 3.5
SLACK_S = 1.5  # between a cut and the last beat before it, and between an event and its line in the ledger
RECOVERY_S = 15.0  # after an end that is longer than the lease

BEATS_PER_S = 2
PAUSE_OVER_S = 2  # after the machine stood still, all beats are there again
STALE_BEATS = 3  # lost one after the other
CHANCE = 1e-6

TICKS_PER_S = os.sysconf("SC_CLK_TCK")


def arguments(node, left_s):
    """Of ledger_node, for a life that begins so long before the end."""
    states = ["--states", str(STATES), "--state-posts", str(int(POSTED * left_s)), "--state-period-ns", str(10**9)]
    notes = ["--count", str(int(RATE * left_s)), "--rate", str(RATE)]
    if node == "ground":
        to = [word for other in NODES[1:] for word in ("--to", other)]
        return [*states, *notes, *to, "--take-pictures"]
    return [*states, *notes, "--to", "ground", "--pictures-to", "ground", "--pictures",
            str(int(left_s // PICTURE_PERIOD_S)), "--picture-bytes", str(PICTURE_BYTES), "--picture-period-ns",
            str(PICTURE_PERIOD_S * 10**9)]


class Yardstick(threading.Thread):
    """Measures once a second how much processor time a fixed piece of work takes. Other programs on the machine make all
    work slower, by their use of caches and of the other half of a core."""

    def __init__(self):
        super().__init__(daemon=True)
        self._times = []
        self.start()

    def run(self):
        work = [{"number": number, "text": str(number) * 8} for number in range(400)]
        while True:
            begin = time.thread_time()
            json.loads(json.dumps(work))
            self._times.append(time.thread_time() - begin)
            time.sleep(1)

    def take_ms(self):
        """The mean since the last call."""
        times, self._times = self._times, []
        return round(1000 * sum(times) / len(times), 3) if times else None


class Usage:
    """Memory and processor time of the processes that run."""

    def __init__(self, ground):
        self._field = ground
        self._before = {}  # pid -> (time, processor seconds)
        self._yardstick = Yardstick()

    def sample(self):
        """{node: {"rss_kb", "cpu_percent" since the last sample, or None of a process that was not there then}}, and
        "yardstick_ms"."""
        return {**{node: self._of(self._field.processes[node].pid) for node in NODES},
                "yardstick_ms": self._yardstick.take_ms()}

    def _of(self, pid):
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        status = pathlib.Path(f"/proc/{pid}/status").read_text()
        now, seconds = time.monotonic(), (int(fields[11]) + int(fields[12])) / TICKS_PER_S
        before = self._before.get(pid)
        self._before[pid] = (now, seconds)
        return {"rss_kb": int(status.partition("VmRSS:")[2].split()[0]),
                "cpu_percent": round(100 * (seconds - before[1]) / (now - before[0]), 2) if before else None}


def line(minute, minutes, done, sample, fleet):
    total = collections.Counter()
    for end in fleet.sights.values():
        end.read()
        total.update(end.total)
    shown = ", ".join(f"{node} {sample[node]['rss_kb'] / 1024:.1f} MiB {sample[node]['cpu_percent'] or 0:.1f} %"
                      for node in LONG_LIVED)
    return (f"minute {minute} of {minutes}: {done}; {shown}; commands {total['accepted']} accepted, "
            f"{total['delivered']} delivered; pictures {total['picture_sent']} sent, {total['picture']} arrived; "
            f"states {total['state']} seen")


def endure(fleet, faults, scenario, minutes):
    """The hour. Returns a sample for each minute."""
    begin = time.monotonic()
    usage = Usage(fleet.field)
    samples = []

    def start(node):
        scenario["nodes"][node] = arguments(node, begin + 60 * minutes - time.monotonic())
        faults.run([["start", node]])

    for node in NODES:
        start(node)
    faults.run([["wait", MEETING_S], ["lose", LOSS]])
    usage.sample()
    for minute in range(minutes):
        wait_until(begin + 60 * minute + KILL_AT_S)
        victim = KILLED[minute % len(KILLED)]
        down_s = DOWN_S[(minute + minute // len(KILLED)) % len(DOWN_S)]
        faults.run([["kill", victim], ["wait", down_s]])
        start(victim)
        wait_until(begin + 60 * (minute + 1))
        samples.append(usage.sample())
        print(line(minute + 1, minutes, f"{victim} killed for {down_s} s", samples[-1], fleet), flush=True)
    return samples


def wait_until(when):
    time.sleep(max(0.0, when - time.monotonic()))


def deaths(run):
    """node -> [(killed, started again)], in s on the ledgers' clock"""
    found = collections.defaultdict(list)
    for when, what, arguments_of in run.faults:
        if what == "kill":
            node = arguments_of[0]
            again = min((life.begin * 1e-9 for life in run.lives[node] if life.begin * 1e-9 > when), default=math.inf)
            found[node].append((when, again))
    return found


def most_by_chance(mean):
    """What a Poisson distribution of that mean exceeds with probability CHANCE."""
    count, below = 0, 0.0
    while below < 1 - CHANCE and count < 2 * mean + 100:
        below += math.exp(count * math.log(mean) - mean - math.lgamma(count + 1)) if mean else 1.0
        count += 1
    return count


class PresenceTruth:
    """What nodes said of each other against who lived."""

    def __init__(self, run, until, pauses=()):
        self._run = run
        self._until = until
        self._pauses = pauses
        self._deaths = deaths(run)
        self.of_living = collections.defaultdict(list)  # state -> what was said of a node that lived

    def wrong(self):
        wrong = []
        watched_s = 0.0
        for observer, lives in self._run.lives.items():
            for number, life in enumerate(lives):
                begin = life.begin * 1e-9
                end = self._deaths[observer][number][0] if number < len(self._deaths[observer]) else self._until
                for node in self._run.lives:
                    if node != observer:
                        watched_s += end - begin
                        wrong += self._pair(life, begin, end, node)
        share = LOSS / 100
        most = most_by_chance(watched_s * BEATS_PER_S * (1 - share) * share**STALE_BEATS)
        stale = len(self.of_living["STALE"])
        if stale > most:
            wrong.append(f"living nodes were shown STALE {stale} times, the loss explains {most}")
        return wrong + [f"{said['by']} showed {said['of']} LOST, which lived" for said in self.of_living["LOST"]]

    def _pair(self, life, begin, end, node):
        name = f"{life.node} and {node}"
        seen = [(event.time * 1e-9, event["state"], event) for event in life.of("peer")
                if event["node"] == node and event.time * 1e-9 < end]
        wrong = []
        for when, state, event in seen:
            if state != "UP" and not self._paused(when) and not any(
                    killed <= when <= again + RECOVERY_S
                    for killed, again in self._deaths[node]):
                self.of_living[state].append({"at_ns": event.time, "by": life.node, "of": node})
                least_s = STALE_S if state == "STALE" else LOST_S
                if float(event["heard_s"]) < least_s - 0.01:
                    wrong.append(f"{name}: shown {state}, heard {event['heard_s']} s before")
        for killed, again in self._deaths[node]:
            wrong += self._death(name, seen, begin, end, killed, again)
        last = seen[-1][1] if seen else "nothing"
        if end == self._until and last != "UP":
            wrong.append(f"{name}: shown {last} at the end, and it lives")
        return wrong

    def _paused(self, when):
        """True if the machine stood still so lately that beats may be missing for that reason."""
        return any(begin <= when <= end + PAUSE_OVER_S for begin, end in self._pauses)

    @staticmethod
    def _death(name, seen, begin, end, killed, again):
        wrong = []
        lost_by = killed + LOST_S + SLACK_S
        up_by = again + RECOVERY_S
        before = [state for when, state, _ in seen if when <= killed]
        if before and begin < killed and lost_by < min(again, end):
            if before[-1] != "LOST" and not any(s == "LOST" and killed < when < lost_by for when, s, _ in seen):
                wrong.append(f"{name}: not shown LOST within {lost_by - killed:.1f} s of its kill")
        if up_by < end and begin < up_by - RECOVERY_S:
            at_start = [state for when, state, _ in seen if when <= again][-1:]
            after = [state for when, state, _ in seen if again < when <= up_by]
            if "UP" not in at_start + after:
                wrong.append(f"{name}: not shown UP within {up_by - again:.1f} s of its start")
        return wrong


def judge_memory(samples):
    if len(samples) < LEAST_MINUTES:
        return []
    wrong = []
    for node in LONG_LIVED:
        sizes = [sample[node]["rss_kb"] for sample in samples]
        warm = min(sizes[WARM_MINUTES - 1 :][:LEAST_OF_MINUTES])
        last = min(sizes[-LEAST_OF_MINUTES:])
        if last > (1 + MEMORY_GROWTH) * warm:
            wrong.append(f"{node}: {last} kB at the end, {warm} kB after {WARM_MINUTES} minutes")
    return wrong


def judge_processor(samples):
    """The same work has to cost the same, measured by the yardstick. Samples in which that measured nothing are left out."""
    samples = [sample for sample in samples if sample["yardstick_ms"] is not None]
    if len(samples) < LEAST_MINUTES:
        return []
    wrong = []
    third = len(samples) // 3
    for node in LONG_LIVED:
        def cost(part):
            return sum(sample[node]["cpu_percent"] for sample in part) / sum(sample["yardstick_ms"] for sample in part)

        second, last = cost(samples[third:2 * third]), cost(samples[-third:])
        if abs(last - second) > PROCESSOR_GROWTH * second:
            wrong.append(f"{node}: {last:.2f} % of a processor for each ms of the yardstick in the last third, "
                         f"{second:.2f} % in the second")
    return wrong


def percentiles(delays):
    """Of delays in s; in ms."""
    ordered = sorted(delays)
    if not ordered:
        return None
    return {"count": len(ordered), "p50_ms": round(1000 * ordered[len(ordered) // 2], 1),
            "p99_ms": round(1000 * ordered[len(ordered) * 99 // 100], 1), "max_ms": round(1000 * ordered[-1], 1)}


def command_delays(run):
    links = run.links()
    figures = {f"{origin} to {to}": percentiles([delay for _, delay in rows])
               for (origin, to), rows in sorted(links.items())}
    figures["all"] = percentiles([delay for rows in links.values() for _, delay in rows])
    figures["long-lived"] = percentiles([delay for (origin, to), rows in links.items() for _, delay in rows
                                         if {origin, to} == set(LONG_LIVED)])
    return figures


def counts(run):
    lives = run.all_lives()
    found = {name: sum(len(life.of(kind)) for life in lives)
             for name, kind in (("commands accepted", "accepted"), ("commands refused", "refused"),
                                ("commands arrived", "delivered"), ("pictures accepted", "picture_sent"),
                                ("pictures arrived", "picture"), ("states posted", "state_posted"),
                                ("states seen", "state"))}
    for name, kind in (("command outcomes", "outcome"), ("picture outcomes", "picture_outcome")):
        found[name] = collections.Counter(event["is"] for life in lives for event in life.of(kind))
    found["lives"] = {node: len(lives_of_node) for node, lives_of_node in run.lives.items()}
    return found


def backends(text):
    """{node: backend} from a backend's name or from NODE=BACKEND,..."""
    if "=" not in text:
        return {node: text for node in NODES} if text != "mixed" else MIXED
    return {**MIXED, **dict(pair.split("=") for pair in text.split(","))}


def where(options):
    commit = subprocess.run(["git", "-C", pathlib.Path(__file__).parent, "describe", "--always", "--dirty"],
                            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False).stdout.strip()
    return {"date": f"{datetime.datetime.now(datetime.timezone.utc):%Y-%m-%d %H:%M} UTC", "commit": commit or "unknown",
            "command": " ".join(["tests/integration/soak.py", *sys.argv[1:]]), "processors": os.cpu_count(),
            "load": round(os.getloadavg()[2], 1), "minutes": options.minutes, "transports": options.transports}


def read(fleet):
    for node, path in fleet.paths().items():
        with open(path, encoding="ascii") as lines:
            yield node, judge.read_ledger(lines)


def settle(fleet):
    try:
        fleet.until(fleet.unsettled, SETTLE_S)
    except run_scenario.NeverSeen as never:
        return list(never.args)
    return []


def soak(options):
    scenario = {"nodes": {node: [] for node in NODES}, "transports": backends(options.transports)}
    heading = where(options)
    with field.Field(NODES) as ground:
        pauses = harness.Pauses()
        fleet = run_scenario.Fleet(ground, options.ledger_node, None, scenario)
        faults = run_scenario.Faults(fleet)
        samples = endure(fleet, faults, scenario, options.minutes)
        verdicts = {"settled": settle(fleet)}
        faults.run([["heal"], ["wait", HEALED_S]])
        until = time.monotonic()
        verdicts["ended well"] = fleet.stop()
        run = expectations.Run({}, faults.done)
        run.lives = dict(read(fleet))
        if options.keep:
            shutil.copytree(ground.folder, options.keep, dirs_exist_ok=True)
    verdicts["exactly once, in order, outcomes true"] = judge.judge_lives(run.all_lives())
    stood_still = pauses.end()
    truth = PresenceTruth(run, until, stood_still)
    verdicts["presence"] = truth.wrong()
    verdicts["states"] = expectations.last_states(run, True)
    verdicts["ages"] = expectations.honest_ages(run, AGE_WRONG_S)
    verdicts["memory"] = judge_memory(samples)
    verdicts["processor"] = judge_processor(samples)
    delays = command_delays(run)
    steady = delays["long-lived"]
    verdicts["delay"] = [] if steady and steady["p99_ms"] <= DELAY_P99_MS else \
        [f"commands between {' and '.join(LONG_LIVED)}: {steady}, p99 at most {DELAY_P99_MS} ms wanted"]
    return {**heading, "passed": not any(verdicts.values()), "verdicts": verdicts, "counts": counts(run),
            "delays": delays, "shown of living nodes": {state: len(said) for state, said in truth.of_living.items()},
            "LOST of living nodes": truth.of_living["LOST"],
            "machine stood still, s": [round(end - begin, 1) for begin, end in stood_still],
            "problems": sorted({" ".join([life.node, *event.values.values()]) for life in run.all_lives()
                                for event in life.of("problem")}),
            "samples": samples}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--ledger-node", required=True)
    parser.add_argument("--minutes", type=int, default=60)
    parser.add_argument("--transports", default="mixed", help="mixed, a backend, or NODE=BACKEND,...")
    parser.add_argument("--result", help="default: tests/bench/results/soak_TRANSPORTS.json")
    parser.add_argument("--keep", help="copy the ledgers into this folder")
    options = parser.parse_args()
    results = pathlib.Path(__file__).resolve().parents[1] / "bench" / "results"
    path = pathlib.Path(options.result or results / f"soak_{options.transports.replace('=', '_')}.json")
    with field.skipping():
        result = soak(options)
    path.write_text(json.dumps(result, indent=1) + "\n")
    for name, wrong in result["verdicts"].items():
        print(f"{name}: {'as it has to be' if not wrong else f'{len(wrong)} wrong'}")
        for text in wrong[:20]:
            print("WRONG " + text)
    print(f"delays: {result['delays']['all']}, long-lived {result['delays']['long-lived']}; shown of living nodes: "
          f"{result['shown of living nodes']}; the machine stood still {len(result['machine stood still, s'])} times; {path}")
    sys.exit(0 if result["passed"] else 1)


if __name__ == "__main__":
    main()
