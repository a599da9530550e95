"""What a scenario expects beyond what judge.py demands of every run. Each function here that a scenario names under
`expect` gets the value given there and returns what is wrong, in words. README.md lists them."""

import collections

import judge

# Time between a cut and the last beat before it, and between an event and its line in the ledger, on a machine that
# runs other programs as well.
SLACK_S = 1.5
STALE_S = 1.5
BEAT_S = 0.5
TICK_S = 0.1
LOST_S = 3.5
LINE_S = 1.0  # before a line in the ledger: what the machine took then may lie between the line and what it tells
LEASE_S = 3.0
RECOVERY_S = 5.0
RECOVERY_AFTER_LEASE_S = 15.0
FIRST_CONTACT_S = 2.0


class Run:
    """A run to be judged: the ledgers, and the faults with the times at which they were done, in s. `waited(begin, end)`: by
    how much the machine may have delayed what the nodes did from the begin to the end (harness.Waits). Limits of time hold
    for what is beyond that."""

    def __init__(self, ledgers, faults, waited=lambda begin, end: 0.0):
        self.waited = waited
        self.lives = {node: judge.read_ledger(text) for node, text in ledgers.items()}
        self.faults = faults
        self.ended = None  # when the nodes were stopped, in s
        self.air = None  # the radio's counters at the end, in a scenario with a medium

    def losing_since(self):
        """When all packets that are to be lost began to be, in s: what was before says nothing about the loss. 0 where
        none are lost. A fault takes time on a busy machine, so it is done when the next one begins."""
        lossy = [at for at, (_, what, arguments) in enumerate(self.faults) if what == "lose" and arguments[0] < 100]
        return self.faults[min(lossy[-1] + 1, len(self.faults) - 1)][0] if lossy else 0.0

    def took(self, begin, end):
        """Seconds, without those that the machine took."""
        return end - begin - self.waited(begin, end)

    def peer_states(self, life, other):
        """[(time, state, whether the machine explains it)]: what the life saw of the other. It explains a STALE between two
        UP before which it may have delayed beats by as much as makes a node STALE."""
        seen = [(e.time * 1e-9, e["state"]) for e in life.of("peer") if e["node"] == other]
        names = [state for _, state in seen]
        return [(at, state, names[max(i - 1, 0):i + 2] == ["UP", "STALE", "UP"]
                 and self.waited(at - 2 * STALE_S, at) >= BEAT_S) for i, (at, state) in enumerate(seen)]

    def all_lives(self):
        return [life for lives in self.lives.values() for life in lives]

    def links(self):
        """(sender, receiver) -> delays in s of what was delivered, with the times of delivery"""
        intents = {(life.node, life.life, e["to"], e.number("id")): e.time
                   for life in self.all_lives() for e in life.of("intent")}
        delays = collections.defaultdict(list)
        for life in self.all_lives():
            for e in life.of("delivered"):
                sent = intents.get((e["from"], e.number("life"), life.node, e.number("id")))
                if sent is not None:
                    delays[e["from"], life.node].append((e.time * 1e-9, (e.time - sent) * 1e-9))
        return delays

    def events(self, node, kind):
        return [event for life in self.lives[node] for event in life.of(kind)]

    def share_of_ticks(self, node, origin):
        """Of the ticks from the first to the last that the node saw, those that it saw; how many there were; and the share
        that the machine may have taken: the newest tick replaces one that was not fetched in time."""
        events = [event for event in self.events(node, "tick")
                  if event["from"] == origin and event.time * 1e-9 > self.losing_since()]
        if not events:
            return 0.0, 0, 0.0
        seen = {event.number("number") for event in events}
        span = max(seen) - min(seen) + 1
        return len(seen) / span, span, self.waited(events[0].time * 1e-9, events[-1].time * 1e-9) / TICK_S / span


def least(run, wanted):
    """{"delivered": N, "expired": N, ...}: the least that the links' counters must come to in all."""
    total = collections.Counter()
    for life in run.all_lives():
        for to in {event["to"] for event in life.of("link")}:
            total.update(life.counters(to) or {})
    return [f"{key}: at least {count} wanted, {total[key]} counted" for key, count in wanted.items()
            if total[key] < count]


def _all_named(wanted, names):
    """The items, with one for each of the names in place of `*`."""
    return [(name, wanted.get(name, wanted.get("*"))) for name in sorted({*names, *wanted} - {"*"})
            if name in wanted or "*" in wanted]


