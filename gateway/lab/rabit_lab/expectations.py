"""What a scenario expects, as lines of text: parsed before the run, judged after it."""

import dataclasses
import difflib
import re

from rabit_lab import flight as flights
from rabit_lab import units

# A node that is not heard is LOST after 3.5 s; what explains it lies no further back than this.
LOOK_BACK_S = 4.5
LISTED = 4  # of the things that were wrong

TIME = r"([0-9.]+ ?(?:s|ms|min|h))"
WINDOW = rf"(?:,? after {TIME})?(?:,? before {TIME})?"


@dataclasses.dataclass
class Verdict:
    """One expectation after a run."""
    text: str
    line: int
    good: bool
    detail: str


def outcome(text):
    """`delivered within 2s`: (outcome, seconds)."""
    match = re.fullmatch(rf"(delivered|expired|refused) within {TIME}", text.strip())
    if not match:
        raise ValueError(f"`{text}`: expected `delivered within 2s`; or expired, or refused")
    return match.group(1), units.length(match.group(2))


def optional(text, default):
    return units.length(text) if text else default


class Expectation:
    """One line. `judge` returns (good, detail)."""

    def __init__(self, text, line):
        self.text = text
        self.line = line

    def verdict(self, flight):
        good, detail = self.judge(flight)
        return Verdict(self.text, self.line, good, detail)

    def judge(self, flight):
        raise NotImplementedError


def result(wrong, good):
    """The verdict of a list of what was wrong; `good` is the detail if nothing was."""
    more = f"; and {len(wrong) - LISTED} more" if len(wrong) > LISTED else ""
    return (not wrong, "; ".join(wrong[:LISTED]) + more if wrong else good)


def cause(flight, time, *nodes):
    """What the lab did to these nodes before that time, if anything."""
    if len(nodes) == 2 and flight.out_of_range(time - 2, time, *nodes):
        return "; out of range"
    fault = flight.last_fault(time, *nodes)
    return f"; `{fault.text}` was at {fault.began:g} s" if fault else ""


def unrecorded(flight, nodes):
    """The names among these that wrote no recording, so that nothing is known of what they saw."""
    return [node for node in nodes if not flight.scenario.nodes[node].plain and flight.lives_of(node)
            and not any(life.recorded for life in flight.lives_of(node))]


NO_RECORDING = "wrote no recording: it takes no RABIT_NODE_RECORD (Rabit::RunNode does)"


class AllUp(Expectation):
    """all up within 3s"""

    def __init__(self, text, line, within):
        super().__init__(text, line)
        self.within = within

    def judge(self, flight):
        wrong, latest = [], (0.0, "")
        firsts = {node: flight.lives_of(node)[0] for node in flight.scenario.nodes if flight.lives_of(node)}
        wrong += [f"{node} {NO_RECORDING}" for node in unrecorded(flight, firsts)]
        for index, life in enumerate(flight.lives):
            for node, first in firsts.items():
                if life is not firsts[life.node] or life is first or not life.recorded \
                        or not flight.scenario.share_network(node, life.node):
                    continue
                since = max(life.began, first.began)
                if life.ended is not None and life.ended < since + self.within:
                    continue
                changes = flight.peers[index, node].since(-flights.FOREVER)
                up = next((time for time, peer in changes if peer.state == "UP"), None)
                if up is None or up - since > self.within:
                    wrong.append(f"{life.node} saw {node} UP " + ("never" if up is None else f"after {up - since:.1f} s"))
                else:
                    latest = max(latest, (up - since, f"{node} at {life.node}"))
        return result(wrong, f"after {latest[0]:.1f} s" + (f", the last one {latest[1]}" if latest[1] else ""))


