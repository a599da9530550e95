"""A recorded flight over another radio: `rabit lab replay`. The program lab_replay flies it in simulated time, and tells what
each node sent and received. Equal recordings, options and seeds give equal files. real_time.py flies it in real time."""

import collections
import dataclasses
import json
import pathlib
import subprocess
import typing

from rabit_lab import flight as flights, plots, report, scenario as scenarios, table, units
from rabit_lab.marked import ScenarioError

ETHERNET = 14  # bytes that a frame of the lab's radio has before its IP packet


@dataclasses.dataclass
class Option:
    """An option of the command line."""
    name: str
    word: str
    text: str
    unit: typing.Callable
    default: typing.Optional[str] = None


LONGEST_DELAY = 3600  # seconds
NOT_FLOWN = ("Cuts, losses and freezes of the recorded flight are not repeated. Nodes end and begin when they did, and post what they "
             "posted. --after and --before leave times out of the figures.")

OPTIONS = [
    Option("radio", "RATE", "rate of the channel, which all share, as 57.6kbit/s; default: unlimited", units.bits_per_second, "unlimited"),
    Option("loss", "SHARE", "share of the datagrams that each receiver loses, as 10%%; default: 0%%", units.percent, "0%"),
    Option("burst", "NUMBER", "datagrams that are lost in a row, on average; default: 1", units.burst, "1"),
    Option("delay", "TIME", "time that each datagram takes after the air; default: 0s", units.length, "0s"),
    Option("jitter", "TIME", "largest difference from the delay, and no more than it; default: 0s", units.length, "0s"),
    Option("queue", "SIZE", "bytes that wait at each node's radio at most; default: 16kB", units.size, "16kB"),
    Option("overhead", "SIZE", "bytes that each frame takes in addition; default: 0B", units.size, "0B"),
    Option("budget", "RATE", "budget of each node, as 1500B/s, or auto; default: those of the recorded configurations",
           units.bytes_per_second),
    Option("after", "TIME", "time from which values are counted; default: 0s", units.length, "0s"),
    Option("before", "TIME", "time up to which values are counted; default: the end of the flight", units.length),
    Option("seed", "NUMBER", "start of the random numbers, a whole number; default: 1", units.seed, "1"),
]


@dataclasses.dataclass
class Radio:
    """The radio of a flight, and what else was asked for."""
    radio: float
    loss: float
    burst: float
    delay: float
    jitter: float
    queue: int
    overhead: int
    budget: typing.Optional[float]
    after: float
    seed: int
    before: typing.Optional[float] = None  # the end of the flight

    @property
    def span(self):
        """(from, to): the time of which values are counted."""
        return self.after, flights.FOREVER if self.before is None else self.before

    @staticmethod
    def of(options):
        """Raises ScenarioError for an option that is no quantity, or that cannot be flown."""
        values = {}
        for option in OPTIONS:
            text = getattr(options, option.name)
            try:
                values[option.name] = option.unit(text) if text is not None else None
            except ValueError as error:
                raise ScenarioError(f"--{option.name}", str(error)) from None
        if values["delay"] > LONGEST_DELAY:
            raise ScenarioError("--delay", f"`{options.delay}`: a delay is at most {LONGEST_DELAY} s")
        if values["jitter"] > values["delay"]:
            raise ScenarioError("--jitter", f"`{options.jitter}` is more than the delay of `{options.delay}`; name a longer --delay")
        return Radio(**values)

    def text(self):
        """As people read it."""
        words = [f"{self.radio / 1000:g} kbit/s" if self.radio else "a radio without a limit"]
        words += [f"{self.loss:g} % loss"] if self.loss else []
        words += [f"in bursts of {self.burst:g}"] if self.loss and self.burst > 1 else []
        words += [f"{1000 * self.delay:g} ms delay"] if self.delay else []
        words += [f"{1000 * self.jitter:g} ms jitter"] if self.jitter else []
        if self.budget is not None:
            words.append(f"a budget of {self.budget:g} B/s for each node" if self.budget else "no budget")
        return ", ".join(words)

    def argv(self):
        words = {"rate": self.radio / 8, "queue": self.queue, "overhead": ETHERNET + self.overhead, "loss": self.loss,
                 "burst": self.burst, "delay": self.delay - self.jitter, "jitter": 2 * self.jitter, "budget": self.budget,
                 "seed": self.seed}
        return [word for name, value in words.items() if value is not None for word in (f"--{name}", str(value))]


