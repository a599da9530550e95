"""Results as Markdown."""

import datetime
import json
import os
import pathlib
import statistics
import subprocess

import fleet_report
import plan
from contestants import LOCAL, NODE, RAW_LISTENER, RAW_THREADS, RAW_WORKER
from plan import SIZES

median = statistics.median
NAMES = fleet_report.NAMES


def machine(load):
    """Where and when figures were measured; `load`: a quiet.Load that began with the measurement."""
    processor = next((line.partition(":")[2].strip() for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines()
                      if line.startswith("model name")), "unknown processor")
    commit = subprocess.run(["git", "-C", pathlib.Path(__file__).parent, "rev-parse", "--short", "HEAD"],
                            capture_output=True, text=True, check=False).stdout.strip()
    return {"date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
            "processor": processor, "processors": os.cpu_count(), "kernel": os.uname().release,
            "others": round(load.share(), 2), "commit": commit}


class Table:
    """What results say, by name."""

    def __init__(self, results):
        self.results = results

    def value(self, key, contestant, name):
        values = self.results.get(key, {}).get(contestant, {}).get(name)
        return median(values) if values else None

    def ratio(self, key, name, raw=RAW_WORKER):
        """Median of the ratios of neighbours in time: both were disturbed by the same things."""
        ours = self.results.get(key, {}).get(NODE, {}).get(name)
        theirs = self.results.get(key, {}).get(raw, {}).get(name)
        if not ours or not theirs or not all(theirs):
            return None
        return median([a / b for a, b in zip(ours, theirs)])

    def spread(self, key, contestant, name):
        values = self.results.get(key, {}).get(contestant, {}).get(name)
        return (min(values), max(values)) if values else None


def number(value):
    if value is None:
        return ""
    digits = 0 if abs(value) >= 100 else 1 if abs(value) >= 10 else 2
    return f"{value:.{digits}f}"


def rows(header, lines):
    text = "| " + " | ".join(header) + " |\n|" + "---|" * len(header) + "\n"
    return text + "".join("| " + " | ".join(line) + " |\n" for line in lines) + "\n"


# Title, meaning to a user, key of the case, name of the value, at most or at least, factor.
AIMS = [
    ("latency of a mirrored message, state, 100 B, p50",
     "how much later a value is with a manager elsewhere than if it had been sent by hand",
     "latency {} state 100 B", "p50_us", "at most", 1.25),
    ("the same, p99", "the same for the one value in a hundred that is late anyway",
     "latency {} state 100 B", "p99_us", "at most", 1.5),
    ("latency of a mirrored message, telemetry, 100 B, p50", "the same for values that are soon replaced",
     "latency {} telemetry 100 B", "p50_us", "at most", 1.25),
    ("the same, p99", "the same for the late ones", "latency {} telemetry 100 B", "p99_us", "at most", 1.5),
    ("latency of a queue message, 100 B, p50",
     "what it costs a command in time that it arrives exactly once and that its outcome is known",
     "latency {} queue 100 B", "p50_us", "at most", 1.5),
    ("queue messages of 100 B a second",
     "how many commands or log lines a link carries, acknowledged, against one reliable write for each",
     "throughput {} queue 100 B", "per_s", "at least", 2.0),
    ("queue, bytes a second at 64 kB", "how fast maps or pictures in pieces are carried",
     "throughput {} queue 64 kB", "MB_per_s", "at least", 0.9),
    ("queue, bytes a second at 1 MB", "how fast whole pictures are carried",
     "throughput {} queue 1 MB", "MB_per_s", "at least", 0.9),
    ("processor time of a mirrored message, state, 100 B",
     "how much of the computer is gone for each value, on both sides together",
     "latency {} state 100 B", "cpu_us", "at most", 1.3),
    ("processor time of a mirrored message, telemetry, 100 B", "the same for values that are soon replaced",
     "latency {} telemetry 100 B", "cpu_us", "at most", 1.3),
]
ABSOLUTE = [
    ("idle node, share of a processor", "what a battery pays for a gateway that has nothing to do",
     "idle {}", "processor", 0.002, lambda v: f"{100 * v:.2f} %"),
    ("idle node, bytes a second", "what a radio pays for it", "idle {}", "bytes_per_s", 2000,
     lambda v: f"{v:.0f} B/s"),
]


