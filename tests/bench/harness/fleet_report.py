"""The fleets as Markdown: what a process costs, and by which law it grows with their number."""

import collections

from contestants import NODE, RAW_WORKER
from law import Law

NAMES = {"fastdds": "Fast DDS", "cyclonedds": "Cyclone DDS"}
WHO = {RAW_WORKER: "raw", NODE: "Rabit"}
# If less than this share of the samples arrived, the machine did not do the work whose cost is asked for.
LEAST_ARRIVED = 0.9

# Title, name of the value, factor, digits.
COSTS = [("processor, % of a core", "processor", 100, 2), ("bytes a second", "bytes_per_s", 1, 0),
         ("memory of its own, MiB", "own_mib", 1, 1)]


def fleets(table):
    """{(carriage and rate, transport, contestant): {size: {name: median}}}"""
    found = collections.defaultdict(dict)
    for key, contestants in table.results.items():
        if key.startswith("fleet "):
            _, transport, carriage, size, _, _, hertz, _ = key.split()
            for contestant, values in contestants.items():
                found[f"{carriage}, {hertz} Hz", transport, contestant][int(size)] = {
                    name: table.value(key, contestant, name) for name in values}
    return found


def costs(table):
    header = ["what", "backend", "who", "nodes", "processor, % of a core", "the same for each other node",
              "memory, MiB", "of its own", "bytes a second", "all heard all, s", "arrived, %", "machine busy, %"]
    lines = []
    for (carriage, transport, contestant), sizes in fleets(table).items():
        for size, value in sizes.items():
            lines.append([carriage, NAMES[transport], WHO[contestant], str(size), f"{100 * value['processor']:.2f}",
                          f"{100 * value['processor'] / (size - 1):.3f}", f"{value['pss_mib']:.1f}",
                          f"{value['own_mib']:.1f}", f"{value['bytes_per_s']:.0f}", f"{value['discovery_s']:.2f}",
                          f"{100 * value['arrived']:.0f}", f"{100 * value['busy']:.0f}"])
    return header, lines


def laws(table):
    header = ["what", "backend", "who", "nodes", "cost", "alone", "+ each other node", "furthest off",
              "a square's share at the largest", "needed"]
    lines = []
    for (carriage, transport, contestant), sizes in fleets(table).items():
        taken = {size: value for size, value in sizes.items() if value["arrived"] >= LEAST_ARRIVED}
        if len(taken) < 3:
            continue
        for what, name, factor, digits in COSTS:
            law = Law([(size - 1, factor * value[name]) for size, value in taken.items()])
            square, needed = "", "too few sizes"
            if law.wants_square is not None:
                square = f"{100 * law.square_share:.0f} % +/- {100 * law.square_interval:.0f}"
                needed = "yes" if law.wants_square else "no"
            lines.append([carriage, NAMES[transport], WHO[contestant], ", ".join(map(str, sorted(taken))), what,
                          f"{law.fixed:.{digits}f}", f"{law.each:.{digits + 1}f}", f"{100 * law.furthest:.0f} %",
                          square, needed])
    return header, lines


def costs_and_laws(table, rows):
    return "What each process costs on average.\n\n" + rows(*costs(table)) + laws_alone(table, rows)


def laws_alone(table, rows):
    header, lines = laws(table)
    if not lines:
        return ""
    text = (f"The law: what a node costs alone, and for each other node, by least squares of the relative deviations "
            f"over the sizes of which at least {100 * LEAST_ARRIVED:.0f} % of the samples arrived. A term in the "
            "square of the number of others is needed if it is above zero with 95 % confidence.\n\n")
    return text + rows(header, lines)
