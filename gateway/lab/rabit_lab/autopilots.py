"""Autopilots in simulation beside the nodes: the programs behind `autopilot:` of a scenario. They are installed by the user."""

import shutil

MAVLINK, DDS = "mavlink", "dds"


class Autopilot:
    """A kind of autopilot. `program` is looked for in PATH."""

    def __init__(self, program, advice, argv, env, agent_port):
        self.program, self.advice, self.argv, self.env, self.agent_port = program, advice, argv, env, agent_port


# Each node has loopback and files of its own, so that all are instance 0, with its usual ports.
KINDS = {
    "px4-sih": Autopilot("px4", "build PX4 (`make px4_sitl_sih`) and put its bin/ in PATH", ["-d", "-w", "{disk}"],
                         {"PX4_SIM_MODEL": "sihsim_quadx"}, 8888),
    "arducopter": Autopilot("arducopter", "build ArduPilot (`./waf copter` for the board sitl) and put build/sitl/bin in PATH",
                            ["--model", "quad", "--serial0", "udpclient:127.0.0.1:14550"], {}, 2019),
}
AGENT = "MicroXRCEAgent"


def programs(kind, over, options):
    """[(word of the name, argv, environment)], in the order of their starts. Raises ValueError for a program that is missing."""
    known = KINDS[kind]
    found = []
    if over == DDS:
        found.append(("agent", [_path(AGENT, "install eProsima's Micro XRCE-DDS Agent"), "udp4", "-p", str(known.agent_port)], {}))
    found.append(("autopilot", [_path(known.program, known.advice), *known.argv, *options], known.env))
    return found


def _path(program, advice):
    path = shutil.which(program)
    if path is None:
        raise ValueError(f"no program `{program}` in PATH; {advice}")
    return path