def aims(table, transports):
    lines = []
    for what, means, key, name, direction, limit in AIMS:
        for transport in transports:
            ratio = table.ratio(key.format(transport), name)
            if ratio is not None:
                met = ratio <= limit if direction == "at most" else ratio >= limit
                raw, ours = (table.value(key.format(transport), who, name) for who in (RAW_WORKER, NODE))
                threads = table.ratio(key.format(transport), name, RAW_THREADS)
                lines.append([what, means, NAMES[transport], f"{direction} {limit} x raw", number(raw),
                              number(ours), f"{ratio:.2f} x", f"{threads:.2f} x" if threads else "",
                              "yes" if met else "no"])
    for what, means, key, name, limit, show in ABSOLUTE:
        for transport in transports:
            for nodes in ("alone", "pair"):
                raw, ours = (table.value(key.format(nodes) + " " + transport, who, name) for who in (RAW_WORKER, NODE))
                if ours is not None:
                    lines.append([f"{what} ({nodes})", means, NAMES[transport], f"at most {show(limit)}", show(raw),
                                  show(ours), "", "", "yes" if ours <= limit else "no"])
    return rows(["what", "to a user it is", "backend", "aim", "raw, worker", "Rabit", "ratio", "to two threads", "met"], lines)


def latency(table, transports, carriage):
    lines = []
    for size in SIZES:
        for transport in transports:
            key = f"latency {transport} {carriage} {size}"
            if key not in table.results:
                continue
            line = [size, NAMES[transport]]
            for name in ("p50_us", "p99_us", "p999_us"):
                values = [number(table.value(key, who, name))
                          for who in (RAW_LISTENER, RAW_WORKER, RAW_THREADS, NODE)]
                ratios = [table.ratio(key, name, who) for who in (RAW_WORKER, RAW_THREADS)]
                line += [" / ".join(values), " / ".join(f"{ratio:.2f}" if ratio else "" for ratio in ratios)]
            low_high = table.spread(key, NODE, "p50_us")
            line.append(f"{number(low_high[0])} to {number(low_high[1])}" if low_high else "")
            lines.append(line)
        local = f"latency none {carriage} {size}"
        if local in table.results:
            line = [size, "one process"]
            for name in ("p50_us", "p99_us", "p999_us"):
                line += [number(table.value(local, LOCAL, name)), ""]
            low_high = table.spread(local, LOCAL, "p50_us")
            lines.append(line + [f"{number(low_high[0])} to {number(low_high[1])}"])
    return rows(["size", "backend", "p50, us", "ratio", "p99, us", "ratio", "p99.9, us", "ratio",
                 "p50 of repetitions"], lines)


def costs(table, transports):
    lines = []
    for carriage in ("state", "telemetry", "queue"):
        for size in SIZES:
            for transport in transports:
                key = f"latency {transport} {carriage} {size}"
                if key in table.results:
                    line = [carriage, size, NAMES[transport]]
                    for name in ("cpu_us", "allocations", "sleeps"):
                        values = [number(table.value(key, who, name)) for who in (RAW_WORKER, NODE)]
                        line.append(" / ".join(values))
                    ratio = table.ratio(key, "cpu_us")
                    line.insert(4, f"{ratio:.2f}" if ratio else "")
                    lines.append(line)
    return rows(["carriage", "size", "backend", "processor time, us", "ratio", "allocations", "sleeps"], lines)


def throughput(table, transports):
    lines = []
    for size in SIZES:
        for transport in transports:
            key = f"throughput {transport} queue {size}"
            if key in table.results:
                line = [size, NAMES[transport]]
                for name in ("per_s", "MB_per_s"):
                    line.append(" / ".join(number(table.value(key, who, name)) for who in (RAW_WORKER, NODE)))
                ratio = table.ratio(key, "per_s")
                line.append(f"{ratio:.2f}" if ratio else "")
                for name in ("cpu_us", "allocations"):
                    line.append(" / ".join(number(table.value(key, who, name)) for who in (RAW_WORKER, NODE)))
                lines.append(line)
    return rows(["size", "backend", "messages a second", "MB a second", "ratio", "processor time, us", "allocations"],
                lines)


