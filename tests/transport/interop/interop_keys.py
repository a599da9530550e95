"""Keys for interop nodes, by the program `rabit`."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integration"))
import field  # noqa: E402
import fleet_keys  # noqa: E402

CONFIG = """node: {node}
publish:
  - {{message: Counter, type: Interop::Counter, qos: telemetry}}
  - {{message: Frame, type: Interop::Frame}}
subscribe:
  - {{message: Counter, type: Interop::Counter}}
  - {{message: Frame, type: Interop::Frame}}
accept:
  - {{queue: Orders, types: [Interop::Order]}}
"""


def configure(folder, node):
    """Writes FOLDER/NODE.yaml, and returns it."""
    file = pathlib.Path(folder, f"{node}.yaml")
    file.write_text(CONFIG.format(node=node), encoding="utf-8")
    return file


def make(rabit, folder, nodes):
    """The keys of a new fleet, in FOLDER/keys. Returns the folder of each node's keys."""
    field.run(rabit, "keys", "init", fleet_keys.of(folder))
    for node in nodes:
        configure(folder, node)
        fleet_keys.add(rabit, folder, node)
    return {node: fleet_keys.of(folder, node) for node in nodes}