class Reaches(Expectation):
    """uav2 up within 1s after 15s; lost; stale"""

    def __init__(self, text, line, nodes, state, within, after, at):
        super().__init__(text, line)
        self.nodes, self.state, self.within, self.after, self.at = nodes, state, within, after, at

    def holds(self, peer, incarnation):
        if self.state == "UP":
            return peer.state == "UP" and incarnation in (None, peer.incarnation)
        return peer.state == "LOST" or self.state == peer.state

    def judge(self, flight):
        wrong, latest, seen = [], 0.0, 0
        wrong += [f"{node} {NO_RECORDING}" for node in unrecorded(flight, self.at)]
        for node in self.nodes:
            life = flight.life_at(node, self.after + self.within)
            incarnation = life.incarnation if life else None
            for index, observer in flight.observers(node):
                # At the beginning of the run the nodes start one after the other.
                begin = self.after if self.after > 0 else self.within
                if observer.node not in self.at or not observer.is_there(begin) \
                        or not observer.is_there(self.after + self.within) \
                        or any(a < self.after + self.within and b > self.after for a, b in flight.frozen(observer.node)):
                    continue
                seen += 1
                changes = flight.peers[index, node].since(self.after)
                first = next((max(time, self.after) for time, peer in changes if self.holds(peer, incarnation)), None)
                if first is None or first > self.after + self.within:
                    now = flight.peers[index, node].at(self.after + self.within)
                    took = "" if first is None else f", and {self.state} after {first - self.after:.1f} s"
                    wrong.append(f"{observer.node} had {node} {now.state if now else 'unknown'} "
                                 f"{self.within:g} s later{took}"
                                 f"{cause(flight, self.after + self.within, node, observer.node)}")
                else:
                    latest = max(latest, first - self.after)
        if not seen and not wrong:
            wrong.append("no node that records was there to see it")
        return result(wrong, f"after {latest:.1f} s at {seen} node" + ("s" if seen != 1 else ""))


class NoFalseLost(Expectation):
    """no false lost: a node that runs and can be heard is LOST nowhere."""

    def judge(self, flight):
        wrong, lost = [], 0
        for (index, node), changes in flight.peers.items():
            observer = flight.lives[index]
            for time, peer in zip(changes.times, changes.values):
                if peer.state != "LOST" or time >= flight.end:
                    continue
                lost += 1
                began = time - LOOK_BACK_S
                # The incarnation that is LOST has ended, however long the observer took to tell.
                ended = any(life.ended is not None and life.ended <= time
                            and (began <= life.ended or life.incarnation == peer.incarnation) for life in flight.lives_of(node))
                if ended or not flight.life_at(node, time) or flight.disturbed(began, time, node, observer.node) \
                        or flight.out_of_range(began, time, node, observer.node) \
                        or any(a <= time and b >= began for a, b in flight.pauses):
                    continue
                wrong.append(f"{observer.node} lost {node} at {time:.1f} s, which ran and could be heard "
                             f"({peer.reason})")
        return result(wrong, f"{lost} LOST in all, each of a node that was gone or could not be heard")


class Measure(Expectation):
    """uav*/Pose at ground: age p90 < 0.5s, after 20s"""

    def __init__(self, text, line, streams, what, share, below, limit, after, before):
        super().__init__(text, line)
        self.streams, self.what, self.share = streams, what, share
        self.below, self.limit, self.after, self.before = below, limit, after, before

    def value(self, flight, origin, message, observer):
        """(value, explanation)"""
        if self.what == "rate":
            count, there = flight.arrivals(observer, origin, message, self.after, min(self.before, flight.end))
            return (count / there if there else None), f"{count} values in {there:.0f} s"
        pieces = flight.ages(observer, origin, message, self.after, min(self.before, flight.end))
        age, at = flights.oldest(pieces)
        if age is None:
            return None, ""
        return flights.age_below(pieces, self.share), f"oldest {age:.2f} s at {at:.1f} s{cause(flight, at, origin, observer)}"

    def judge(self, flight):
        wrong, worst = [], None
        wrong += [f"{node} {NO_RECORDING}" for node in unrecorded(flight, sorted({s[2] for s in self.streams}))]
        unit = "/s" if self.what == "rate" else " s"
        for origin, message, observer in self.streams if not wrong else []:
            value, why = self.value(flight, origin, message, observer)
            text = f"{origin}/{message} at {observer}: "
            if value is None:
                wrong.append(text + "the node was never there")
            elif value < self.limit if self.below else value > self.limit:
                if worst is None or (value > worst[0]) == self.below:
                    worst = (value, f"{value:.2f}{unit}, {text}{why}")
            else:
                wrong.append(f"{text}{value:.2f}{unit}, {why}")
        return result(wrong, f"at worst {worst[1]}" if worst else "")


