"""Autopilots in simulation beside the nodes: the programs behind `autopilot:` of a scenario. They are installed by the user."""

import os
import pathlib
import shutil

MAVLINK, DDS = "mavlink", "dds"
PX4, ARDUCOPTER = "px4-sih", "arducopter"
KINDS = (PX4, ARDUCOPTER)
AGENT_PORTS = {PX4: 8888, ARDUCOPTER: 2019}
ARDUCOPTER_PORT = 14550
# PX4's start script sends the MAVLink of a companion computer to this port, one more for each instance until the last one.
PX4_PORT, PX4_LAST_PORT = 14540, 14549


def mavlink_port(kind, instance):
    """The port of loopback to which an autopilot sends. Autopilots of one kind are numbered from 0: nodes have loopback of their
    own, but the lock files of PX4 are in a folder that all share."""
    return min(PX4_PORT + instance, PX4_LAST_PORT) if kind == PX4 else ARDUCOPTER_PORT


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
