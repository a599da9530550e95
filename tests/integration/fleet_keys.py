"""Keys for ledger nodes, by the program `rabit`."""

import pathlib

import field

CONFIG = """node: {node}
domain: 0
transport: {transport}
publish:
  - {{message: Tick, type: Ledger::Tick, qos: telemetry}}
  - {{message: State0, type: Ledger::Tick}}
subscribe:
  - {{message: Tick, type: Ledger::Tick}}
  - {{message: State0, type: Ledger::Tick}}
accept:
  - {{queue: Notes, types: [Ledger::Note]}}
"""


def make(rabit, folder, transports):
    """A new fleet of {node: transport}. Returns the folder of each node's keys."""
    keys = pathlib.Path(folder, "keys")
    field.run(rabit, "keys", "init", keys)
    for node, transport in transports.items():
        config = pathlib.Path(folder, f"{node}.yaml")
        config.write_text(CONFIG.format(node=node, transport=transport), encoding="utf-8")
        field.run(rabit, "keys", "add", node, "--keys", keys, "--config", config)
    return {node: keys / node for node in transports}