class ExitCodes(Expectation):
    """exit codes: 0: of all nodes that were told to end"""

    def __init__(self, text, line, code):
        super().__init__(text, line)
        self.code = code

    def judge(self, flight):
        told = [life for life in flight.lives if life.by in ("stop", "end") and not flight.scenario.nodes[life.node].beside]
        wrong = [f"{life.node} ended with {life.code}" if life.code is not None else
                 f"{life.node} did not end within 10 s of SIGTERM" for life in told if life.code != self.code]
        return result(wrong, f"of {len(told)} processes")


class Stays(Expectation):
    """No node ends by itself. Every scenario expects it."""

    def judge(self, flight):
        wrong = [f"{life.node} ended by itself with {life.code} at {life.ended:.1f} s"
                 + (f": {' | '.join(life.last_lines[-3:])}" if life.last_lines else "")
                 for life in flight.lives if life.by == "itself"]
        return result(wrong, "")


class Says(Expectation):
    """ground says mission complete within 5s after 60s: in its output. `reports`: in its problems or its log."""

    def __init__(self, text, line, nodes, verb, words, within, after):
        super().__init__(text, line)
        self.nodes, self.verb, self.words, self.within, self.after = nodes, verb, words, within, after

    def lines(self, flight):
        if self.verb == "says":
            return flight.output
        return [(time, node, text) for time, node, _, text in flight.logs] \
            + [(problem[4], problem[0], f"{problem[1]}: {problem[3]}") for problem in flight.problems]

    def judge(self, flight):
        wrong, latest = [], 0.0
        for node in self.nodes:
            when = min((time for time, who, text in self.lines(flight)
                        if who == node and self.after <= time <= self.after + self.within
                        and self.words.lower() in text.lower()), default=None)
            if when is None:
                wrong.append(f"{node} did not{cause(flight, self.after + self.within, node)}")
            else:
                latest = max(latest, when)
        return result(wrong, f"at {latest:.1f} s")


class NoProblems(Expectation):
    """no problems, after 20s: no node reports one"""

    def __init__(self, text, line, after, before):
        super().__init__(text, line)
        self.after, self.before = after, before

    def judge(self, flight):
        wrong = [f"{node}: {subject}: {reason} (at {since:.1f} s)"
                 for node, subject, _, reason, since, until in flight.problems
                 if since < min(self.before, flight.end) and (until is None or until > self.after)]
        return result(wrong, "")


class Channel(Expectation):
    """radio: used < 80%, after 20s"""

    def __init__(self, text, line, network, what, limit, after, before):
        super().__init__(text, line)
        self.network, self.what, self.limit, self.after, self.before = network, what, limit, after, before

    def judge(self, flight):
        counts = [(time, counters) for time, counters in flight.radio[self.network]
                  if self.after <= time <= self.before]
        if len(counts) < 2:
            return False, "the channel was not measured in that time"
        (begin, first), (end, last) = counts[0], counts[-1]
        if self.what == "used":
            share = (last["busy_s"] - first["busy_s"]) / (end - begin)
        else:
            def total(counters, key):
                return sum(node[key]["frames"] for node in counters["nodes"].values())
            offered = total(last, "offered") - total(first, "offered")
            share = (total(last, "dropped") - total(first, "dropped")) / max(offered, 1)
        return 100 * share < self.limit, f"{100 * share:.1f} %"


class Sent(Expectation):
    """The expectation of a `send` event."""

    def __init__(self, event):
        super().__init__(f"{event.values['type']} to {event.values['to']} at {event.at:g} s: {event.values['said']}",
                         event.line)
        self.event = event

    def judge(self, flight):
        sent = flight.sent.get(id(self.event))
        wanted, within = self.event.values["expect"]
        if sent is None or not sent.outcome:
            return False, "no outcome" + (f": {sent.reason}" if sent and sent.reason else "")
        text = f"{sent.outcome} after {sent.seconds:.2f} s" + (f": {sent.reason}" if sent.reason else "")
        return sent.outcome == wanted and sent.seconds <= within, text


