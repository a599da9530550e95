#!/usr/bin/env python3
"""A network that comes when it comes: one node runs on a plain network, the other one's changes. For each backend of either,
with and without the interface named: they hear each other then, and what concerns nobody disturbs nobody.

Usage: late_network_test.py NODE TRANSPORT...
Needs to make network namespaces; ends with 77 where it may not."""

import pathlib
import re
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import namespace  # noqa: E402
from namespace import harness, Holder  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
AT_ONCE = 8  # pairs of nodes
QUIET_S = 5  # longer than any lease, and than a node waits before it joins a network anew
ADDRESS = "10.77.0.1/24"
JOINS = "joining the network anew"


class Place:
    """Three namespaces: the one whose network changes, a steady one, and the switch between them. What is called eth0 in
    the first two are cables into the switch."""

    def __init__(self):
        self.first, self.second, self.switch = (Holder() for _ in range(3))
        self.switch.run("ip", "link", "add", "br0", "type", "bridge", "mcast_snooping", "0")
        self.switch.run("ip", "link", "set", "br0", "up")
        self.plug(self.first, "first")
        self.plug(self.second, "second")
        for holder in (self.first, self.second):
            holder.run("ip", "link", "set", "lo", "up")
            holder.run("ip", "link", "set", "eth0", "up")
        self.second.run("ip", "address", "add", "10.77.0.2/24", "dev", "eth0")

    def plug(self, holder, port):
        self.switch.run("ip", "link", "add", port, "type", "veth", "peer", "name", "eth0", "netns", str(holder.process.pid))
        self.switch.run("ip", "link", "set", port, "master", "br0", "up")

    def carrier(self, there):
        self.switch.run("ip", "link", "set", "first", "up" if there else "down")

    def address(self, what="add", address=ADDRESS, device="eth0"):
        self.first.run("ip", "address", what, address, "dev", device)

    def other_network(self, holder=None, address="10.66.0.1/24"):
        """One more interface, with a carrier and nobody there."""
        holder = holder or self.first
        holder.run("ip", "link", "add", "wired0", "type", "veth", "peer", "name", "wired1")
        for name in ("wired0", "wired1"):
            holder.run("ip", "link", "set", name, "up")
        holder.run("ip", "address", "add", address, "dev", "wired0")

    def close(self):
        for holder in (self.first, self.second, self.switch):
            holder.close()


class Event:
    """What is there when the first node starts, and what then happens. `together` says whether the nodes hear each other
    before; `peace` that they must go on as if nothing had happened; else they must have found each other afterwards.
    `missing` is what the node says if the interface is named."""

    interface = "eth0"
    missing = None
    together = False
    peace = False

    def before(self, place):
        place.address()

    def after(self, place):
        raise NotImplementedError


class CarrierComes(Event):
    def before(self, place):
        place.address()
        place.carrier(False)

    def after(self, place):
        place.carrier(True)


class AddressComesToSecondNetwork(Event):
    def before(self, place):
        place.other_network()

    def after(self, place):
        place.address()


class InterfaceComes(Event):
    """An interface that does not exist when the node starts beside another network."""

    missing = "the interface eth0 does not exist"

    def before(self, place):
        place.other_network()
        place.switch.run("ip", "link", "del", "first")

    def after(self, place):
        place.plug(place.first, "first")
        place.first.run("ip", "link", "set", "eth0", "up")
        place.address()


class Renamed(Event):
    """As the interface gets its final name while the node waits for it, or uses it."""

    interface = "radio0"
    missing = "the interface radio0 does not exist"

    def before(self, place):
        place.address()

    def after(self, place):
        place.first.run("ip", "link", "set", "eth0", "down")
        place.first.run("ip", "link", "set", "eth0", "name", "radio0")
        place.first.run("ip", "link", "set", "radio0", "up")


class CarrierReturns(Event):
    together = True

    def after(self, place):
        place.carrier(False)
        time.sleep(QUIET_S)
        place.carrier(True)


class AddressChangesBesideAnother(Event):
    together = True

    def before(self, place):
        place.other_network()
        place.address()

    def after(self, place):
        place.address("del")
        time.sleep(QUIET_S)
        place.address(address="10.77.0.9/24")


class SameAddressReturns(Event):
    together = True

    def after(self, place):
        place.address("del")
        time.sleep(QUIET_S)
        place.address()


class PluggedOutAndIn(Event):
    """Another interface of the same name and address, as a radio on USB."""

    together = True

    def before(self, place):
        place.other_network()
        place.address()

    def after(self, place):
        place.switch.run("ip", "link", "del", "first")
        time.sleep(QUIET_S)
        place.plug(place.first, "first")
        place.first.run("ip", "link", "set", "eth0", "up")
        place.address()


class ThickEvents(Event):
    """The address comes while something else changes every few milliseconds, for ever."""

    def before(self, place):
        place.other_network()

    def after(self, place):
        place.first.keep_running("sh", "-c", "while ip address add 10.99.0.1/32 dev lo && "
                                 "ip address del 10.99.0.1/32 dev lo; do sleep 0.02; done")
        place.address()


class SameAddressInside(AddressComesToSecondNetwork):
    """Both hosts have a network of their own besides, with the same address, as the bridge for containers."""

    def before(self, place):
        for holder in (place.first, place.second):
            place.other_network(holder)