def states(run, wanted):
    """{node: {other: [state, ...]}}: how the node's last life saw the other, from its first UP on; [] is never. `*` is each
    node that is not named."""
    wrong = []
    for node, others in _all_named(wanted, run.lives):
        for other, expected in _all_named(others, set(run.lives) - {node}):
            rows = [row[1:] for life in run.lives[node][-1:] for row in run.peer_states(life, other)]
            seen = [state for state, _ in rows]
            first = seen.index("UP") if "UP" in seen else len(seen)
            if not _fits(rows[first:], expected):
                wrong.append(f"{node} saw {other} as {seen[first:]}, not {expected}")
    return wrong


def _fits(rows, expected):
    """True if these are the states that are expected, and besides them only those that the machine explains."""
    if not rows:
        return not expected
    (state, explained), rest = rows[0], rows[1:]
    return (explained and _fits(rest[1:], expected)) or (state in expected[:1] and _fits(rest, expected[1:]))


def delay_p99_ms(run, wanted):
    """{node: ms}: of all links to and from that node, from FIRST_CONTACT_S after their first note on: what comes before
    waits until the two ends have found each other."""
    wrong = []
    for (origin, node), rows in sorted(run.links().items()):
        limit = min((wanted[end] for end in (origin, node) if end in wanted), default=None)
        since = max(run.losing_since(), min(time - delay for time, delay in rows) + FIRST_CONTACT_S)
        delays = sorted(run.took(time - delay, time) for time, delay in rows if time - delay > since)
        p99 = 1000 * delays[len(delays) * 99 // 100] if delays else 0.0
        if limit is not None and p99 > limit:
            wrong.append(f"{origin} to {node}: delay p99 {p99:.0f} ms, at most {limit} ms wanted")
    return wrong


def resent_at_most(run, wanted):
    """How many times the fresh messages of a link may have been sent again."""
    wrong = []
    for life in run.all_lives():
        for to in sorted({event["to"] for event in life.of("link")}):
            counters = life.counters(to)
            if counters and counters["resent"] > wanted * counters["accepted"]:
                wrong.append(f"{life.node} to {to}: {counters['resent']} resent, {counters['accepted']} accepted")
    return wrong


def ticks(run, wanted):
    """{node: percent lost}: the share of its ticks that others saw, and of theirs that it saw, fits that loss: within
    four standard deviations of the binomial distribution. Fewer by two ticks, a tenth and what the machine took may be seen;
    more may not."""
    wrong = []
    for node, percent in wanted.items():
        arrives = 1 - percent / 100
        # Between two nodes that are not in `wanted`, the later fault of the two holds.
        others = [other for other in run.lives if other not in wanted and run.events(other, "tick")]
        for reader, origin in [(other, node) for other in others] + [(node, other) for other in others]:
            share, span, taken = run.share_of_ticks(reader, origin)
            if span < 50:
                wrong.append(f"{reader} saw too few ticks of {origin} to judge: {share * span:.0f}")
                continue
            spread = 4 * (arrives * (1 - arrives) / span) ** 0.5
            if not arrives - spread - 0.1 - 2 / span - taken <= share <= arrives + spread + 0.02:
                wrong.append(f"{reader} saw {100 * share:.0f} % of {span} ticks of {origin}; {percent} % are lost")
    return wrong


def _outages(run):
    """(node, whether it hears nothing, whether it is not heard, begin, end), from the faults; both in s."""
    began = {}
    for time, what, arguments in run.faults:
        if what == "cut":
            began[arguments[0]] = (True, True, time)
        elif what == "lose" and arguments[0] == 100:
            for node in (arguments[1] if len(arguments) > 1 and arguments[1] else []):
                began[node] = (False, True, time)
            for node in (arguments[2] if len(arguments) > 2 and arguments[2] else []):
                began[node] = (True, False, time)
        elif what == "heal":
            for node, (deaf, mute, begin) in began.items():
                yield node, deaf, mute, begin, time
            began = {}


def timely(run, observer):
    """The observer sees each node that is not heard STALE and LOST in time, and UP in time after the healing; and
    within that time the links between the two deliver again."""
    wrong = []
    links = run.links()
    for node, deaf, mute, begin, end in _outages(run):
        name = f"{node} cut for {end - begin:.0f} s"
        seen = [(e.time * 1e-9, e["state"]) for e in run.events(observer, "peer") if e["node"] == node]
        recovery = (RECOVERY_S if end - begin < LEASE_S else RECOVERY_AFTER_LEASE_S)
        wanted = [("STALE", begin, STALE_S), ("LOST", begin, LOST_S)] if mute else []
        wanted = [row for row in wanted if row[1] + row[2] + SLACK_S < end]
        if wanted:
            wanted.append(("UP", end, recovery))
        for state, since, within in wanted:
            first = next((time for time, now in seen if now == state and time > since), None)
            if first is None or run.took(since, first) > within + (0 if state == "UP" else SLACK_S):
                wrong.append(f"{name}: {observer} saw it {state} "
                             + (f"{first - since:.1f} s after" if first else "never") + f", at most {within} s wanted")
        for pair in ((observer, node), (node, observer)):
            first = next((time for time, _ in links[pair] if time > end), None)
            if links[pair] and (first is None or run.took(end, first) > recovery):
                wrong.append(f"{name}: first note from {pair[0]} to {pair[1]} "
                             + (f"{first - end:.1f} s after" if first else "never") + f", at most {recovery} s wanted")
    return wrong


def refusals_from(run, wanted):
    """{"sender to receiver": N}: the first note refused was the one after N accepted. What is refused before any is
    accepted is for a queue that has not been announced yet."""
    wrong = []
    for name, limit in wanted.items():
        sender, to = name.split(" to ")
        accepted = 0
        refused = False
        for event in (e for life in run.lives[sender] for e in life.events if e.values.get("to") == to):
            if event.kind == "refused" and accepted > 0:
                refused = True
                break
            accepted += event.kind == "accepted"
        if not refused or accepted != limit:
            wrong.append(f"{name}: " + (f"refused after {accepted} accepted" if refused else "nothing refused")
                         + f", {limit} wanted")
    return wrong


def problems(run, wanted):
    """{node: text}: the node has reported a problem with these words."""
    return [f"{node} did not report '{text}', but {[e.values for e in run.events(node, 'problem')]}"
            for node, text in wanted.items()
            if not any(text in event["reason"] for event in run.events(node, "problem"))]


def foreign_refused(run, wanted):
    """[node, ...]: these have counted samples of a program that is no node."""
    return [f"{node} counted no sample of a program that is no node" for node in wanted
            if not any(e["from"] == "" and e["refused"] != "0" for e in run.events(node, "topic"))]


def lives(run, wanted):
    """{node: N}: so many lives."""
    return [f"{node}: {len(run.lives[node])} lives, {count} wanted" for node, count in wanted.items()
            if len(run.lives[node]) != count]


def offered_at_most(run, wanted):
    """Percent of what the medium can carry, that all nodes together gave to their queues, over the whole run."""
    offered = sum(node["offered"]["bytes"] for node in run.air["nodes"].values())
    percent = 100 * 8 * offered / run.air["seconds"] / run.air["bits_per_s"]
    return [f"{percent:.0f} % of the medium offered, at most {wanted} % wanted"] if percent > wanted else []


def last_states(run, wanted):
    """Seconds: each last life shows the last post of each State of the others' last lives, no later than that after the
    post, or after it saw the other one UP, whichever is later; and none goes back meanwhile."""
    wrong = []
    for node, lives_of_node in run.lives.items():
        for origin, lives_of_origin in run.lives.items():
            if node == origin:
                continue
            posted = {}
            for event in lives_of_origin[-1].of("state_posted"):
                posted[event["message"]] = event
            up = [e.time for e in lives_of_node[-1].of("peer") if e["node"] == origin and e["state"] == "UP"]
            for message, last in posted.items():
                name = f"{node} and {message} of {origin}"
                seen = [e for e in lives_of_node[-1].of("state") if e["from"] == origin and e["message"] == message]
                found = [e for e in seen if e.time >= last.time and e["number"] == last["number"]]
                since = max([last.time, *up[-1:]]) * 1e-9
                if not found or seen[-1]["number"] != last["number"]:
                    wrong.append(f"{name}: shows {seen[-1]['number'] if seen else 'nothing'} at the end, not "
                                 + last["number"])
                elif run.took(since, found[0].time * 1e-9) > wanted:
                    wrong.append(f"{name}: shown {found[0].time * 1e-9 - since:.1f} s late, at most {wanted} s wanted")
                begun = [e for e in seen if e.time >= lives_of_origin[-1].begin and up and e.time >= up[-1]]
                numbers = [e.number("number") for e in begun]
                if numbers != sorted(numbers):
                    wrong.append(f"{name}: went back: {numbers}")
    return wrong


def state_samples_at_most(run, wanted):
    """[times, more]: of each State in the last life of each node so many times its posts were written, and so many more
    for who was not there yet when it was posted."""
    times, more = wanted
    wrong = []
    for node, lives_of_node in run.lives.items():
        posts = collections.Counter(e["message"] for e in lives_of_node[-1].of("state_posted"))
        written = {e["message"]: e.number("written") for e in lives_of_node[-1].of("state_samples")}
        wrong += [f"{node}: {message} was posted {count} times and written {written.get(message, 0)} times"
                  for message, count in posts.items() if written.get(message, 0) > times * count + more]
    return wrong


def honest_ages(run, wanted):
    """Seconds: the age of each State that a node shows is at most so far from the time since it was posted, and each node
    that posts States is seen by all others. If a thread waits after it took the age and before it writes its line, the age in
    the line is too small. No wait makes it too large."""
    wrong = []
    posted = {(life.node, event["message"], event["number"]): (life.begin, event.time)
              for life in run.all_lives() for event in life.of("state_posted")}
    origins = {node for node, _, _ in posted}
    for node in run.lives:
        seen = run.events(node, "state")
        missing = origins - {node} - {event["from"] for event in seen}
        wrong += [f"{node} saw no State of {origin}" for origin in sorted(missing)]
        for event in seen:
            begun, at = posted.get((event["from"], event["message"], event["number"]), (0, 0))
            # A later life of the origin posts the same numbers again.
            if not at or event.time < begun or len(run.lives[event["from"]]) > 1:
                continue
            age_s, true_s = float(event["age_s"]), (event.time - at) * 1e-9
            waited = run.waited(event.time * 1e-9 - LINE_S, event.time * 1e-9)
            if not -wanted - waited <= age_s - true_s <= wanted:
                wrong.append(f"{node} and {event['message']} {event['number']} of {event['from']}: age {age_s:.3f} s shown, "
                             f"posted {true_s:.3f} s before")
    return wrong


def starved_at_most(run, wanted):
    """Seconds between two notes of a sender that are taken, while more of its accepted ones wait."""
    wrong = []
    for receiver, lives_of_node in run.lives.items():
        last = {}
        for event in (e for life in lives_of_node for e in life.of("delivered")):
            last.setdefault(event["from"], []).append(event.time)
        for origin, taken in last.items():
            accepted = sorted(e.time for life in run.lives[origin] for e in life.of("accepted") if e["to"] == receiver)
            # The note taken at taken[i] waited from its acceptance on, and without a turn since the one before was
            # taken.
            longest = max((run.took(max(before, since) * 1e-9, now * 1e-9)
                           for before, now, since in zip(taken, taken[1:], accepted[1:])), default=0)
            if longest > wanted:
                wrong.append(f"{origin} to {receiver}: {longest:.1f} s without a turn, at most {wanted} s wanted")
    return wrong


def ticks_begin_within(run, wanted):
    """Seconds: each life that lasts longer is seen to tick so soon, by all others that live then."""
    wrong = []
    for node, lives_of_node in run.lives.items():
        begins = [life.begin * 1e-9 for life in lives_of_node]
        for begin, end in zip(begins, [*begins[1:], run.ended]):
            if not lives_of_node[0].of("tick") or end - begin <= wanted:
                continue
            for other in run.lives:
                if other == node or not any(life.begin * 1e-9 < begin and life is run.lives[other][-1]
                                            for life in run.lives[other]):
                    continue
                first = min((e.time * 1e-9 for e in run.events(other, "tick") if e["from"] == node and e.time * 1e-9 > begin),
                            default=None)
                if first is None or run.took(begin, first) > wanted:
                    wrong.append(f"{other} saw no tick of {node} within {wanted} s after its start")
    return wrong


def no_problem(run, wanted):
    """[text, ...]: no node has reported a problem with one of these words."""
    return [f"{node} reported '{event['reason']}'" for node in run.lives for event in run.events(node, "problem")
            if any(text in event["reason"] for text in wanted)]


def back_within(run, wanted):
    """Seconds: each node that was killed is shown UP by all that live so long after its last start, and is not shown
    otherwise after that."""
    wrong = []
    started = {}
    for time, what, arguments in run.faults:
        if what == "start":
            started[arguments[0]] = time
    for node, since in started.items():
        for other in run.lives:
            if other == node:
                continue
            rows = run.peer_states(run.lives[other][-1], node)
            early = [state for time, state, _ in rows if time <= since or run.took(since, time) <= wanted]
            late = [state for (time, state, explained), before in zip(rows, [(0, "", False), *rows])
                    if time > since and run.took(since, time) > wanted and time < run.ended and not explained and not before[2]]
            if early[-1:] != ["UP"] or late:
                wrong.append(f"{other} saw {node} as {early[-1] if early else 'nothing'} {wanted} s after its last start, "
                             f"later as {late}")
    return wrong


ALL = (offered_at_most, honest_ages, starved_at_most, ticks_begin_within, no_problem, back_within, least, states, delay_p99_ms, resent_at_most, ticks, timely, refusals_from, problems, foreign_refused, lives,
       last_states, state_samples_at_most)


def check(run, wanted):
    """Everything that a scenario's `expect` names."""
    known = {function.__name__: function for function in ALL}
    return [text for name, value in wanted.items() for text in known[name](run, value)]
