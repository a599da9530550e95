"""Autopilots in simulation beside the nodes: the programs behind `autopilot:` of a scenario. They are installed by the user."""

import os
import pathlib
import shutil

from rabit_lab import marked
from rabit_lab.marked import nearest

MAVLINK, DDS = "mavlink", "dds"
PX4, ARDUCOPTER = "px4-sih", "arducopter"
KINDS = (PX4, ARDUCOPTER)
AGENT_PORTS = {PX4: 8888, ARDUCOPTER: 2019}
ARDUCOPTER_PORT = 14550
# PX4's start script sends the MAVLink of a companion computer to this port, one more for each instance until the last one.
PX4_PORT, PX4_LAST_PORT = 14540, 14549


def read(reader, node, value, counts):
    """(the port of loopback to which the autopilot of a node sends MAVLink, its programs). A mistake is the reader's error.
    `counts` numbers those of one kind from 0: nodes have loopback of their own, but PX4's lock files are in a folder that all
    share."""
    at, section = value.line_of("autopilot"), value["autopilot"]
    if isinstance(section, marked.Map):
        reader.keys(section, ("kind", "over", "options"), "autopilot")
    else:
        section = {"kind": section}
    kind, over = section.get("kind"), section.get("over", MAVLINK)
    if kind not in KINDS:
        reader.fail(at, f"autopilot: {' or '.join(KINDS)}, not `{kind}`{nearest(kind, KINDS)}")
    if over not in (MAVLINK, DDS):
        reader.fail(at, f"autopilot: `over` is {MAVLINK} or {DDS}, not `{over}`")
    if node.image:
        reader.fail(at, f"autopilot: node {node.name} has an image; start the autopilot in it")
    options = [str(option).replace("{node}", node.name)
               for option in reader.list(section.get("options", marked.List()), at, "options")]
    instance = counts[kind] = counts.get(kind, -1) + 1
    try:
        found = programs(kind, over, node.name, instance, options)
    except ValueError as error:
        reader.fail(at, f"node {node.name}, autopilot {kind}: {error}")
    return min(PX4_PORT + instance, PX4_LAST_PORT) if kind == PX4 else ARDUCOPTER_PORT, found


def programs(kind, over, node, instance, options):
    """[(word of the name, argv, environment)], in the order of their starts. Raises ValueError for a program that is missing."""
    found = []
    if over == DDS:
        agent = _path("MicroXRCEAgent", "install eProsima's Micro XRCE-DDS Agent")
        found.append(("agent", [agent, "udp4", "-p", str(AGENT_PORTS[kind])], {}))
    argv, env = _px4(node, instance) if kind == PX4 else _arducopter()
    return [*found, ("autopilot", [*argv, *options], env)]


def _px4(node, instance):
    program = pathlib.Path(os.path.realpath(_path("px4", "build PX4 (`make px4_sitl`) and put build/px4_sitl_default/bin in PATH")))
    data = program.parent.parent / "etc"
    if not data.is_dir():
        raise ValueError(f"`{program}` has no start scripts in {data}; put bin/ of a whole build of PX4 in PATH")
    # Its topics are below the node's name, since those of all aircraft are in one domain.
    return ([str(program), "-d", "-i", str(instance), "-w", "{disk}", str(data)],
            {"PX4_SIM_MODEL": "sihsim_quadx", "PX4_UXRCE_DDS_NS": node})


def _arducopter():
    program = _path("arducopter", "build ArduPilot (`./waf copter` for the board sitl) and put build/sitl/bin in PATH")
    return [program, "--model", "quad", "--serial0", f"udpclient:127.0.0.1:{ARDUCOPTER_PORT}"], {}


def _path(program, advice):
    path = shutil.which(program)
    if path is None:
        raise ValueError(f"no program `{program}` in PATH; {advice}")
    return path
