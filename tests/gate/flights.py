"""The flights of the smoke test: a few nodes, one kind of trouble, and the outcomes that it must not change."""

import collections
import pathlib
import shutil
import time

import outcomes  # also makes the modules of ../integration known
import field
import fleet_keys
import judge
import run_scenario

ROUNDS = 10  # of commands and States; each begins when the one before has all its outcomes
COMMANDS = 10  # of a round, from each node to each other one
LOST_PERCENT = 20
LEAST_DROPPED = 50  # packets to each node that must hear badly: then the fault was there
LOOK_S = 0.05
ORDERED = ["--orders", "--count", "0", "--rate", "1000000", "--ticks", "--states", "1", "--state-posts", "1"]


class Failure(Exception):
    """An outcome that is wrong or did not come."""

    def __init__(self, expected, seen):
        super().__init__(f"expected {expected}; seen: {seen}")


class Flight:
    """`transports`: {node: backend}. `strangers`: those nodes that are none of the fleet. `deadline`: by the monotonic clock;
    it only ends a broken run."""

    def __init__(self, options, ground, transports, strangers=(), keys=None):
        self.ground = ground
        self.strangers = list(strangers)
        self.nodes = [node for node in transports if node not in self.strangers]
        self._deadline = options.deadline
        arguments = {node: [*ORDERED, *self._destinations(node), *fleet_keys.arguments(keys or {}, node)]
                     for node in transports}
        self.fleet = run_scenario.Fleet(ground, options.ledger_node, None,
                                        {"nodes": arguments, "transports": transports})
        self.sights = self.fleet.sights
        self.ordered = collections.Counter()  # commands of the newest life, to each other node
        self.states = collections.Counter()

    def _group(self, node):
        return self.strangers if node in self.strangers else self.nodes

    def _destinations(self, node):
        return [word for other in self._group(node) if other != node for word in ("--to", other)]

    def start(self, node):
        self.ordered[node], self.states[node] = 0, 1
        self.fleet.start(node)

    def gather(self, nodes=None):
        """Starts the nodes, and waits until they have met."""
        for node in nodes or self.nodes:
            self.start(node)
        self.meet(nodes)

    def kill(self, node):
        self.keep_output(node)
        self.ground.kill(node)
        self.sights[node].read()
        self.sights[node].await_life()

    def keep_output(self, node):
        with open(pathlib.Path(self.ground.folder, node + ".log"), "a", encoding="utf-8") as file:
            file.writelines(f"{text}\n" for _, text in self.ground.processes[node].lines)

    def order(self, node, commands, states=0):
        self.ordered[node] += commands
        self.states[node] += states
        for what, count in (("notes", commands), ("states", states)):
            self.ground.processes[node].tell(f"{what} {count}")

    def until(self, expected, look, running=None):
        """Waits until `look()` finds nothing missing. Each node must run, or those in `running`."""
        while True:
            ended = [node for node in running or self.ground.processes if not self.ground.processes[node].running()]
            for sight in self.sights.values():
                sight.read()
            missing = look()
            if not missing:
                return
            if ended:
                lines = [text for _, text in self.ground.processes[ended[0]].lines[-3:]]
                raise Failure(expected, f"{ended[0]} ended by itself: {lines}")
            if time.monotonic() > self._deadline:
                raise Failure(expected, "; ".join(missing) + ", when the time was over")
            time.sleep(LOOK_S)

    def meet(self, nodes=None):
        nodes = nodes or self.nodes
        self.until("each node to show each other one UP, with a pose and the newest State",
                   lambda: outcomes.not_met(self.sights, nodes))

    def exchange(self, nodes=None):
        """A round of commands and one State."""
        nodes = nodes or self.nodes
        for node in nodes:
            self.order(node, COMMANDS, 1)
        self.await_outcomes(nodes)
        wrong = outcomes.undelivered(self.sights, nodes, COMMANDS)
        if wrong:
            raise Failure("each command to be delivered", "; ".join(wrong))

    def await_outcomes(self, nodes):
        self.until(f"outcomes of {dict(self.ordered)} commands, and the newest State of each node",
                   lambda: outcomes.unanswered(self.sights, nodes, self.ordered) or
                   outcomes.unposted(self.sights, nodes, self.states) or outcomes.old_states(self.sights, nodes))

    def await_drops(self, node):
        self.until(f"{LEAST_DROPPED} packets to {node} to be dropped",
                   lambda: [f"{count} were"] if (count := self.ground.dropped(node)) < LEAST_DROPPED else [])

    def await_lost(self, node, other, running=None):
        """Until the node shows the other one LOST, of which nothing arrives."""
        self.until(f"{node} to show {other} LOST",
                   lambda: [self.sights[node].peers[other]] if self.sights[node].peers[other] != "LOST" else [], running)

    def end(self):
        """Ends all nodes, and returns what is wrong with what they did."""
        for group in filter(None, (self.nodes, self.strangers)):
            self.until("the counters of each node to tell the outcome of each accepted command",
                       lambda group=group: outcomes.unsettled(self.sights, group))
        wrong = [str(Failure("each node to end well on SIGTERM", text)) for text in self.fleet.stop()]
        return wrong + [str(Failure("each command once, in order, with its one true outcome", text))
                        for text in judge.judge(self.fleet.ledgers().values())]


