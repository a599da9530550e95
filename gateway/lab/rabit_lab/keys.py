"""Keys of a fleet for one run: made anew by `rabit keys`, in the folder of the results."""

import pathlib
import subprocess

from rabit_lab import network
from rabit_lab.marked import ScenarioError


def make(scenario, folder, rabit):
    """{name: folder of keys} of the nodes that have any, and of the tools that join in their places. Raises ScenarioError."""
    keyed = [node for node in scenario.nodes.values() if node.keys]
    fleet, made = pathlib.Path(folder, "keys"), {}

    def call(line, *words):
        done = subprocess.run([rabit, "keys", *(str(word) for word in words)], text=True, check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        if done.returncode != 0:
            said = done.stderr.strip().splitlines() or [f"`rabit keys {words[0]}` ended with {done.returncode}"]
            raise ScenarioError(f"{scenario.path}:{line}", f"keys: {said[0].removeprefix('rabit: ')}")

    def add(name, line, *what):
        if name not in made:
            call(line, "add", name, "--keys", fleet, *what)
            made[name] = fleet / name

    if keyed:
        call(keyed[0].line, "init", fleet)
    for node in keyed:
        add(node.name, node.line, "--config", node.keys)
    if keyed and scenario.observe:
        add(network.OBSERVER, keyed[0].line, "--tool")
    for event in scenario.events:
        if event.verb == "send" and scenario.nodes[event.values["from"]].keys:
            add(sender(scenario, event), event.line, "--tool")
    return made


def sender(scenario, event):
    """The name of the tool of a `send`: that among its options, or one of its own."""
    options = event.values["options"]
    return options[options.index("--node") + 1] if "--node" in options[:-1] else f"lab.send{scenario.events.index(event) + 1}"
