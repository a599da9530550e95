"""Keys for nodes of ../interop, by the program `rabit`."""

import subprocess

CONFIG = """node: {name}
domain: {domain}
transport: {transport}
publish:
  - {{message: Counter, type: Interop::Counter, qos: telemetry}}
  - {{message: Frame, type: Interop::Frame}}
subscribe:
  - {{message: Counter, type: Interop::Counter}}
  - {{message: Frame, type: Interop::Frame}}
accept:
  - {{queue: Orders, types: [Interop::Order]}}
"""


def run(argv):
    done = subprocess.run([str(a) for a in argv], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"{argv}: {done.stdout}{done.stderr}")


def make_keys(rabit, folder, nodes, domain):
    """A new fleet; `nodes` are pairs of name and transport."""
    run([rabit, "keys", "init", folder / "keys"])
    for name, transport in nodes:
        config = folder / f"{name}.yaml"
        config.write_text(CONFIG.format(name=name, transport=transport, domain=domain))
        run([rabit, "keys", "add", name, "--keys", folder / "keys", "--config", config])
