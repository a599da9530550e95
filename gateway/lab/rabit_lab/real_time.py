"""A recorded flight over an emulated radio, in real time: `rabit lab replay --real-time`. Each node is a process of lab_replay
with a real gateway, in a scenario that this module writes."""

import pathlib

import yaml

from rabit_lab import runner, scenario as scenarios, table, what_if


def seconds(value):
    return f"{value:.6f}s"


def scenario_of(program, files, told, radio):
    """The scenario, as it stands in a file. `told`: what lab_replay says of the recording."""
    files = [str(pathlib.Path(file).resolve()) for file in files]
    budget = [] if radio.budget is None else ["--budget", str(radio.budget)]
    nodes, events = {}, []
    for life in told.recorded.lives:
        if life.number == 1:
            command = [program, *files, "--node", life.node, "--life", "{incarnation}", *budget]
            nodes[life.node] = {"command": command, "start": seconds(life.began)}
        else:
            events.append({"at": seconds(life.began), "start": life.node})
        if life.ended is not None:
            events.append({"at": seconds(life.ended), "kill": life.node})
    channel = {"loss": f"{radio.loss:.6f}%", "burst": radio.burst, "delay": seconds(radio.delay), "jitter": seconds(radio.jitter),
               "queue": radio.queue, "overhead": radio.overhead, "seed": radio.seed}
    if radio.radio:
        channel["rate"] = f"{radio.radio:.0f}bit/s"
    return {"nodes": nodes, "network": {"radio": channel}, "run": seconds(told.recorded.end), "events": events}


def read(program, files, radio, folder):
    """(scenario, what lab_replay says of the recording)"""
    told = what_if.read(files[0], what_if.tell(program, files, ["--about"]), radio)
    path = folder / f"{pathlib.Path(files[0]).stem}_replay.yaml"
    path.write_text(yaml.safe_dump(scenario_of(program, files, told, radio), sort_keys=False), encoding="utf-8")
    return scenarios.read(path), told


def medium(flight):
    """The counters of the radio, as lab_replay tells them."""
    return [{"t": time * 1e9, "bytes": counts["sent"]["bytes"], "carried": counts["sent"]["frames"],
             "dropped": sum(node["dropped"]["frames"] for node in counts["nodes"].values()),
             "longest_wait": max(node["longest_wait_ms"] for node in counts["nodes"].values()) * 1e6}
            for time, counts in flight.radio["radio"]]


def queues(flight):
    """The queue messages, as lab_replay tells them. How long one took is in no recording."""
    return [{"from": node, "to": other, "queue": queue, "sent": sum(outcomes.values()) - outcomes["refused"],
             "refused": outcomes["refused"], "outcomes": {name: count for name, count in outcomes.items() if name != "refused"},
             "ages": []} for (node, other, queue), outcomes in sorted(flight.outcomes.items())]


def fly(scenario, told, radio, folder, found):
    """In the cage. True if all nodes stayed, None if it was interrupted."""
    run = runner.Runner(scenario, folder, found)
    verdicts = run.run()
    if verdicts is None:
        return None
    run.flight.notes += told.simulated.notes
    print()
    what_if.show(what_if.Flown(run.flight, told.recorded, queues(run.flight), medium(run.flight)), radio, folder)
    wrong = [verdict for verdict in verdicts if not verdict.good]
    for verdict in wrong:
        print(table.safe(f"NOT MET  {verdict.text}: {verdict.detail}"))
    return not wrong