FORMS = ["all up within 3s", "uav2 up within 1s after 15s", "uav3 lost within 5s after 30s",
         "uav*/Pose at ground: age p90 < 0.5s, after 20s", "uav1/Pose at ground: rate > 8/s", "no false lost",
         "exit codes: 0", "no problems, after 20s", "ground says WORDS within 5s after 60s",
         "ground reports WORDS within 5s after 60s", "radio: used < 80%", "radio: dropped < 1%"]


def parse(text, line, reader, run):
    """The expectation of a line. Raises ValueError, or the reader's error if a name is wrong."""
    text = " ".join(text.split())
    if match := re.fullmatch(rf"all up within {TIME}", text):
        return AllUp(text, line, units.length(match.group(1)))
    if text == "no false lost":
        return NoFalseLost(text, line)
    if match := re.fullmatch(r"exit codes?: (\d+)", text):
        return ExitCodes(text, line, int(match.group(1)))
    if match := re.fullmatch(rf"no problems{WINDOW}", text):
        return NoProblems(text, line, optional(match.group(1), 0.0), optional(match.group(2), run))
    if match := re.fullmatch(rf"(\S+) (up|lost|stale) within {TIME}(?: after {TIME})?(?: at (\S+))?", text):
        node, state, within, after, at = match.groups()
        after = in_run(optional(after, 0.0), run)
        return Reaches(text, line, reader.names(node, line), state.upper(), units.length(within), after,
                       reader.names(at or "*", line))
    if match := re.fullmatch(rf"(\S+) (says|reports) (.+?)(?: within {TIME})?(?: after {TIME})?", text):
        node, verb, words, within, after = match.groups()
        return Says(text, line, reader.processes(node, line), verb, words.strip('"'), optional(within, flights.FOREVER),
                    in_run(optional(after, 0.0), run))
    if match := re.fullmatch(rf"([^\s/]+)/(\S+) at (\S+): (.+?){WINDOW}", text):
        return measure(text, line, reader, run, match)
    if match := re.fullmatch(rf"(\S+): (used|dropped) < ([0-9.]+ ?%){WINDOW}", text):
        network, what, share, after, before = match.groups()
        if network not in reader.networks:
            raise ValueError(f"there is no network `{network}`")
        return Channel(text, line, network, what, units.percent(share), in_run(optional(after, 0.0), run),
                       optional(before, run))
    near = difflib.get_close_matches(text, FORMS, 2, 0.45) or FORMS
    raise ValueError(f"`{text}` is no expectation; they are, for instance: " + "; ".join(near))


def measure(text, line, reader, run, match):
    origins, message, observers, what, after, before = match.groups()
    age = re.fullmatch(rf"age (p\d\d?|median|max) < {TIME}", what)
    rate = re.fullmatch(r"rate ([<>]) ([0-9.]+) ?(?:/s|Hz)", what)
    if not age and not rate:
        raise ValueError(f"`{what}`: expected `age p90 < 0.5s`, `age max < 2s` or `rate > 8/s`")
    streams = [(origin, message, observer) for origin in reader.names(origins, line)
               for observer in reader.names(observers, line) if origin != observer]
    if not streams:
        raise ValueError("a node's own message is not measured at the node")
    after, before = in_run(optional(after, 0.0), run), optional(before, run)
    if age:
        share = {"median": 0.5, "max": 1.0}.get(age.group(1)) or int(age.group(1)[1:]) / 100
        return Measure(text, line, streams, "age", share, True, units.length(age.group(2)), after, before)
    return Measure(text, line, streams, "rate", None, rate.group(1) == "<", float(rate.group(2)), after, before)


def in_run(time, run):
    if time >= run:
        raise ValueError(f"after {time:g} s: the run ends at {run:g} s")
    return time
