"""What a scenario does to a fleet: one method for each word of an event."""

import json
import signal

from rabit_lab import flight as flights, keys

LOOK_S = 0.3  # between two looks whether a node has told its domain
SORTS = {"cut": "hearing", "deaf": "hearing"}  # faults that change the same
OUTCOME_S = 3  # of a `send` that expects nothing
JOIN_S = 6  # before a `send` the tool joins the network, so that its outcome is not late by that


class Faults:
    """Carries out events when they are due, and ends them."""

    def __init__(self, scenario, nets, nodes, flight, places, say):
        self._scenario, self._nets, self._nodes, self._flight = scenario, nets, nodes, flight
        self._places, self._say = places, say
        self._due = []  # (time, what is to be done)
        self._active = []  # events that last
        self._senders = {}  # event id -> (Process, [time of the message])
        for event in scenario.events:
            self._due.append((event.at, lambda event=event: self._begin(event)))
            if event.verb == "send":
                self._due.append((max(event.at - JOIN_S, 0), lambda event=event: self._join(event)))
        for node in scenario.nodes.values():
            if node.start is not None and node.start > 0:
                self._due.append((node.start, lambda node=node: self._late_start(node.name)))

    def run_due(self, now):
        """Does what is due."""
        ready = sorted((entry for entry in self._due if entry[0] <= now), key=lambda entry: entry[0])
        self._due = [entry for entry in self._due if entry[0] > now]
        for _, act in ready:
            act()

    def _late_start(self, name):
        self._say(f"start {name}")
        self._nodes.start(name)

    def _begin(self, event):
        until = event.at + event.length if event.length is not None else flights.FOREVER
        instant = event.verb in ("kill", "stop", "start", "clock", "send")
        concerns = event.values.get("nodes", [])
        if event.verb == "deaf":
            concerns = concerns + event.values["of"]
        elif event.verb in ("loss", "delay"):
            concerns = sorted(set(event.values["from"]) | set(event.values["to"]))
        self._flight.faults.append(flights.Fault(event.at, event.at if instant else until, event.verb, concerns,
                                                 event.text()))
        self._say(event.text())
        getattr(self, "_" + event.verb)(event, True)
        if not instant:
            self._active.append(event)
        if event.length is not None:
            self._due.append((until, lambda: self._finish(event)))

    # The end of one fault must not end another one that goes on.
    def _finish(self, event):
        self._say(f"end of: {event.text()}")
        self._active.remove(event)
        getattr(self, "_" + event.verb)(event, False)
        for other in self._active:
            if SORTS.get(other.verb, other.verb) == SORTS.get(event.verb, event.verb):
                getattr(self, "_" + other.verb)(other, True)

    def _networks(self, event):
        wanted = event.values.get("network")
        return [network for network in self._scenario.networks.values() if wanted in (None, network.name)]

    def _tell(self, network, line):
        self._nets.radios[network.name].tell(line)

    def _kill(self, event, _):
        for node in event.values["nodes"]:
            self._nodes.kill(node)

    def _stop(self, event, _):
        self._nodes.stop(event.values["nodes"])

    def _start(self, event, _):
        for node in event.values["nodes"]:
            self._nodes.start(node)

    def _freeze(self, event, begins):
        for node in event.values["nodes"]:
            self._nodes.signal(node, signal.SIGSTOP if begins else signal.SIGCONT)

    def _clock(self, event, _):
        for node in event.values["nodes"]:
            self._nodes.step_clock(node, event.values["step"])

    def _disk(self, event, begins):
        for node in event.values["nodes"]:
            self._nodes.fill(node, begins)

    def _cut(self, event, begins):
        """The nodes hear each other, and nobody else hears them or is heard by them."""
        for network in self._networks(event):
            members = self._nets.members(network)
            inside = [node for node in event.values["nodes"] if node in members]
            for node in inside:
                for other in members:
                    if other not in inside:
                        self._hear(network, node, other, not begins)
                        self._hear(network, other, node, not begins)

    def _deaf(self, event, begins):
        for network in self._networks(event):
            members = self._nets.members(network)
            for node in event.values["nodes"]:
                for other in event.values["of"]:
                    if node != other and node in members and other in members:
                        self._hear(network, node, other, not begins)

    def _hear(self, network, node, other, hears):
        self._tell(network, f"{'hear' if hears else 'deaf'} {node} {other}")

    def _pairs(self, event, network):
        members = self._nets.members(network)
        return [(a, b) for a in event.values["from"] for b in event.values["to"]
                if a != b and a in members and b in members]

    def _loss(self, event, begins):
        for network in self._networks(event):
            for a, b in self._pairs(event, network):
                loss, burst = (event.values["loss"], event.values["burst"]) if begins else self._usual_loss(network, a, b)
                self._tell(network, f"loss {loss:g} burst {burst:g} {a} {b}")

    def _usual_loss(self, network, a, b):
        """(percent, burst) of a link without events, by distance, too."""
        usual = network.loss_of(a, b)
        place = self._places.get(network.name)
        return (place.loss(a, b, usual[0]), usual[1]) if place else usual

    def rules_loss(self, network, a, b):
        """True if an event decides the loss of that link now, in place of the distance."""
        return any(event.verb == "loss" and event.values["network"] in (None, network.name)
                   and a in event.values["from"] and b in event.values["to"] for event in self._active)

    def _delay(self, event, begins):
        for network in self._networks(event):
            if begins:
                for a, b in self._pairs(event, network):
                    self._tell(network, f"delay {1000 * event.values['delay']:g} jitter "
                                        f"{1000 * event.values['jitter']:g} {a} {b}")
            else:
                self._nets.restore_delay(network)

    def _rate(self, event, begins):
        for network in self._networks(event):
            rate = event.values["rate"] if begins else network.rate
            self._tell(network, f"rate {rate:.0f}" if rate else "rate unlimited")

    def _outage(self, event, begins):
        self._nets.radios[event.values["network"]].tell(f"outage {'on' if begins else 'off'}")

    # A sender waits for its message on its standard input, so that joining the network takes none of the time that is
    # measured.
    def _join(self, event):
        values, now = event.values, self._nodes.now()
        about = self._flight.about.get(values["from"])
        if about is None and now < event.at - LOOK_S:  # the node has not told its domain yet
            self._due.append((now + LOOK_S, lambda: self._join(event)))
            return
        domain = about["domain"] if about else "0"
        argv = ["send", values["to"], values["type"], "-", "--json", "--wait", "20", "--domain", str(domain),
                *values["options"]]
        sent = self._flight.sent[id(event)] = flights.Sent("", 0.0, "")
        began = []

        def line(text):
            try:
                answer = json.loads(text)
                sent.outcome, sent.seconds = answer["outcome"], self._nodes.now() - began[0]
                sent.reason = answer["reason"] or sent.reason
            except (ValueError, KeyError, TypeError, IndexError):
                sent.reason = text
        self._senders[id(event)] = (self._nodes.start_tool(values["from"], argv, line, keys.sender(self._scenario, event)), began)

    def _send(self, event, _):
        process, began = self._senders[id(event)]
        began.append(self._nodes.now())
        try:
            process.tell(json.dumps(event.values["value"]))
            process.close_input()
        except OSError:
            pass  # it has ended, and said why

    def waits(self):
        """True while a `send` has no outcome yet, and may still get the one that is expected."""
        now = self._nodes.now()
        return any(event.verb == "send" and id(event) in self._senders and self._senders[id(event)][0].running()
                   and now < event.at + (event.values["expect"] or ("", OUTCOME_S))[1] + 0.5
                   for event in self._scenario.events)