class OtherNetworkVanishes(Event):
    together = True
    peace = True

    def before(self, place):
        place.other_network()
        place.address()

    def after(self, place):
        place.first.run("ip", "link", "del", "wired0")


class OtherNetworkLosesCarrier(OtherNetworkVanishes):
    def after(self, place):
        place.first.run("ip", "link", "set", "wired1", "down")
        time.sleep(QUIET_S)
        place.first.run("ip", "link", "set", "wired1", "up")


class Case:
    def __init__(self, node, transports, event, named):
        self.node, self.transports, self.event, self.named = node, transports, event, named
        self.failure = None
        self.recovered = None
        self.joins = False

    def run(self):
        place = Place()
        try:
            with harness.Processes() as processes:
                self.check(place, processes)
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)
        finally:
            place.close()

    def check(self, place, processes):
        event = self.event()
        event.before(place)
        names = ("first", "second")
        holders = (place.first, place.second)
        interfaces = [["--interface", event.interface] if self.named else [], []]
        nodes = [processes.start([*holders[i].inside(), self.node, "--node", names[i], "--other", names[1 - i],
                                  "--transport", self.transports[i], *interfaces[i], "--count", 0, "--no-frame"])
                 for i in (0, 1)]
        for node in nodes:
            node.wait_for(re.compile(r"ready life=\d+").fullmatch, LIMIT_S)
        if event.together or (event.interface != "eth0" and not self.named):
            for node in nodes:
                node.wait_for(re.compile(r"mirror life=\d+").fullmatch, LIMIT_S)
                node.wait_for(re.compile("peer UP").fullmatch, LIMIT_S)
        elif self.named and event.missing:
            nodes[0].wait_for(re.compile(f"gateway: .*{event.missing}").search, LIMIT_S)
        else:
            time.sleep(1)  # the vendor has looked at the network
        start = time.monotonic()
        event.after(place)
        back = time.monotonic()
        if event.peace:
            self.expect_peace(nodes, start)
        else:
            self.expect_recovery(nodes, start, back)
        for node in nodes:
            if node.terminate() != 0:
                raise AssertionError(f"{node.argv} ended with {node.exit_code(0)}")

    def expect_recovery(self, nodes, start, back):
        self.recovered = 0.0
        for node in nodes:
            gone = [when for when, text in node.lines if text in ("peer LOST", "peer STALE") and when >= start]
            if not gone and any(text == "peer UP" for _, text in node.lines):
                continue  # nobody noticed
            # Not from `back` on: on a slow machine the nodes may meet before the last command has returned.
            since = gone[-1] if gone else start
            # Counters that were away for less than a second are not reported as resumed: they go on.
            for line in (r"peer UP", r"(mirror|resumed) life=\d+.*|ten counters"):
                since, _ = node.wait_for(re.compile(line).fullmatch, LIMIT_S, since)
                self.recovered = max(self.recovered, since - back)
        self.joins = any(JOINS in text for node in nodes for _, text in node.lines)

    @staticmethod
    def expect_peace(nodes, start):
        """No node joins the network anew or is mirrored anew, and what each posts goes on to come. STALE or LOST for a moment
        tells of the machine, which may not run a node for some seconds."""
        time.sleep(QUIET_S)
        since = time.monotonic()
        for node in nodes:
            node.wait_for(re.compile("ten counters").fullmatch, LIMIT_S, since)
            for when, text in node.lines:
                if when >= start and re.search(f"^mirror|{JOINS}", text):
                    raise AssertionError(f"{node.argv} said: {text}")


EVENTS = (CarrierComes, AddressComesToSecondNetwork, InterfaceComes, Renamed, CarrierReturns, AddressChangesBesideAnother,
          SameAddressReturns, PluggedOutAndIn, ThickEvents, SameAddressInside,
          OtherNetworkVanishes, OtherNetworkLosesCarrier)


def cases(node, transports):
    made = []
    for number, event in enumerate(EVENTS):
        for position, transport in enumerate(transports):
            for named in (False, True):
                if event.peace and named:
                    continue  # the other network is none of its business
                # Each backend meets itself and the other one in turn.
                other = transports[(position + number + named) % len(transports)]
                made.append(Case(node, (transport, other), event, named))
    return made


def main():
    node, transports = sys.argv[1], sys.argv[2:]
    if not namespace.supported():
        harness.skip("no network namespace can be made")
    room = threading.Semaphore(AT_ONCE)

    def run(case):
        with room:
            case.run()

    made = cases(node, transports)
    threads = [threading.Thread(target=run, args=(case,)) for case in made]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for case in made:
        outcome = "peace" if case.recovered is None else f"recovered in {case.recovered:.1f} s"
        outcome = outcome if case.failure is None else f"FAILED: {case.failure}"
        print(f"{case.transports[0]:<11} {case.transports[1]:<11} {case.event.__name__:<28} "
              f"{'named' if case.named else 'any':<6} {outcome}")
    if not any(case.joins for case in made):
        sys.exit(f"no node said `{JOINS}`: peace cannot be told by its absence")
    sys.exit(1 if any(case.failure for case in made) else 0)


if __name__ == "__main__":
    main()
