"""Keys for the nodes of a test, by the program `rabit`."""

import pathlib

import field

CONFIG = """node: {node}
publish:
  - {{message: Tick, type: Ledger::Tick, qos: telemetry}}
  - {{message: State0, type: Ledger::Tick}}
subscribe:
  - {{message: Tick, type: Ledger::Tick}}
  - {{message: State0, type: Ledger::Tick}}
accept:
  - {{queue: Notes, types: [Ledger::Note]}}
"""


def make(rabit, folder, nodes):
    """The keys of a new fleet of these ledger nodes, in FOLDER/keys. Returns the folder of each node's keys."""
    field.run(rabit, "keys", "init", of(folder))
    for node in nodes:
        pathlib.Path(folder, f"{node}.yaml").write_text(CONFIG.format(node=node), encoding="utf-8")
        add(rabit, folder, node)
    return {node: of(folder, node) for node in nodes}


def add(rabit, folder, node):
    """The keys of one more node of the fleet, by its configuration FOLDER/NODE.yaml."""
    field.run(rabit, "keys", "add", node, "--keys", of(folder), "--config", pathlib.Path(folder, f"{node}.yaml"))


def of(folder, *node):
    """The folder of a node's keys; without a node, that of the fleet."""
    return pathlib.Path(folder, "keys", *node)


def arguments(keys, node):
    """Of a ledger node; `keys` has the folders of the nodes that have keys."""
    return ["--keys", str(keys[node])] if node in keys else []
