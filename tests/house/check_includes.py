#!/usr/bin/env python3
"""Checks who includes whom, as the folders' architecture says.

Usage: check_includes.py ROOT
Prints one line `file:line: message` for each violation; exits 1 if there is any.
"""

import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
SOURCES = {".h", ".hpp", ".c", ".cpp", ".cc"}

# The rooms of the gateway, from the bottom up, and the rooms that each may include. "links" stands for the public
# headers of gateway/links; the list includes the rooms that drive its protocol.
ROOMS = {
    "air": [],
    "keys": [],
    "names": [],
    "clocks": [],
    "incarnation": ["links"],
    "agreement": [],
    "wire": ["names", "links"],
    "configuration": ["air", "names", "wire"],
    "types": ["names", "wire"],
    "presence": ["names", "clocks", "wire", "types"],
    "paths": ["presence"],
    "mirrors": ["air", "names", "clocks", "wire", "presence", "paths"],
    "queues": ["air", "names", "clocks", "incarnation", "wire", "links", "presence"],
    "foreign": ["air", "names", "clocks", "wire", "mirrors", "queues"],
    "report": ["names", "wire", "presence", "paths", "mirrors", "queues"],
    "manager": ["agreement", "air", "keys", "names", "clocks", "configuration", "incarnation", "wire", "links", "types", "presence", "paths",
                "mirrors", "queues", "foreign", "report"],
}

# The owner of a header, by its path. The first pattern that fits holds.
OWNERS = [
    (r"recording/mcap/", "room mcap"),
    (r"recording/merge/", "room merge"),
    (r"recording/replay/", "room replay"),
    (r"recording/rerun/", "room rerun"),
    (r"recording/", "room recording"),
    (r"backfill/", "room backfill"),
    (r"backfill\.idl\.h", "backfill messages"),
    *((f"{room}/", f"room {room}") for room in ROOMS),
    (r"guard/", "guard"),
    (r"envelope/", "envelope"),
    (r"rtps/", "meeting"),
    (r"rabit/base/", "base"),
    (r"rabit/idl/", "idl"),
    (r"rabit/dynamic/", "idl dynamic"),
    (r"model/", "idl model"),
    (r"dynamic/", "room idl dynamic"),
    (r"ros/", "room idl ros"),
    (r"rabit/transport/TransportFactory\.h", "factory"),
    (r"rabit/transport/", "transport"),
    (r"rabit/fastdds/", "fastdds backend"),
    (r"rabit/cyclonedds/", "cyclonedds backend"),
    (r"rabit/simulated/", "simulated backend"),
    (r"rabit/gateway/links/", "links"),
    (r"rabit/gateway/(ByteSize|NamePattern|SchemaText)\.h", "gateway names"),
    (r"rabit/gateway/", "gateway"),
    (r"rabit/node/", "node"),
    (r"rabit/testing/", "testing"),
    (r"rabit/recording/", "recording"),
    (r"rabit/mcap/", "mcap"),
    (r"rabit/keys/", "keys"),
    (r"rabit/backfill/", "backfill"),
    (r"rabit/", "core"),
    (r"gateway\.idl\.h", "gateway messages"),
    (r".*\.idl\.h", "user messages"),
    (r"fastdds/|fastrtps/", "Fast DDS"),
    (r"fastcdr/", "Fast-CDR"),
    (r"dds/|ddsc/|idlc/|idl/", "Cyclone DDS"),
    (r"yaml-cpp/", "yaml-cpp"),
    (r"openssl/", "OpenSSL"),
    (r"zstd\.h", "zstd"),
    (r"zlib\.h", "zlib"),
    (r"CLI/", "CLI11"),
    (r"boost/asio/ip/address", None),  # a value, which opens no socket
    (r"boost/asio|boost/beast", "network"),
    (r"sys/socket\.h|netinet/|arpa/|netdb\.h", "network"),
]