@dataclasses.dataclass
class Flown:
    """A simulated flight, or one in real time, and the recorded one."""
    simulated: flights.Flight
    recorded: flights.Flight  # only its values
    queues: list
    medium: list


def fly(program, files, radio):
    """Runs lab_replay, and returns what it tells."""
    return read(files[0], tell(program, files, radio.argv()), radio)


def tell(program, files, options):
    """The facts of lab_replay."""
    done = subprocess.run([program, *files, *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        raise ScenarioError(files[0], done.stderr.strip().removeprefix(f"{files[0]}: ") or f"lab_replay ended with {done.returncode}")
    return [json.loads(line) for line in done.stdout.splitlines()]


def read(name, facts, radio):
    """What the facts of lab_replay say. Raises ScenarioError if nothing is left to count."""
    end = facts[0]["end"] / 1e9
    if radio.after > 0 and radio.after >= end:
        raise ScenarioError("--after", f"{radio.after:g} s is not before the end of the flight at {end:.1f} s; name an earlier time")
    if radio.before is not None and radio.before <= radio.after:
        raise ScenarioError("--before", f"{radio.before:g} s is not behind the {radio.after:g} s of --after; name a later time")
    nodes = sorted({fact["node"] for fact in facts if fact["fact"] == "life"})
    channel = scenarios.Network("radio", nodes, rate=radio.radio, queue=radio.queue)
    made = scenarios.Scenario(pathlib.Path(name), pathlib.Path("."),
                              {node: scenarios.Node(node, [], "", {}, 0.0, False, 0) for node in nodes}, {"radio": channel},
                              end, [], [], None)
    flown = Flown(flights.Flight(made), flights.Flight(made), [], [])
    flown.simulated.notes.append(NOT_FLOWN)
    indexes = {}
    for fact in facts:
        kind = fact["fact"]
        if kind == "life":
            indexes[fact["file"]] = add_life(flown, fact)
        elif kind == "note":
            flown.simulated.notes.append(fact["text"])
        elif kind == "medium":
            flown.medium.append(fact)
        elif kind == "queue":
            flown.queues.append(fact)
        elif kind == "flown":
            add_recorded(flown.recorded, fact)
        elif kind != "flight":
            flown.simulated.take(fact, indexes[fact["file"]], lambda time: time / 1e9)
    return flown


def add_life(flown, fact):
    """Returns its index."""
    node, began = fact["node"], fact["t"] / 1e9
    ended = fact["ended"] / 1e9 if fact["ended"] is not None else None
    for flight in (flown.simulated, flown.recorded):
        number = len(flight.lives_of(node)) + 1
        flight.lives.append(flights.Life(node, number, began, ended=ended, code=0, by="in the recording", recorded=True))
        if number > 1:
            flight.faults.append(flights.Fault(began, began, "start", [node], f"{node} begins anew"))
        if ended is not None:
            flight.faults.append(flights.Fault(ended, ended, "kill", [node], f"the recording of {node} ends"))
    return len(flown.simulated.lives) - 1


def add_recorded(flight, fact):
    """The values that a node received, to its lives."""
    for arrived, posted in zip(fact["arrived"], fact["posted"]):
        for index, life in enumerate(flight.lives):
            if life.node == fact["at"] and life.is_there(arrived / 1e9):
                flight.values[index, fact["node"], fact["message"]].append((arrived / 1e9, posted / 1e9))


@dataclasses.dataclass
class Row:
    """A message, of all nodes at all others, or one stream of it."""
    message: str
    streams: int
    posted: int
    went_out: int
    due: int  # arrivals, if nothing is lost that went out while the observer was there
    arrived: int
    delay_p90: float  # from the post to the arrival
    p50: float
    p90: float
    worst: typing.Optional[float]  # None: no observer was there
    where: str
    recorded_p90: typing.Optional[float]  # None: the recorder left the message out


def streams(flown):
    """{(observer, origin, message)} of both flights."""
    return {(flight.lives[index].node, origin, message) for flight in (flown.simulated, flown.recorded)
            for index, origin, message in flight.values if flight.lives[index].node != origin}


def left_out(flown, origin, message, after, end):
    """The share of the posts from that time on that never went out, since a newer one came first."""
    offered = replaced = 0
    for index, life in enumerate(flown.simulated.lives):
        counts = flown.simulated.published.get((index, message), []) if life.node == origin else []
        before = [count for count in counts if count[0] <= after] or [(0, 0, 0)]
        counted = [count for count in counts if count[0] <= end]
        if counted:
            offered += counted[-1][1] - before[-1][1]
            replaced += counted[-1][2] - before[-1][2]
    return replaced / offered if offered else 0


def row(flown, message, chosen, after, before):
    """The figures of some streams of one message."""
    simulated, recorded = flown.simulated, flown.recorded
    end = min(before, simulated.end)
    mine, theirs, oldest = [], [], []
    out, posts, due, arrived, delays = {}, {}, 0, 0, []
    for observer, origin, _ in sorted(chosen):
        posted = sorted(at for index, life in enumerate(simulated.lives) if life.node == origin
                        for _, at in simulated.values.get((index, origin, message), []))
        sent_share = 1 - left_out(flown, origin, message, after, before)
        posts[origin] = sum(after <= at < before for at in posted)
        out[origin] = round(posts[origin] * sent_share)
        since = posted[0] if posted else 0.0
        found = simulated.ages(observer, origin, message, max(after, since), end, since)
        mine += found
        oldest += [(*flights.oldest(found), f"{origin} at {observer}")] if found else []
        if any(recorded.values.get((index, origin, message)) for index in lives_of(recorded, observer)):
            theirs += recorded.ages(observer, origin, message, max(after, since), end, since)
        there = [simulated.lives[index] for index in lives_of(simulated, observer)]
        wanted = round(sent_share * sum(after <= at < before and any(life.is_there(at) for life in there) for at in posted))
        due += wanted
        came = [at - sent for index in lives_of(simulated, observer)
                for at, sent in simulated.values.get((index, origin, message), [])
                if after <= sent < before and simulated.lives[index].is_there(sent)]
        arrived += min(len(came), wanted)  # a State comes again after an outage
        delays += came
    worst, at, where = max(oldest, default=(None, None, "-"))
    return Row(message, len(chosen), sum(posts.values()), sum(out.values()), due, arrived, quantile(delays, 0.9),
               flights.age_below(mine, 0.5), flights.age_below(mine, 0.9), worst,
               where if at is None else f"{where}, at {at:.1f} s", flights.age_below(theirs, 0.9))


def lives_of(flight, node):
    """The indexes of its lives."""
    return [index for index, life in enumerate(flight.lives) if life.node == node]


def quantile(values, part):
    """None of no values."""
    ordered = sorted(values)
    return ordered[min(int(part * len(ordered)), len(ordered) - 1)] if ordered else None


def rows(flown, after, before=flights.FOREVER):
    """(one for each message, one for each stream)"""
    by_message = collections.defaultdict(set)
    for stream in streams(flown):
        by_message[stream[2]].add(stream)
    return ([row(flown, message, chosen, after, before) for message, chosen in sorted(by_message.items())],
            [(stream, row(flown, message, {stream}, after, before)) for message, chosen in sorted(by_message.items())
             for stream in sorted(chosen)])


def seconds(value):
    return "-" if value is None else f"{value:.2f} s"


def share(part, whole):
    return f"{100 * part / whole:.1f} %" if whole else "-"


HEADS = ("message", "streams", "posted", "went out", "arrived", "delay p90", "age p50", "age p90", "oldest", "where",
         "age p90 as recorded")


def cells(one):
    """In the order of HEADS."""
    return (one.message, one.streams, one.posted, share(one.went_out, one.posted), share(one.arrived, one.due), seconds(one.delay_p90),
            seconds(one.p50), seconds(one.p90), seconds(one.worst), one.where, seconds(one.recorded_p90))


FILES = [("what_if.json", "the figures, for programs"), ("plots/", "the pictures above"), *report.RUN_FILES[:-2]]

QUEUE_HEADS = ("from", "queue", "sent", "refused", "delivered", "other outcomes", "delay p50", "p90", "worst")


def queue_cells(fact):
    """In the order of QUEUE_HEADS."""
    ages = [age / 1e9 for age in fact["ages"]]
    others = ", ".join(f"{count} {name}" for name, count in fact["outcomes"].items() if name != "delivered")
    return (fact["from"], f"{fact['to']}/{fact['queue']}", fact["sent"], fact["refused"], fact["outcomes"].get("delivered", 0), others,
            *(seconds(quantile(ages, part)) for part in (0.5, 0.9, 1)))


NODE_HEADS = ("node", "sends on average", "in its worst second", "budget", "lowest estimate of the channel")


def node_cells(flown, node, after, before):
    """What a node's limits left it, as its gateway tells."""
    points = [point for point in flown.simulated.air.get(node, []) if after <= point[0] < before]
    used = [point[1] for point in points] or [0]
    budget = max((point[2] for point in points), default=0)
    capacity = min((point[3] for point in points if point[3] > 0), default=0)
    return (node, f"{sum(used) / len(used):.0f} B/s", f"{max(used):.0f} B/s", f"{budget:.0f} B/s" if budget else "none",
            f"{capacity:.0f} B/s" if capacity else "not the limit")


def medium_text(flown, radio):
    """One line on the channel."""
    last, end = flown.medium[-1], flown.simulated.end
    frames = last["carried"] + last["dropped"]
    text = f"{last['bytes'] * 8 / max(end, 1e-9) / 1000:.1f} kbit/s on the air"
    if radio.radio:
        text += (f", {share(last['bytes'] * 8, radio.radio * end)} used; queues dropped {share(last['dropped'], frames)} of the "
                 f"frames; longest wait {seconds(last['longest_wait'] / 1e9)}")
    return text


def medium_pictures(flown, radio):
    """The use of the channel over time, as SVG."""
    points = [((second["t"] + first["t"]) / 2e9, (second["bytes"] - first["bytes"]) * 8e9 / (second["t"] - first["t"]))
              for first, second in zip(flown.medium, flown.medium[1:])]
    if not points:
        return ""
    scale, unit = (100 / radio.radio, "%") if radio.radio else (1e-3, "kbit/s")
    return plots.lines("Use of the radio", flown.simulated, unit, {"on the air": [(time, scale * rate) for time, rate in points]})


def html_table(heads, found):
    words = {0, *(n for n, head in enumerate(heads) if head in ("where", "queue", "other outcomes"))}

    def line(kind, line_cells):
        return "<tr>" + "".join(f'<{kind} class="{"" if n in words else "number"}">{report.escape(cell)}</{kind}>'
                                for n, cell in enumerate(line_cells)) + "</tr>"
    return f"<table class='figures'>{line('th', heads)}{''.join(line('td', one) for one in found)}</table>"


def print_table(heads, found):
    """Columns as wide as their widest cell."""
    lines = [[table.safe(cell) for cell in line] for line in (heads, *found)]
    widths = [max(len(line[n]) for line in lines) for n in range(len(heads))]
    for line in lines:
        print("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip())


def show(flown, radio, folder):
    """Prints the figures, and writes the report."""
    flight = flown.simulated
    messages, single = rows(flown, *radio.span)
    nodes = [node_cells(flown, node, *radio.span) for node in flight.scenario.nodes]
    queues = [queue_cells(fact) for fact in flown.queues]
    name = flight.scenario.path.stem
    summary = f"{len(nodes)} nodes, {flight.end:.1f} s over {radio.text()}" + (", in real time" if flight.radio else "")
    print(f"{name}: {summary}\n{medium_text(flown, radio)}\n")
    print_table(HEADS, [cells(one) for one in messages])
    if queues:
        print()
        print_table(QUEUE_HEADS, queues)
    for note in flight.notes:
        print(table.safe(note))
    write_json(flown, radio, messages, single, folder / "what_if.json")
    notes = "".join(f"<p>{report.escape(note)}</p>" for note in flight.notes)
    stream_rows = [(f"{origin}/{message} at {observer}", *cells(one)[2:9], seconds(one.recorded_p90))
                   for (observer, origin, message), one in single]
    shown = report.save_pictures(flight.scenario, flight, folder)
    sections = [("Messages", html_table(HEADS, [cells(one) for one in messages]) + notes)]
    if queues:
        sections.append(("Queues", html_table(QUEUE_HEADS, queues)))
    sections += [("What the limits left each node", f"<p>{report.escape(medium_text(flown, radio))}</p>"
                  + html_table(NODE_HEADS, nodes)),
                 ("Events", report.event_rows(flight)),
                 ("Over time", medium_pictures(flown, radio) + shown),
                 ("Streams", html_table(("stream", *HEADS[2:9], HEADS[10]), stream_rows)),
                 ("Log", report.log_section(flight)),
                 ("Files", report.file_rows(folder, FILES))]
    if flight.radio:
        sections.insert(-2, ("Channels", report.census(flight.scenario, flight)))
    report.write_page(folder / "report.html", f"{name}: what if", True, summary, sections)


def write_json(flown, radio, messages, single, path):
    """The figures, for programs."""
    path.write_text(json.dumps({
        "radio": dataclasses.asdict(radio), "seconds": flown.simulated.end, "medium": flown.medium[-1],
        "messages": [dataclasses.asdict(one) for one in messages],
        "streams": [{"at": observer, "node": origin} | dataclasses.asdict(one) for (observer, origin, _), one in single],
        "queues": flown.queues}, indent=1), encoding="utf-8")
