"""A scenario: what its file says, checked before anything starts."""

import dataclasses
import fnmatch
import pathlib
import re
import shlex
import shutil
import typing

from rabit_lab import autopilots, expectations, marked, units
from rabit_lab.marked import ScenarioError, nearest

NODE_NAME = re.compile(r"^[A-Za-z0-9_][A-Za-z0-9_.-]*$")
NETWORK_NAME = re.compile(r"^[a-z][a-z0-9_-]{0,13}$")
MOST_NODES = 250


@dataclasses.dataclass
class Node:
    """One node of the fleet."""
    name: str
    command: list
    image: str
    env: dict
    start: float  # seconds; none: an event starts it, or the first start of the node that it is beside
    plain: bool  # no Rabit node: others do not see it, and it records nothing
    line: int
    beside: str = ""  # the node in whose network it runs, as its autopilot does
    keys: str = ""  # the file of its configuration, to which its keys are made; empty: it has none


@dataclasses.dataclass
class Range:
    """Loss by distance."""
    source: str  # a message with positions, or a CSV file
    metres: float  # at which half of the frames are lost
    falloff: str
    fields: list  # names of the three members; empty: found by their usual names
    places: dict  # node -> position of those that tell none
    line: int


@dataclasses.dataclass
class Link:
    """One direction that differs from the rest of its network."""
    origins: list
    destinations: list
    loss: float
    burst: float
    delay: float
    jitter: float


@dataclasses.dataclass
class Network:
    """One channel."""
    name: str
    members: list
    rate: float = 0  # bit/s; 0: unlimited
    loss: float = 0  # percent
    burst: float = 1  # frames lost in a row, on average
    delay: float = 0
    jitter: float = 0
    queue: int = 16000  # bytes
    overhead: int = 0
    seed: int = 1
    capture: bool = False
    links: list = dataclasses.field(default_factory=list)
    hidden: list = dataclasses.field(default_factory=list)
    range: typing.Optional[Range] = None

    def loss_of(self, origin, destination):
        """(percent, burst) of a link, without loss by distance."""
        found = (self.loss, self.burst)
        for link in self.links:
            if origin in link.origins and destination in link.destinations:
                found = (link.loss, link.burst)
        return found


@dataclasses.dataclass
class Event:
    """Something that happens to the fleet."""
    at: float
    verb: str
    length: float  # none: for good
    line: int
    values: dict  # by the verb

    def text(self):
        """As people read it."""
        what = {"disk": "disk full", "clock": "clock"}.get(self.verb, self.verb)
        nodes = ", ".join(self.values.get("nodes", []))
        origins, targets = self.values.get("from"), self.values.get("to")
        direction = f" from {', '.join(origins)} to {', '.join(targets)}" if self.verb in ("loss", "delay") and origins != targets else ""
        more = {"clock": lambda v: f" {v['step']:+g} s", "send": lambda v: f" {v['type']} to {v['to']}",
                "loss": lambda v: f" {v['loss']:g} %", "rate": lambda v: f" {v['rate'] / 1000:g} kbit/s",
                "delay": lambda v: f" {1000 * v['delay']:g} ms",
                "outage": lambda v: "", "deaf": lambda v: f" to {', '.join(v['of'])}"}.get(self.verb, lambda v: "")
        network = f" on {self.values['network']}" if self.values.get("network") else ""
        length = f" for {self.length:g} s" if self.length is not None else ""
        return f"{what} {nodes}{more(self.values)}{direction}{network}{length}".replace("  ", " ").strip()


@dataclasses.dataclass
class Scenario:
    """All of it."""
    path: pathlib.Path
    folder: pathlib.Path
    nodes: dict  # name -> Node
    networks: dict  # name -> Network
    run: float
    events: list
    expects: list
    observe: str  # network of the observer, or none

    def fleet(self):
        """The names of the nodes, without the programs beside them."""
        return [name for name, node in self.nodes.items() if not node.beside]

    def members(self, node):
        """The networks of that node."""
        return [network for network in self.networks.values() if node in network.members]

    def place_of(self, name):
        """The node whose network it is in: itself, but for programs beside a node."""
        return self.nodes[name].beside or name

    def share_network(self, one, other):
        """True if they can hear each other on some network, as the scenario has it."""
        if self.nodes[one].plain or self.nodes[other].plain or bool(self.nodes[one].keys) != bool(self.nodes[other].keys):
            return False
        return any(one in network.members and other in network.members
                   and not any(one in pair and other in pair for pair in network.hidden)
                   for network in self.networks.values())