def start_and_idle(table, transports):
    lines = []
    for transport in transports:
        key = f"start-up {transport}"
        if key in table.results:
            lines.append(["first message after the start, s", NAMES[transport],
                          *(number(table.value(key, who, "first_message_s")) for who in (RAW_WORKER, NODE))])
        for nodes in ("alone", "pair"):
            key = f"idle {nodes} {transport}"
            if key in table.results:
                for what, name, scale in (("share of a processor, %", "processor", 100),
                                          ("bytes a second", "bytes_per_s", 1)):
                    lines.append([f"idle ({nodes}), {what}", NAMES[transport],
                                  *(number(table.value(key, who, name) * scale) for who in (RAW_WORKER, NODE))])
    return rows(["what", "backend", "raw", "Rabit"], lines)


def instructions(table, transports):
    lines = []
    for carriage in ("state", "telemetry", "queue"):
        for transport in transports:
            key = f"instructions {transport} {carriage} 100 B"
            if table.ratio(key, "instructions"):
                line = [carriage, NAMES[transport]]
                for who in (RAW_WORKER, NODE):
                    low, high = table.spread(key, who, "instructions")
                    line += [f"{table.value(key, who, 'instructions'):.0f}", f"{low:.0f} to {high:.0f}"]
                lines.append(line + [f"{table.ratio(key, 'instructions'):.2f}"])
    return rows(["carriage", "backend", "raw", "runs", "Rabit", "runs", "ratio"], lines) if lines else ""


def pairs(table, transports):
    text = ""
    for carriage, name in (("state", "mirrored messages, qos `state`"),
                           ("telemetry", "mirrored messages, qos `telemetry`"), ("queue", "queue messages")):
        text += f"## Latency: {name}\n\nRaw in the listener / raw with a worker / raw with two threads / Rabit. Ratio: "
        text += "Rabit to raw with a worker / to raw with two threads.\n\n" + latency(table, transports, carriage)
    text += "## Queues at full speed\n\nRaw with a worker / Rabit.\n\n" + throughput(table, transports)
    text += "## What a message costs\n\nBoth sides together, while it goes there and back. Raw with a worker / "
    text += "Rabit.\n\n" + costs(table, transports)
    return text + "## Start and idle\n\n" + start_and_idle(table, transports)


# For each part: its title, the content of its file, and the table in README.md.
PARTS = {
    plan.PAIRS: ("Pairs of processes", pairs, aims),
    "fleet": ("Fleets of processes", lambda table, _: fleet_report.costs_and_laws(table, rows),
              lambda table, _: fleet_report.laws_alone(table, rows)),
    "instructions": ("Instructions of a message of 100 B", instructions, instructions),
}


def replaced(readme, begin, text):
    """The text of README.md with another one between that mark and the next end."""
    end = "<!-- up to here -->"
    head, found, rest = readme.partition(begin)
    if not found or end not in rest:
        raise ValueError(f"README.md has no {begin!r} with an end")
    return head + begin + text + end + rest.partition(end)[2]


class Report:
    """What was measured of one part, and where and when."""

    def __init__(self, part, results, transports, load):
        self._part = part
        self._results = results
        self._transports = transports
        self._machine = machine(load)

    def _where_and_when(self):
        where = self._machine
        return (f"{where['date']}, {where['processor']}, {where['processors']} processors, Linux {where['kernel']}, "
                f"other programs used {where['others'] * 100:.0f} % of a processor, commit {where['commit']}, at most "
                f"{self._repetitions()} repetitions of a case.\n\n")

    def _repetitions(self):
        return max((len(values) for contestants in self._results.values() for names in contestants.values()
                    for values in names.values()), default=0)

    def markdown(self):
        title, whole, _ = PARTS[self._part]
        text = f"# {title}\n\nWritten by `run.sh`; [README.md](../README.md) says what was done.\n\n"
        return (text + self._where_and_when() + whole(Table(self._results), self._transports)).rstrip() + "\n"

    def write(self, folder):
        """Into that folder: results/ and its README.md."""
        results = folder / "results"
        results.mkdir(exist_ok=True)
        (results / f"{self._part}.json").write_text(json.dumps(
            {"machine": self._machine, "results": self._results}, indent=1) + "\n")
        (results / f"{self._part}.md").write_text(self.markdown())
        readme = folder / "README.md"
        table = self._where_and_when() + PARTS[self._part][2](Table(self._results), self._transports)
        readme.write_text(replaced(readme.read_text(), f"<!-- {self._part}, written by run.sh -->\n", table))
