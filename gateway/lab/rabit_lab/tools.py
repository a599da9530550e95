"""Where the lab's programs are: in the installed package or in a build tree, as the program `rabit` says."""

import dataclasses
import os
import pathlib

from rabit_lab.radio import Unsupported


@dataclasses.dataclass
class Tools:
    """Paths of programs."""
    rabit: str
    radio: str
    facts: str
    replay: str
    stepped_clock: str


def find():
    """RABIT_LAB_RABIT is the program `rabit`, RABIT_LAB_PROGRAMS the folder of the others."""
    rabit = os.environ.get("RABIT_LAB_RABIT", "rabit")
    folder = pathlib.Path(os.environ.get("RABIT_LAB_PROGRAMS", "."))
    names = {"radio": "radio", "facts": "lab_facts", "replay": "lab_replay", "stepped_clock": "libstepped_clock.so"}
    found = {}
    for key, name in names.items():
        path = next((p for p in (folder / name, pathlib.Path(rabit).parent / name) if p.exists()), None)
        if path is None:
            raise Unsupported(f"no {name} in {folder}: the package rabit-tools brings it; in a build tree it is a target")
        found[key] = str(path)
    return Tools(rabit, **found)
