"""What a scenario expects beyond what judge.py demands of every run: outcomes, whatever the machine does meanwhile. README.md
lists them."""

import collections

import judge


class Run:
    """A run to be judged: the ledgers, and the faults with the times at which they were done, in s."""

    def __init__(self, ledgers, faults):
        self.lives = {node: judge.read_ledger(text) for node, text in ledgers.items()}
        self.faults = faults

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


def awaited(sights, wanted):
    """What has not come yet of `problems` and `foreign_refused`. `sights`: of the ledgers as they grow."""
    missing = [f"{node} did not report '{text}', but {sights[node].problems}" for node, text in wanted.get("problems", {}).items()
               if not any(text in reason for reason in sights[node].problems)]
    return missing + [f"{node} counted no sample of a program that is no node" for node in wanted.get("foreign_refused", [])
                      if not sights[node].strange_samples]


def least(run, wanted):
    """{"delivered": N, "expired": N, ...}: the least that the links' counters must come to in all."""
    total = collections.Counter()
    for life in run.all_lives():
        for to in {event["to"] for event in life.of("link")}:
            total.update(life.counters(to) or {})
    return [f"{key}: at least {count} wanted, {total[key]} counted" for key, count in wanted.items()
            if total[key] < count]


def refusals_from(run, wanted):
    """{"sender to receiver": [N, M]}: the first note refused was the one after N to M accepted. What is refused before any is
    accepted is for a queue that has not been announced yet."""
    wrong = []
    for name, (fewest, most) in wanted.items():
        sender, to = name.split(" to ")
        accepted = 0
        refused = False
        for event in (e for life in run.lives[sender] for e in life.events if e.values.get("to") == to):
            if event.kind == "refused" and accepted > 0:
                refused = True
                break
            accepted += event.kind == "accepted"
        if not refused or not fewest <= accepted <= most:
            wrong.append(f"{name}: " + (f"refused after {accepted} accepted" if refused else "nothing refused")
                         + f", {fewest} to {most} wanted")
    return wrong


def lives(run, wanted):
    """{node: N}: so many lives."""
    return [f"{node}: {len(run.lives[node])} lives, {count} wanted" for node, count in wanted.items()
            if len(run.lives[node]) != count]


def last_states(run, wanted):
    """true: the last life of each node shows the last post of each State of the others' last lives at the end, and none goes
    back meanwhile."""
    wrong = []
    for node, origin in [(node, origin) for node in run.lives for origin in run.lives if node != origin and wanted]:
        life, posting = run.lives[node][-1], run.lives[origin][-1]
        up = [e.time for e in life.of("peer") if e["node"] == origin and e["state"] == "UP"]
        for message, last in {event["message"]: event.number("number") for event in posting.of("state_posted")}.items():
            seen = [e for e in life.of("state") if e["from"] == origin and e["message"] == message]
            numbers = [e.number("number") for e in seen if up and e.time >= max(posting.begin, up[-1])]
            if numbers != sorted(numbers):
                wrong.append(f"{node} and {message} of {origin}: went back: {numbers}")
            shown = seen[-1].number("number") if seen else "nothing"
            if shown != last or seen[-1].time < posting.begin:
                wrong.append(f"{node} and {message} of {origin}: shows {shown} at the end, not {last}")
    return wrong


def honest_ages(run, wanted):
    """Seconds: the age of each State that a node shows is at most so far from the time since it was posted, and each node
    that posts States is seen by all others."""
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
            if abs(age_s - true_s) > wanted:
                wrong.append(f"{node} and {event['message']} {event['number']} of {event['from']}: age {age_s:.3f} s shown, "
                             f"posted {true_s:.3f} s before")
    return wrong


def no_problem(run, wanted):
    """[text, ...]: no node has reported a problem with one of these words."""
    return [f"{node} reported '{event['reason']}'" for node in run.lives for event in run.events(node, "problem")
            if any(text in event["reason"] for text in wanted)]


ALL = (least, refusals_from, lives, last_states, honest_ages, no_problem)


def check(run, wanted):
    """Everything that a scenario's `expect` names and that is not `awaited`."""
    known = {function.__name__: function for function in ALL}
    return [text for name, value in wanted.items() if name not in ("problems", "foreign_refused")
            for text in known[name](run, value)]
