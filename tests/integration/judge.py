"""Compares the ledgers of all lives of all nodes (README.md lists the lines) and says what is wrong with them.

A life whose ledger has no `end` line was killed. Sound in spite of kills, because a sender writes `intent` before the
call and `accepted` or `refused` after it: of the last intent of a killed life nothing is demanded, save that it comes
once and in order. DELIVERED means put into the receiver's queue, so a kill of the receiver may lose what that queue
held and what was on its way: one unbroken row straight after the last note that the killed life took. The end of
a sender in the middle of its work may lose the end of its row. Whatever else is missing is a loss, or has expired and
must be counted as such. A note whose time is over may be in doubt: part of it was sent, and nobody can say whether it
came. tests/simulation judges that no expired note is delivered (rule 5), and that a note is in doubt only if its receiver was
silent (rule 4): a ledger tells these times only if no thread waits for a processor."""

import collections
import re
import sys

NOTES = "Notes"
PICTURES = "Pictures"

PAIR = re.compile(r'(\w+)=("[^"]*"|\S*)')


class Event:
    __slots__ = ("time", "kind", "values")

    def __init__(self, time_ns, kind, values):
        self.time = time_ns
        self.kind = kind
        self.values = values

    def __getitem__(self, key):
        return self.values[key]

    def number(self, key):
        return int(self.values[key])


class Life:
    """One life of a node: the lines from its `start` on."""

    def __init__(self, start):
        self.node = start["node"]
        self.life = start.number("life")
        self.room = start.number("room")
        self.begin = start.time
        self.events = []
        self._by_kind = collections.defaultdict(list)

    @property
    def killed(self):
        return not self.events or self.events[-1].kind != "end"

    def add(self, event):
        self.events.append(event)
        self._by_kind[event.kind].append(event)

    def of(self, kind):
        return self._by_kind.get(kind, [])

    def counters(self, to, queue=NOTES):
        """The last counters of the link to that queue of that node, or None."""
        last = next((event for event in reversed(self.of("link")) if is_link(event, to, queue)), None)
        return counters_of(last) if last else None


class Pictures:
    """A life's pictures under the names of notes, so that the same rules judge them."""

    KINDS = {"intent": "picture_intent", "accepted": "picture_sent", "refused": "picture_refused",
             "outcome": "picture_outcome", "delivered": "picture"}

    def __init__(self, life):
        self._life = life
        self.node, self.life, self.room, self.killed = life.node, life.life, life.room, life.killed

    def of(self, kind):
        return self._life.of(self.KINDS[kind])

    def counters(self, to):
        return self._life.counters(to, PICTURES)


def is_link(event, to, queue=NOTES):
    return event["to"] == to and event.values.get("queue", NOTES) == queue


def counters_of(link):
    return {key: int(value) for key, value in link.values.items() if key not in ("to", "queue")}


def read_line(line):
    """The event of a line, or None if the line is none, or was cut short by a kill."""
    stamp, _, rest = line.partition(" ")
    if not line.endswith("\n") or not stamp.isdigit():
        return None
    kind, _, pairs = rest.strip().partition(" ")
    return Event(int(stamp), sys.intern(kind), {sys.intern(k): v.strip('"') for k, v in PAIR.findall(pairs)})


def read_ledger(lines):
    """The lives in one node's ledger, given as its text or its lines. A last line that a kill cut short is left out,
    and so is one in the middle that the next life was appended to."""
    lives = []
    for event in map(read_line, lines.splitlines(keepends=True) if isinstance(lines, str) else lines):
        if event is None:
            continue
        if event.kind == "start":
            lives.append(Life(event))
        elif lives:
            lives[-1].add(event)
    return lives


def judge(ledgers):
    """`ledgers`: one text for each node. Returns the list of what is wrong, in words; empty if nothing is."""
    return judge_lives([life for text in ledgers for life in read_ledger(text)])


def judge_lives(lives):
    """The same of lives that were read already."""
    wrong = [f"{life.node}: a note arrived garbled" for life in lives if life.of("garbled")]
    wrong += _judge_queue(lives)
    return wrong + ["pictures: " + text for text in _judge_queue([Pictures(life) for life in lives])]


def _judge_queue(lives):
    by_node = collections.defaultdict(list)
    for life in lives:
        by_node[life.node].append(life)
    wrong = []
    senders = {(life.node, life.life): life for life in lives}
    for node, receiver in by_node.items():
        wrong += _phantoms(node, receiver, senders)
        wrong += _order(node, receiver)
    for sender in lives:
        for to in sorted({event["to"] for event in sender.of("intent")}):
            wrong += _judge_row(sender, to, by_node.get(to, []), sender is not by_node[sender.node][-1])
    return wrong


def _delivered(lives):
    return [event for life in lives for event in life.of("delivered")]


def _phantoms(node, receiver, senders):
    intents = {key: {event.number("id") for event in life.of("intent") if event["to"] == node}
               for key, life in senders.items()}
    return [f"{node}: phantom, {e['from']} never sent note {e['id']} of life {e['life']}" for e in _delivered(receiver)
            if e.number("id") not in intents.get((e["from"], e.number("life")), ())]


def _order(node, receiver):
    wrong = []
    last = {}
    seen = set()
    for event in _delivered(receiver):
        flagged = event.values.get("redelivered") == "1"
        place = (event.number("life"), event.number("id"))
        name = f"{node}: note {event['id']} of {event['from']}"
        if (event["from"], place) in seen:
            if not flagged:
                wrong.append(f"{name} delivered twice (duplicate)")
        elif place < last.get(event["from"], (0, 0)):
            wrong.append(f"{name} delivered out of order")
        seen.add((event["from"], place))
        last[event["from"]] = max(place, last.get(event["from"], (0, 0)))
    return wrong