# The owners that the files below a folder may include. The longest folder that fits holds. A header without an owner
# (the standard library, Boost, the file's own folder) may be included everywhere.
ALLOWED = {
    "base": {"base"},
    "core": {"core"},
    "idl/runtime": {"core", "idl", "Fast-CDR"},
    "idl/model": {"idl model", "Cyclone DDS"},
    "idl/generator": {"idl model"},
    "idl/ros": {"idl model", "room idl ros"},
    "idl/dynamic": {"core", "idl", "Fast-CDR", "idl model", "idl dynamic", "room idl dynamic", "room idl ros"},
    "idl/dynamic/include": {"core", "idl", "idl dynamic"},
    "idl/dynamic/IdlParser.c": {"room idl dynamic", "Cyclone DDS"},
    "transport/include": {"transport"},
    "transport/common": {"transport", "network"},
    "transport/guard": {"transport", "guard"},
    "transport/envelope": {"transport", "guard", "envelope", "OpenSSL"},
    "transport/rtps": {"transport", "guard", "meeting", "zstd"},
    "transport/factory": {"transport", "factory", "fastdds backend", "cyclonedds backend"},
    "transport/fastdds": {"transport", "envelope", "guard", "meeting", "fastdds backend", "Fast DDS", "network"},
    "transport/cyclonedds": {"transport", "envelope", "guard", "meeting", "cyclonedds backend", "Cyclone DDS", "network"},
    "transport/simulated": {"transport", "envelope", "simulated backend", "meeting"},
    "gateway/include": {"core", "idl", "transport", "gateway", "gateway messages"},
    "gateway/links": {"links"},
    **{f"gateway/{room}": {"core", "idl", "transport", "gateway", "gateway messages", f"room {room}"}
       | ({"yaml-cpp"} if room == "configuration" else set())
       | ({"OpenSSL", "envelope"} if room == "keys" else set())
       | {"links" if below == "links" else f"room {below}" for below in rooms} for room, rooms in ROOMS.items()},
    # Only files: no network, no messages.
    "gateway/recording/mcap": {"mcap", "room mcap", "zstd", "zlib"},
    "gateway/recording/merge": {"gateway names", "mcap", "room merge"},
    # The order of a replay: only files and names.
    "gateway/recording/replay": {"gateway names", "mcap", "room replay"},
    # Runs managers again: files, messages and core, no network.
    "gateway/recording/rerun": {"core", "idl", "idl dynamic", "recording", "mcap", "room rerun"},
    "gateway/recording": {"core", "idl", "gateway", "recording", "room clocks", "mcap", "room rerun",
                          "room recording"},
    # Posts and files of other nodes' recordings, over queue messages.
    "gateway/backfill": {"backfill", "core", "idl", "gateway", "gateway messages", "backfill messages", "recording", "OpenSSL",
                         "mcap", "room recording", "room backfill"},
    "gateway/tool": {"core", "idl", "idl dynamic", "factory", "gateway", "node", "recording", "gateway messages", "transport",
                     "network", "envelope", "guard", "CLI11", "room keys", "room manager", "mcap",
                     "room recording", "room merge", "room replay", "room backfill", "backfill messages"},
    "gateway/python": {"core", "idl", "idl dynamic", "factory", "gateway", "recording", "backfill", "gateway messages",
                       "transport", "mcap", "room merge"},
    # Whole nodes on a simulated network, for tests.
    "gateway/testing": {"core", "transport", "simulated backend", "gateway", "testing"},
    "gateway/node": {"core", "idl", "factory", "gateway", "node", "recording", "backfill", "network", "CLI11"},
    # Programs that are measured against each other. Nodes name no vendor. The plain programs of each vendor show what
    # a user gets without Rabit, and so include nothing of it.
    "tests/bench": {"core", "idl", "idl dynamic", "transport", "factory", "simulated backend", "gateway", "gateway messages",
                    "user messages", "recording", "room recording", "mcap", "CLI11"},
    "tests/bench/raw": {"CLI11"},
    "tests/bench/raw/fastdds": {"Fast DDS", "Fast-CDR"},
    "tests/bench/raw/cyclonedds": {"Cyclone DDS"},
    # The lab: its radio carries any program's frames, and its reader of recordings knows no network.
    "gateway/lab/radio": {"CLI11", "network"},
    "gateway/lab/facts": {"core", "idl", "idl dynamic", "gateway messages", "mcap", "CLI11"},
    # A recorded node is one of a simulated fleet, or a real one, which records itself.
    "gateway/lab/replay": {"core", "base", "factory", "idl", "idl dynamic", "gateway", "recording", "testing", "mcap",
                           "room replay", "CLI11"},
    "docs/generate": {"room configuration"},
    "examples": {"backfill", "core", "idl", "factory", "gateway", "node", "recording", "gateway messages", "user messages", "CLI11",
                 "network", "yaml-cpp"},
    # Serves TLS, with keys of its own.
    "examples/ground_station/web": {"core", "idl", "gateway", "node", "gateway messages", "user messages", "network", "OpenSSL",
                                    "room keys"},
}