def loss(flight):
    """A fifth of all packets is lost, from before the nodes start."""
    flight.ground.lose(LOST_PERCENT)
    flight.gather()
    for _ in range(ROUNDS):
        flight.exchange()
    for node in flight.nodes:
        flight.await_drops(node)


def one_way(flight):
    """The second node hears nothing of the first, until it shows the first LOST. Then the way is healed."""
    first, second = flight.nodes
    flight.gather()
    flight.exchange()
    flight.ground.lose(100, [first], [second])
    for node in flight.nodes:
        flight.order(node, COMMANDS, 1)
    flight.until("all commands to be accepted", lambda: outcomes.not_accepted(flight.sights, flight.nodes, flight.ordered))
    flight.await_lost(second, first)
    flight.ground.heal()
    flight.await_outcomes(flight.nodes)
    flight.meet()
    flight.exchange()


def kill_and_return(flight):
    """Each node is killed amid commands, and returns: the second at once, the first when it is shown LOST."""
    first, second = flight.nodes
    flight.gather()
    flight.exchange()
    for killed, other in ((second, first), (first, second)):
        for node in flight.nodes:
            flight.order(node, COMMANDS)
        flight.until("a command to be accepted",
                     lambda: outcomes.not_accepted(flight.sights, flight.nodes, flight.ordered))
        flight.kill(killed)
        flight.order(other, COMMANDS, 1)
        if killed == first:
            flight.await_lost(other, killed, [other])
        flight.start(killed)
        flight.order(killed, COMMANDS, 1)
        flight.await_outcomes(flight.nodes)
        flight.meet()
        flight.exchange()


def keyed(flight):
    """Two nodes with keys start and fly beside two without that have met, on one network."""
    for group in (flight.strangers, flight.nodes):
        flight.gather(group)
    for _ in range(ROUNDS):
        flight.exchange()
        flight.exchange(flight.strangers)
    wrong = outcomes.strayed(flight.sights, [flight.nodes, flight.strangers])
    if wrong:
        raise Failure("nothing to pass between nodes with keys and nodes without", "; ".join(wrong))


ALL = {"loss": loss, "one_way": one_way, "kill_and_return": kill_and_return, "keys": keyed}
NODES = ("ground", "uav1")
STRANGERS = ("stranger1", "stranger2")


def fly(name, pair, options):
    """Returns what is wrong. The ledgers and the output of all nodes are then in the folder options.logs."""
    keyed_flight = name == "keys"
    hosts = NODES + STRANGERS if keyed_flight else NODES
    transports = dict(zip(hosts, pair * 2))
    strangers = STRANGERS if keyed_flight else ()
    with field.Field(hosts) as ground:
        keys = fleet_keys.make(options.rabit, ground.folder, NODES) if keyed_flight else None
        flight = Flight(options, ground, transports, strangers, keys)
        try:
            ALL[name](flight)
            return flight.end()
        except Failure as failure:
            return [str(failure)]
        finally:
            for node in ground.processes:
                flight.keep_output(node)
            folder = pathlib.Path(options.logs, "+".join(pair), name)
            folder.mkdir(parents=True, exist_ok=True)
            for path in [*pathlib.Path(ground.folder).glob("*.ledger"), *pathlib.Path(ground.folder).glob("*.log")]:
                shutil.copy(path, folder)