def _judge_row(sender, to, receiver, followed):
    """What one life of a sender sent to one node. `followed`: it ended, well or not, in the middle of its work, so that
    its last notes may be open and its last counters older than they."""
    open_end = sender.killed or followed
    name = f"{sender.node} to {to}"
    mine = [(life, event) for life in receiver for event in life.of("delivered")
            if event["from"] == sender.node and event.number("life") == sender.life]
    arrived = {event.number("id"): event for _, event in mine}
    intents = {event.number("id"): event for event in sender.of("intent") if event["to"] == to}
    accepted = [event.number("id") for event in sender.of("accepted") if event["to"] == to]
    wrong = [f"{name}: note {event['id']} was refused and yet delivered"
             for event in sender.of("refused") if event["to"] == to and event.number("id") in arrived]
    for number, event in arrived.items():
        if number not in intents:
            continue  # a phantom, told elsewhere
        if intents[number].values.get("octets") != event.values.get("octets"):
            wrong.append(f"{name}: note {number} arrived with another size")

    # A life that was stopped in order and started again has also lost the notes that were on their way to it.
    killed = [life for life in receiver if life.killed or life is not receiver[-1]]
    may_expire = any(float(event["expire_s"]) > 0 for event in intents.values())
    runs = _missing_runs(accepted, arrived)
    missing = sum(len(run) for _, run in runs)
    counters = sender.counters(to)
    if not may_expire:
        after_kill = {None if not taken else taken[-1] for taken in
                      ([e.number("id") for l, e in mine if l is life] for life in killed)}
        room = max((life.room for life in receiver), default=0) * max(1, len(killed))
        for before, run in runs:
            if open_end and run[-1] == accepted[-1]:
                continue
            if killed and before in after_kill and len(run) <= room:
                continue
            wrong.append(f"{name}: {len(run)} accepted notes lost, from {run[0]} to {run[-1]}")
    given_up = {event.number("id") for event in sender.of("outcome")
                if event["to"] == to and event["is"] == "in doubt" and event.number("id") in intents and
                _is_expired(intents[event.number("id")], event.time)}
    wrong += _judge_outcomes(sender, to, name, set(accepted), arrived, killed, open_end, given_up)
    if open_end:
        return wrong
    if counters is None:
        return wrong + ([f"{name}: no outcomes told"] if accepted else [])
    if counters["accepted"] != len(accepted):
        wrong.append(f"{name}: {len(accepted)} notes accepted, the gateway counted {counters['accepted']}")
    told = counters["delivered"] + counters["expired"] + counters["in_doubt"] + counters["undeliverable"]
    if told != len(accepted):
        wrong.append(f"{name}: {len(accepted)} notes accepted, outcomes of {told} told")
    if not killed:
        arrived_in_doubt = len(given_up & arrived.keys())
        if counters["delivered"] != len(arrived) - arrived_in_doubt:
            wrong.append(f"{name}: {len(arrived)} notes arrived, {counters['delivered']} said to be delivered")
        if counters["expired"] != missing - len(given_up) + arrived_in_doubt:
            wrong.append(f"{name}: {missing} accepted notes lost, {counters['expired']} said to be expired")
        if counters["in_doubt"] != len(given_up):
            wrong.append(f"{name}: {counters['in_doubt']} notes in doubt, though the receiver never ended")
    if not may_expire and counters["expired"]:
        wrong.append(f"{name}: {counters['expired']} notes said to be expired that cannot expire")
    return wrong


def _is_expired(intent, told_at):
    return 0 < float(intent["expire_s"]) <= (told_at - intent.time) * 1e-9


def _judge_outcomes(sender, to, name, accepted, arrived, killed, open_end, given_up):
    """What the sender was told of each single note. A kill of the receiver may take along what was delivered. The notes
    in `given_up` may be in doubt."""
    wrong = []
    told = {}
    for event in sender.of("outcome"):
        if event["to"] != to:
            continue
        number = event.number("id")
        if number not in accepted:
            wrong.append(f"{name}: an outcome of note {number}, which was not accepted")
        if number in told:
            wrong.append(f"{name}: note {number} has two outcomes")
        told[number] = event["is"]
    for number, outcome in told.items():
        if outcome == "delivered" and number not in arrived and not killed:
            wrong.append(f"{name}: note {number} was told to be delivered and never arrived")
        if outcome in ("expired", "refused") and number in arrived:
            wrong.append(f"{name}: note {number} was told to be {outcome} and arrived")
        if outcome == "in doubt" and not killed and not open_end and number not in given_up:
            wrong.append(f"{name}: note {number} was told to be in doubt, though nobody ended")
    silent = sorted(accepted - told.keys())
    if silent and not open_end:
        wrong.append(f"{name}: nothing was told of {len(silent)} accepted notes, the first of them {silent[0]}")
    return wrong


def _missing_runs(accepted, arrived):
    """Rows of accepted notes that did not arrive, each with the last note before it that did (or None)."""
    runs = []
    before = None
    run = []
    for number in accepted:
        if number in arrived:
            if run:
                runs.append((before, run))
            before, run = number, []
        else:
            run.append(number)
    return runs + ([(before, run)] if run else [])
