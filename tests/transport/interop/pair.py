"""Two nodes at the ends of a cable, which send each other orders without end while something happens to them."""

import re
import signal

from namespace import harness

# Only keeps a broken test from hanging.
LIMIT_S = 300
NAMES = ("first", "second")
RATE = 25
ORDERS = 1000000  # more than come, so that orders are always under way
WRONG = re.compile("not in order|skipped round|in doubt|garbled|^lost")


def connect(first, second):
    """A cable between two namespaces: eth0 in both."""
    first.run("ip", "link", "add", "eth0", "type", "veth", "peer", "name", "eth0", "netns", str(second.process.pid))
    for number, end in enumerate((first, second), start=1):
        end.run("ip", "link", "set", "lo", "up")
        end.run("ip", "address", "add", f"10.77.0.{number}/24", "dev", "eth0")
        end.run("ip", "link", "set", "eth0", "up")
        end.run("ip", "route", "add", "224.0.0.0/4", "dev", "eth0")


def start(processes, node, ends, transports):
    """Both nodes, once they have met and orders are on their way."""
    nodes = [processes.start([*ends[i].inside(), node, "--node", NAMES[i], "--other", NAMES[1 - i], "--transport", transports[i],
                              "--interface", "eth0", "--count", ORDERS, "--rate", RATE, "--no-frame"]) for i in (0, 1)]
    for node in nodes:
        for line in (r"mirror life=\d+", "peer UP", "hundred orders round=1"):
            node.wait_for(re.compile(line).fullmatch, LIMIT_S)
    return nodes


def is_up(node):
    return [text for _, text in node.lines if text.startswith("peer")][-1] == "peer UP"


def await_both(nodes, since):
    """Waits until each has the other's counters and orders after that time, more than a buffer holds, and shows it UP. Returns
    when that was."""
    latest = since
    for node in nodes:
        when = since
        for line in 3 * ["ten counters"] + ["hundred orders round=1"]:
            when, _ = node.wait_for(re.compile(line).fullmatch, LIMIT_S, when + 0.001)
        harness.until(lambda node=node: is_up(node), LIMIT_S)
        latest = max(latest, when)
    return latest


def end(nodes):
    """Ends the sending and the nodes. Each order must have been delivered, once and in order."""
    for node in nodes:
        node.signal(signal.SIGUSR1)
    for node in nodes:
        _, stopped = node.wait_for(re.compile(r"stopped round=1 sent=(\d+) delivered=(\d+) in_doubt=0").fullmatch, LIMIT_S)
        wrong = [text for _, text in node.lines if WRONG.search(text)]
        if wrong or stopped[1] != stopped[2]:
            raise AssertionError(f"{node.argv} said: {[stopped[0], *wrong[:3]]}")
    for node in nodes:
        code = node.terminate()
        if code != 0:
            raise AssertionError(f"{node.argv} ended with {code}")
