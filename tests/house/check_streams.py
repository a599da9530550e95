#!/usr/bin/env python3
"""A string stream formats numbers by the program's global locale, which may write 1400 as 1,400. So each has the classic locale,
`NAME.imbue(std::locale::classic())` within two lines, or its file is in the list below, with its reason.

Usage: check_streams.py ROOT"""

import pathlib
import re
import sys
import tempfile

ROOMS = ("base", "core", "idl", "transport", "gateway")
PEOPLE = "people read the numbers, and no machine does"
TEXT = "only text passes through it"
MAY = {
    "core/src/ManagerControlMessage.cpp": PEOPLE,
    "core/src/ManagerStats.cpp": PEOPLE,
    "core/src/ManagerStatusMessage.cpp": PEOPLE,
    "core/src/RabitMessage.cpp": PEOPLE,
    "gateway/links/src/LinkNodeView.cpp": PEOPLE,
    "gateway/links/src/LinkPeer.cpp": PEOPLE,
    "gateway/links/src/LinkReceiver.cpp": PEOPLE,
    "gateway/links/src/LinkSender.cpp": PEOPLE,
    "gateway/configuration/LoadGatewayConfig.cpp": TEXT,
    "gateway/python/src/NodeModule.cpp": TEXT,
    "gateway/tool/CheckedFiles.cpp": TEXT,
    "gateway/tool/doctor/MachineFacts.cpp": TEXT,
    "idl/dynamic/IdlIncludes.cpp": TEXT,
    "idl/ros/MsgReader.cpp": TEXT,
    "transport/common/HardwareAddresses.cpp": TEXT,
}
STREAM = re.compile(r"\bstd::[io]?stringstream\s+(\w+)")
CLASSIC = "{}.imbue(std::locale::classic())"
NEAR = 2


def violations(root):
    needless = dict(MAY)
    for room in ROOMS:
        for path in sorted((root / room).rglob("*")):
            if path.suffix not in (".cpp", ".h"):
                continue
            name = path.relative_to(root).as_posix()
            lines = path.read_text(encoding="utf-8").splitlines()
            for number, line in enumerate(lines, 1):
                stream = STREAM.search(line)
                if not stream or any(CLASSIC.format(stream[1]) in near for near in lines[number : number + NEAR]):
                    continue
                needless.pop(name, None)
                if name not in MAY:
                    yield f"{name}:{number}: takes the global locale: {line.strip()}"
    yield from (f"{name}: has no such stream any more, so it must leave the list of check_streams.py" for name in needless)


def notices_violations():
    """Each of the first texts, in a file of its own, is a violation."""
    wrong = {"core/a.cpp": "std::ostringstream text;\ntext << 1400;\n", "gateway/b.h": "    std::stringstream xml(line);\n",
             "idl/c.cpp": "std::ostringstream one;\nother.imbue(std::locale::classic());\n"}
    fine = {"core/d.cpp": "std::ostringstream text;\ntext.imbue(std::locale::classic());\n", "tests/e.cpp": "std::ostringstream text;\n",
            "core/f.md": "std::ostringstream text;\n"}
    with tempfile.TemporaryDirectory() as folder:
        for name, text in {**wrong, **fine}.items():
            path = pathlib.Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        found = {text.split(":")[0] for text in violations(pathlib.Path(folder))}
    return found == set(wrong) | set(MAY)


def main():
    assert notices_violations(), "a violation is not noticed"
    found = list(violations(pathlib.Path(sys.argv[1])))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
