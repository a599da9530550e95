"""The networks of a scenario: a namespace for each node, and a `radio` for each channel between them."""

import os
import subprocess

from rabit_lab import radio
from rabit_lab.cage import ADVICE
from rabit_lab.radio import Unsupported

OBSERVER = "observer"


def run(*argv):
    """A command that works, or Unsupported with what it said."""
    done = subprocess.run(argv, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    if done.returncode != 0:
        raise Unsupported(f"{' '.join(argv)}: {done.stdout.strip()}; {ADVICE}")
    return done.stdout


class Spaces:
    """Namespaces that the lab makes. They end with the cage."""

    def make(self, node):
        run("ip", "netns", "add", node)
        run("ip", "-n", node, "link", "set", "lo", "up")

    def path(self, node):
        return node

    def inside(self, node, argv):
        """The command that runs another one there."""
        return ["ip", "netns", "exec", node, *argv]

    def start(self, node, argv, environment):
        """The command of a node, and its environment. The node has a namespace of processes for itself, so that all its
        children end with it. Process 1 is a shell: a node in its place would ignore the signals that it does not handle."""
        own = ["unshare", "--pid", "--fork", "--kill-child", "--mount-proc", "sh", "-c", '"$@"; exit $?', "sh"]
        return self.inside(node, own + argv), environment

    def signal(self, node, process, number):  # pylint: disable=unused-argument
        """To the node and its children, but for those with a session of their own. SIGKILL reaches these, too, because it
        ends process 1. `unshare` blocks SIGTERM, so that its exit code is the node's."""
        try:
            os.killpg(process.pid, number)
        except ProcessLookupError:
            pass

    def ended(self, node):
        """After a node has ended: the kernel has ended its children."""

    def ip(self, node, *argv):
        run("ip", "-n", node, *argv)

    def end(self):
        """Nothing is left to do: the cage ends them."""


class Networks:
    """Made at once; `radios` are the channels by name."""

    def __init__(self, scenario, program, folder, spaces):
        self._scenario = scenario
        self.spaces = spaces
        self.radios = {}
        self.hosts = scenario.fleet() + ([OBSERVER] if scenario.observe else [])
        for host in self.hosts:
            spaces.make(host)
        for network in scenario.networks.values():
            self._connect(network, program, folder)

    def members(self, network):
        return network.members + ([OBSERVER] if self._scenario.observe == network.name else [])

    def networks_of(self, host):
        return [network for network in self._scenario.networks.values() if host in self.members(network)]

    def address(self, host, network):
        number = list(self._scenario.networks).index(network.name)
        return f"10.{77 + number}.0.{self.hosts.index(host) + 1}"

    def addresses(self, host):
        return [self.address(host, network) for network in self.networks_of(host)]

    def _connect(self, network, program, folder):
        members = self.members(network)
        pcap = os.path.join(folder, f"{network.name}.pcap") if network.capture else None
        channel = radio.Radio(program, {host: self.spaces.path(host) for host in members}, network.rate, network.queue,
                              network.overhead, network.seed, pcap, network.name)
        self.radios[network.name] = channel
        for host in members:
            self.spaces.ip(host, "address", "add", self.address(host, network) + "/16", "dev", network.name)
            if self.networks_of(host)[0] is network:
                self.spaces.ip(host, "route", "add", "224.0.0.0/4", "dev", network.name)
        set_links(channel, network)

    def restore_delay(self, network):
        set_delay(self.radios[network.name], network)


def set_loss(channel, network):
    channel.tell(f"loss {network.loss:g} burst {network.burst:g}")
    for link in network.links:
        each(link, lambda a, b, link=link: channel.tell(f"loss {link.loss:g} burst {link.burst:g} {a} {b}"))


def set_delay(channel, network):
    channel.tell(f"delay {1000 * network.delay:g} jitter {1000 * network.jitter:g}")
    for link in network.links:
        each(link, lambda a, b, link=link:
             channel.tell(f"delay {1000 * link.delay:g} jitter {1000 * link.jitter:g} {a} {b}"))


def set_links(channel, network):
    set_delay(channel, network)
    set_loss(channel, network)
    for pair in network.hidden:
        for one in pair:
            for other in pair:
                if one < other:
                    channel.tell(f"hidden {one} {other} on")


def each(link, tell):
    for origin in link.origins:
        for destination in link.destinations:
            if origin != destination:
                tell(origin, destination)