# Two files of the tool still read private headers of rooms that fly.
ALLOWED["gateway/tool/FleetClaims.cpp"] = ALLOWED["gateway/tool"] | {"room wire"}
ALLOWED["gateway/tool/ForeignArguments.cpp"] = ALLOWED["gateway/tool"] | {"room names"}

# The rooms of these folders may include base/, which stands below them all. Files that may include the gateway's public
# headers may include its names. The room keys and its readers may include its public headers.
for folder, owners in ALLOWED.items():
    if "gateway" in owners:
        owners.add("gateway names")
    if "room keys" in owners:
        owners.add("keys")
    if folder.split("/")[0] in {"idl", "transport", "gateway"}:
        owners.add("base")


def upward_rooms():
    """Rooms that look into one that does not stand below them, so that includes would not run one way."""
    order = ["links", *ROOMS]
    for room, below in ROOMS.items():
        for other in below:
            if other not in order[:order.index(room)]:
                yield f"tests/house: room {room} may not look into {other}, which does not stand below it"


def rooms_unknown(root):
    """Folders of the gateway that are no rooms, and so are not checked."""
    for folder in sorted((root / "gateway").glob("*/")):
        if folder.name not in {"backfill", "include", "lab", "links", "node", "python", "recording", "testing", "tool", *ROOMS} and any(folder.rglob("*.h")):
            yield f"gateway/{folder.name}: no room that the house knows"


def owner_of(header):
    for pattern, owner in OWNERS:
        if re.match(pattern, header):
            return owner
    return None


def allowed_for(path):
    best = None
    for folder in ALLOWED:
        if path.is_relative_to(folder) and (best is None or len(folder) > len(best)):
            best = folder
    return best


def violations(root):
    for path in sorted(root.rglob("*")):
        relative = path.relative_to(root)
        folder = allowed_for(relative)
        if path.suffix not in SOURCES or folder is None or not path.is_file():
            continue
        for number, line in enumerate(path.read_text(errors="replace").splitlines(), start=1):
            match = INCLUDE.match(line)
            owner = owner_of(match.group(1)) if match else None
            if owner is not None and owner not in ALLOWED[folder]:
                yield f"{relative}:{number}: {folder}/ must not include <{match.group(1)}> ({owner})"


def main():
    root = pathlib.Path(sys.argv[1])
    found = [*upward_rooms(), *rooms_unknown(root), *violations(root)]
    for line in found:
        print(line)
    checked = [folder for folder in ALLOWED if (root / folder).is_dir()]
    print(f"{len(found)} violations in {', '.join(checked)}")
    return 1 if found or "core" not in checked else 0


if __name__ == "__main__":
    sys.exit(main())