class Reader:
    """Reads one file. Every mistake is a ScenarioError with its line."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        self.folder = self.path.resolve().parent
        self.nodes = {}
        self.networks = {}
        self._autopilots = {}  # name -> Node
        self._counts = {}  # kind of autopilot -> how many there are

    def fail(self, line, text):
        raise ScenarioError(f"{self.path}:{line}", text)

    def keys(self, section, known, what):
        for key in section:
            if key not in known:
                hint = nearest(key, known) or f"; it may have {', '.join(known)}"
                self.fail(section.line_of(key), f"{what} has no `{key}`{hint}")

    def map(self, value, line, what):
        if not isinstance(value, marked.Map):
            self.fail(line, f"{what}: expected a mapping, as {{key: value}}")
        return value

    def list(self, value, line, what):
        if not isinstance(value, marked.List):
            self.fail(line, f"{what}: expected a list, as [one, other]")
        return value

    def get(self, section, key, unit, default):
        if key not in section:
            return default
        try:
            return unit(section[key])
        except ValueError as error:
            return self.fail(section.line_of(key), f"{key}: {error}")

    def text(self, section, key, default=None):
        value = section.get(key, default)
        if value is not None and not isinstance(value, str):
            self.fail(section.line_of(key), f"{key}: expected a text")
        return value

    def flag(self, section, key):
        value = section.get(key, False)
        words = {"on": True, "yes": True, "off": False, "no": False}
        if not isinstance(value, bool) and value not in words:
            self.fail(section.line_of(key), f"{key}: expected true or false")
        return words.get(value, value) if isinstance(value, str) else value

    def names(self, value, line, known=None):
        """The nodes that a name, a pattern or a list of these means."""
        known = list(self.nodes) if known is None else known
        found = []
        for pattern in value if isinstance(value, list) else [value]:
            fits = [name for name in known if fnmatch.fnmatchcase(name, str(pattern))]
            if not fits:
                self.fail(line, f"there is no node `{pattern}`{nearest(pattern, known)}")
            found += [name for name in fits if name not in found]
        return found

    def processes(self, value, line):
        """The same; what fits no node may be a program beside one, as uav1.autopilot."""
        found = []
        for pattern in value if isinstance(value, list) else [value]:
            beside = fnmatch.filter(self._autopilots, str(pattern))
            found += beside if beside and not fnmatch.filter(self.nodes, str(pattern)) else self.names(pattern, line)
        return list(dict.fromkeys(found))

    def network_of(self, section):
        name = section.get("network")
        if name is not None and name not in self.networks:
            self.fail(section.line_of("network"), f"there is no network `{name}`{nearest(name, self.networks)}")
        return name

    def read(self):
        top = marked.load(self.path)
        self.map(top, 1, "a scenario")
        self.keys(top, ("nodes", "network", "run", "events", "expect", "observe"), "a scenario")
        if "nodes" not in top:
            self.fail(1, "there are no `nodes`; `rabit lab new` writes a scenario")
        self._read_nodes(self.map(top["nodes"], top.line_of("nodes"), "nodes"))
        self._read_networks(top)
        run = self.get(top, "run", units.length, 30.0)
        if run <= 0:
            self.fail(top.line_of("run"), "run: a scenario takes longer than 0 s")
        events = self._read_events(top, run)
        observe = self.text(top, "observe")
        if observe is not None and observe not in self.networks:
            self.fail(top.line_of("observe"), f"there is no network `{observe}`{nearest(observe, self.networks)}")
        if observe and "observer" in self.nodes:
            self.fail(top.line_of("observe"), "observe: with it no node can be called `observer`")
        expects = self._read_expectations(top, run, events)
        return Scenario(self.path, self.folder, {**self.nodes, **self._autopilots}, self.networks, run, events, expects, observe)

    def _read_nodes(self, section):
        for key, value in section.items():
            line = section.line_of(key)
            value = self.map(value, line, f"node {key}")
            self.keys(value, ("count", "command", "image", "env", "start", "plain", "keys", "autopilot"), f"node {key}")
            count = self.get(value, "count", units.number, None)
            if ("*" in key) != (count is not None):
                self.fail(line, f"node {key}: `*` in the name and `count` go together: uav*: {{count: 4, ...}}")
            if count is not None and (count != int(count) or not 1 <= count <= MOST_NODES):
                self.fail(value.line_of("count"), f"count: a number from 1 to {MOST_NODES}")
            names = [key.replace("*", str(n + 1)) for n in range(int(count))] if count else [key]
            for name in names:
                if not NODE_NAME.match(name) or len(name) > 64:
                    self.fail(line, f"`{name}` is no name of a node")
                if name in self.nodes or name in self._autopilots:
                    self.fail(line, f"two nodes are called `{name}`")
                self.nodes[name] = self._read_node(name, value, line)
                self._read_autopilot(self.nodes[name], value)
        if not 1 <= len(self.nodes) <= MOST_NODES:
            self.fail(section.line, f"a fleet has 1 to {MOST_NODES} nodes")

    def _read_node(self, name, value, line):
        image = self.text(value, "image")
        command = value.get("command", marked.List() if image else None)
        at = value.line_of("command")
        if command is None:
            self.fail(line, f"node {name} has no `command`")
        words = shlex.split(command) if isinstance(command, str) else self.list(command, at, "command")
        words = [str(word).replace("{node}", name) for word in words]
        if not words and not image:
            self.fail(at, "command: it is empty")
        if not image:
            program = words[0]
            found = shutil.which(program) if "/" not in program else shutil.which(str(self.folder / program))
            if not found:
                self.fail(at, f"node {name}: no program `{program}` in {self.folder if '/' in program else 'PATH'}; "
                              "build it, or mend `command`")
            words[0] = found
        env = self.map(value.get("env", marked.Map()), value.line_of("env"), "env")
        start = None if value.get("start") == "never" else self.get(value, "start", units.length, 0.0)
        plain = self.flag(value, "plain")
        return Node(name, words, image, {key: str(env[key]).replace("{node}", name) for key in env}, start, plain, line,
                    keys=self._read_keys(name, value, image, plain))

    def _read_keys(self, name, value, image, plain):
        file = self.text(value, "keys")
        if file is None:
            return ""
        at = value.line_of("keys")
        if image or plain:
            self.fail(at, f"keys: node {name} " + ("has an image; give it keys in the image" if image else "is no Rabit node"))
        path = self.folder / file.replace("{node}", name)
        if not path.is_file():
            self.fail(at, f"keys: there is no file {path}; it is the configuration of node {name}")
        return str(path)

    def _read_autopilot(self, node, value):
        """Adds its programs, which run beside the node from its first start to the end of the run."""
        if "autopilot" not in value:
            return
        port, programs = autopilots.read(self, node, value, self._counts)
        node.command = [word.replace("{mavlink}", str(port)) for word in node.command]
        for word, argv, env in programs:
            name = f"{node.name}.{word}"
            if name in self.nodes:
                self.fail(value.line_of("autopilot"), f"two nodes would be called `{name}`")
            self._autopilots[name] = Node(name, argv, None, {**env, **node.env}, None, True, node.line, node.name)

    def _read_networks(self, top):
        if "network" not in top:
            self.networks["lan"] = Network("lan", list(self.nodes))
            return
        section = self.map(top["network"], top.line_of("network"), "network")
        for name, value in section.items():
            line = section.line_of(name)
            if name == "range":
                continue
            if not NETWORK_NAME.match(name) or name == "lo":
                self.fail(line, f"`{name}` is no name of a network: at most 14 small letters, digits, `-` and `_`, "
                                "and not `lo`")
            self.networks[name] = self._read_network(name, self.map(value, line, f"network {name}"), line)
        if not self.networks:
            self.fail(section.line, "network: there is none in it")
        if "range" in section:
            first = next(iter(self.networks.values()))
            first.range = self._read_range(self.map(section["range"], section.line_of("range"), "range"))
        for name in self.nodes:
            if not any(name in network.members for network in self.networks.values()):
                self.fail(top.line_of("network"), f"node {name} is in no network; name it in `members`")

    def _read_network(self, name, value, line):
        self.keys(value, [f.name for f in dataclasses.fields(Network) if f.name != "name"], f"network {name}")
        network = Network(name, self.names(value.get("members", "*"), value.line_of("members")))
        network.rate = self.get(value, "rate", units.bits_per_second, 0)
        network.loss = self.get(value, "loss", units.percent, 0)
        network.burst = self.get(value, "burst", units.burst, 1)
        network.delay = self.get(value, "delay", units.length, 0)
        network.jitter = self.get(value, "jitter", units.length, 0)
        network.queue = self.get(value, "queue", units.size, 16000)
        network.overhead = self.get(value, "overhead", units.size, 0)
        network.seed = self.get(value, "seed", units.seed, 1)
        network.capture = self.flag(value, "capture")
        links = self.list(value.get("links", marked.List()), value.line_of("links"), "links")
        for at, link in zip(links.lines, links):
            network.links.append(self._read_link(self.map(link, at, "links"), network))
        hidden = self.list(value.get("hidden", marked.List()), value.line_of("hidden"), "hidden")
        for at, pair in zip(hidden.lines, hidden):
            pair = self.names(self.list(pair, at, "hidden"), at, network.members)
            if len(pair) < 2:
                self.fail(at, "hidden: two nodes that do not hear each other, as [uav1, uav2]")
            network.hidden.append(pair)
        if "range" in value:
            network.range = self._read_range(self.map(value["range"], value.line_of("range"), "range"))
        if len(network.members) < 1:
            self.fail(line, f"network {name} has no members")
        return network

    def _read_link(self, value, network):
        self.keys(value, ("from", "to", "loss", "burst", "delay", "jitter"), "a link")
        for key in ("from", "to"):
            if key not in value:
                self.fail(value.line, f"a link has `{key}`")
        return Link(self.names(value["from"], value.line_of("from"), network.members),
                    self.names(value["to"], value.line_of("to"), network.members),
                    self.get(value, "loss", units.percent, network.loss),
                    self.get(value, "burst", units.burst, network.burst),
                    self.get(value, "delay", units.length, network.delay),
                    self.get(value, "jitter", units.length, network.jitter))

    def _read_range(self, value):
        self.keys(value, ("from", "metres", "falloff", "fields", "places"), "range")
        source = self.text(value, "from")
        if not source or "metres" not in value:
            self.fail(value.line, "range: `from` names a message or a CSV file, and `metres` the distance at which half "
                                  "is lost")
        if source.endswith(".csv") and not (self.folder / source).is_file():
            self.fail(value.line_of("from"), f"there is no file {source} in {self.folder}")
        falloff = self.text(value, "falloff", "free-space")
        if falloff not in ("free-space", "sharp"):
            self.fail(value.line_of("falloff"), f"falloff: free-space or sharp, not `{falloff}`")
        fields = self.list(value.get("fields", marked.List()), value.line_of("fields"), "fields")
        if len(fields) not in (0, 3):
            self.fail(value.line_of("fields"), "fields: three members, as [latitude_deg, longitude_deg, altitude_m]")
        places = self.map(value.get("places", marked.Map()), value.line_of("places"), "places")
        for node, place in places.items():
            self.names(node, places.line_of(node))
            if not isinstance(place, list) or len(place) != 3 or not all(isinstance(x, (int, float)) for x in place):
                self.fail(places.line_of(node), f"places: {node}: three numbers, as [47.4, 8.5, 430]")
        return Range(source, self.get(value, "metres", units.metres, 0), falloff, list(fields), dict(places), value.line)

    VERBS = {"kill": (), "stop": (), "start": (), "cut": ("network",), "freeze": (), "clock": (), "disk": (),
             "send": ("type", "value", "expect", "from", "options"), "deaf": ("of", "network"),
             "loss": ("burst", "from", "to", "network"), "delay": ("jitter", "from", "to", "network"),
             "rate": ("network",), "outage": ()}

    def _read_events(self, top, run):
        events = []
        section = self.list(top.get("events", marked.List()), top.line_of("events"), "events")
        for line, value in zip(section.lines, section):
            event = self._read_event(self.map(value, line, "an event"), line)
            if event.at > run:
                self.fail(line, f"the event is at {event.at:g} s, and the run ends at {run:g} s")
            events.append(event)
        return sorted(events, key=lambda event: event.at)

    def _read_event(self, value, line):
        verbs = [key for key in value if key in self.VERBS]
        if len(verbs) != 1 or "at" not in value:
            unknown = [key for key in value if key not in self.VERBS and key not in ("at", "for")]
            hint = nearest(unknown[0], self.VERBS) if unknown else ""
            self.fail(line, "an event has `at`, and one of " + ", ".join(self.VERBS) + hint)
        verb = verbs[0]
        lasts = () if verb in ("kill", "stop", "start", "clock", "send") else ("for",)
        self.keys(value, ("at", verb, *lasts, *self.VERBS[verb]), f"the event {verb}")
        at = self.get(value, "at", units.length, 0)
        length = self.get(value, "for", units.length, None)
        argument, where = value[verb], value.line_of(verb)
        values = {}
        if verb in ("kill", "stop", "start", "freeze"):
            values["nodes"] = self.processes(argument, where)
        elif verb in ("cut", "deaf"):
            values["nodes"] = self.names(argument, where)
        elif verb in ("clock", "disk"):
            argument = self.map(argument, where, verb)
            self.keys(argument, ("node", "step") if verb == "clock" else ("node", "full"), verb)
            if "node" not in argument:
                self.fail(where, f"{verb}: `node` is missing")
            values["nodes"] = self.names(argument["node"], argument.line_of("node"))
            contained = [name for name in values["nodes"] if self.nodes[name].image]
            if verb == "disk" and contained:
                self.fail(where, f"disk: node {contained[0]} has an image; its container does not see what the lab mounts")
            if verb == "clock":
                if "step" not in argument:
                    self.fail(where, "clock: `step` is missing, as -10min")
                values["step"] = round(self.get(argument, "step", units.seconds, 0))
        elif verb == "send":
            values.update(self._read_send(value, argument, where))
        elif verb == "outage":
            name = argument
            if name not in self.networks:
                self.fail(where, f"there is no network `{name}`{nearest(name, self.networks)}")
            values["network"] = name
        else:
            values[verb] = self.get(value, verb, {"loss": units.percent, "delay": units.length,
                                                  "rate": units.bits_per_second}[verb], 0)
        if verb == "deaf":
            values["of"] = self.names(value.get("of", "*"), value.line_of("of"))
        if verb in ("loss", "delay"):
            values["from"] = self.names(value.get("from", "*"), value.line_of("from"))
            values["to"] = self.names(value.get("to", "*"), value.line_of("to"))
            values["burst"] = self.get(value, "burst", units.burst, 1)
            values["jitter"] = self.get(value, "jitter", units.length, 0)
        if "network" in self.VERBS[verb]:
            values["network"] = self.network_of(value)
        return Event(at, verb, length, line, values)

    def _read_send(self, value, address, where):
        node, slash, queue = str(address).partition("/")
        if not slash or not node or not queue:
            self.fail(where, f"send: `{address}` is no queue; expected NODE/QUEUE, as uav1/MissionControl")
        self.names(node, where)
        kind = self.text(value, "type")
        if not kind:
            self.fail(where, "send: `type` is missing, as Uav::GoHome")
        others = [name for name in self.nodes if name != node]
        default = "ground" if "ground" in others else (others or [node])[0]
        origin = self.text(value, "from", default)
        if origin not in self.nodes:
            self.fail(value.line_of("from"), f"there is no node `{origin}`{nearest(origin, self.nodes)}")
        expect = self.text(value, "expect")
        try:
            limit = expectations.outcome(expect) if expect else None
        except ValueError as error:
            self.fail(value.line_of("expect"), f"expect: {error}")
        options = self.list(value.get("options", marked.List()), value.line_of("options"), "options")
        return {"to": str(address), "nodes": [node], "type": kind, "value": marked.plain(value.get("value", {})),
                "expect": limit, "said": expect, "from": origin, "options": [str(option) for option in options]}

    def _read_expectations(self, top, run, events):
        found = []
        section = self.list(top.get("expect", marked.List()), top.line_of("expect"), "expect")
        for line, value in zip(section.lines, section):
            if isinstance(value, marked.Map) and len(value) == 1:
                key, rest = next(iter(value.items()))
                value = f"{key}: {rest}"
            if not isinstance(value, str):
                self.fail(line, "an expectation is a line of text, as `all up within 3s`")
            try:
                found.append(expectations.parse(value, line, self, run))
            except ValueError as error:
                self.fail(line, str(error))
        found += [expectations.Sent(event) for event in events if event.verb == "send" and event.values["expect"]]
        return found


def read(path):
    """The scenario of a file; ScenarioError if it is wrong."""
    return Reader(path).read()
