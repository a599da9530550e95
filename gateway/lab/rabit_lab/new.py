"""Writes a scenario for the configurations in a folder."""

import pathlib

import yaml

from rabit_lab.marked import ScenarioError

SCENARIO = """# Flies the nodes of this folder: rabit lab run {file}
nodes:
{nodes}
#network:                   # default: one LAN without faults
#  radio: {{members: "*", rate: 250kbit/s, loss: 10%, burst: 4, delay: 20ms, queue: 16kB}}
run: 60s
events:
  - {{at: 20s, kill: {victim}}}
  - {{at: 25s, start: {victim}}}
#  - {{at: 40s, cut: [{victim}], for: 10s}}
expect:
  - all up within 5s
  - {victim} up within 5s after 25s
{streams}  - no false lost
  - exit codes: 0
"""


def configurations(folder):
    """[(file, name of the node, if it has keys, what it publishes, [(message, from)] that it subscribes to)]"""
    found = []
    for path in sorted(folder.glob("*.yaml")):
        try:
            content = yaml.safe_load(path.read_text(encoding="utf-8"))
        except (OSError, yaml.YAMLError, UnicodeDecodeError):
            continue
        if not isinstance(content, dict) or not isinstance(content.get("node"), str):
            continue
        rules = {key: [rule for rule in content.get(key) or [] if isinstance(rule, dict) and "message" in rule]
                 for key in ("publish", "subscribe")}
        found.append((path, content["node"], "security" in content, [rule["message"] for rule in rules["publish"]],
                      [(rule["message"], rule.get("from") or ["*"]) for rule in rules["subscribe"]]))
    return found


def program_for(folder, path):
    """The program that a configuration is probably for: an executable of its name here or in build/."""
    for place in (folder, folder / "build", folder / "build" / "bin"):
        program = place / path.stem
        if program.is_file() and program.stat().st_mode & 0o111:
            return f"./{program.relative_to(folder)}"
    return f"./build/{path.stem}"


def write(folder, to):
    """Returns what to tell a person."""
    folder = pathlib.Path(folder)
    if not folder.is_dir():
        raise ScenarioError(folder, "is no folder")
    found = configurations(folder)
    if not found:
        raise ScenarioError(folder, "has no configuration of a node: a *.yaml with `node:`")
    target = pathlib.Path(to) if to else folder / "scenario.yaml"
    if target.exists():
        raise ScenarioError(target, "is there already; name another file with --to")
    nodes = "\n".join(f"  {node}: {{command: [{program_for(folder, path)}, --config, {path.name}]"
                      f"{f', keys: {path.name}' if keyed else ''}}}" for path, node, keyed, *_ in found)
    names = [node for _, node, *_ in found]
    streams = ""
    for *_, origin, _, published, _ in found:
        for message in published:
            for _, node, _, _, subscribed in found:
                if node != origin and any(message == wanted for wanted, _ in subscribed):
                    streams += f"  - {origin}/{message} at {node}: age p90 < 2s, before 20s\n"
    target.write_text(SCENARIO.format(file=target.name, nodes=nodes, victim=names[-1], streams=streams), encoding="utf-8")
    return f"{target}: {', '.join(names)}; check the commands, then: rabit lab run {target}"
