"""All that the nodes said, logged and went through, on one time line."""


def entries(flight):
    """[(time, node, kind, text)] in order. `kind` is output, log, state, problem or lab."""
    found = [(time, node, "output", text) for time, node, text in flight.output]
    levels = {3: "warning: ", 4: "error: "}
    found += [(time, node, "log", levels.get(level, "") + text) for time, node, level, text in flight.logs]
    for (index, other), changes in flight.peers.items():
        for time, peer in zip(changes.times, changes.values):
            found.append((time, flight.lives[index].node, "state",
                          f"{other} is {peer.state}" + (f": {peer.reason}" if peer.reason else "")))
    for node, subject, _, reason, since, until in flight.problems:
        found.append((since, node, "problem", f"{subject}: {reason}"))
        if until is not None:
            found.append((until, node, "problem", f"solved: {subject}: {reason}"))
    for fault in flight.faults:
        found.append((fault.began, "lab", "lab", fault.text))
        if fault.began < fault.ended < float("inf"):
            found.append((fault.ended, "lab", "lab", f"end of: {fault.text}"))
    for life in flight.lives:
        found.append((life.began, life.node, "lab", "started" + (f", incarnation {life.number}" if life.number > 1 else "")))
        if life.ended is not None:
            found.append((life.ended, life.node, "lab", f"ended with {life.code} ({life.by})"))
    return sorted(found, key=lambda entry: entry[0])


def write(flight, path):
    """One line each."""
    with open(path, "w", encoding="utf-8") as file:
        for time, node, kind, text in entries(flight):
            file.write(f"{time:9.3f}  {node:<12} {kind:<8} {text}\n")
