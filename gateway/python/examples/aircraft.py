"""An aircraft to try programs with: it flies where it is sent, and answers. No autopilot, no camera.

    aircraft.py uav.idl 7 [NAME] [FOLDER]     it records itself into the folder
"""

import signal
import sys
from typing import Any

import rabit

idl = rabit.load_idl(sys.argv[1])
DONE, ACCEPTED = idl.Uav.CommandStage.COMMAND_DONE, idl.Uav.CommandStage.COMMAND_ACCEPTED


class Pilot(rabit.Manager):
    period = 0.1

    def __init__(self) -> None:
        self.pose = idl.Uav.Pose(latitude_deg=47.4, longitude_deg=8.5, altitude_m=80)
        self.target: Any = None  # a Goto

    def unit_of_work(self) -> None:
        commands = self.node.queue("MissionControl")
        while len(commands):
            self.obey(commands.get().value)
        if self.target:
            for name, step in (("latitude_deg", 1e-4), ("longitude_deg", 1e-4), ("altitude_m", 1.0)):
                way = getattr(self.target, name) - getattr(self.pose, name)
                setattr(self.pose, name, getattr(self.pose, name) + min(max(way, -step), step))
        self.pose.number += 1
        self.post("Pose", self.pose)

    def obey(self, command: Any) -> None:
        if isinstance(command, idl.Uav.Goto):
            self.target = command
        print(command, flush=True)
        for stage in (ACCEPTED, DONE) if command.reply_to else ():
            self.send(command.reply_to, idl.Uav.CommandAck(id=command.id, node=self.node.name, stage=stage))


settings: dict[str, Any] = {"record": {"folder": sys.argv[4]}} if len(sys.argv) > 4 else {}
node = rabit.Node(
    sys.argv[3] if len(sys.argv) > 3 else "uav1",
    domain=int(sys.argv[2]),
    interfaces=["127.0.0.1"],
    publish={"Pose": idl.Uav.Pose},
    accept={"MissionControl": [idl.Uav.Goto, idl.Uav.Search, idl.Uav.GoHome]},
    managers=[Pilot()],
    **settings,
)
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, lambda *_: node.stop())  # the iteration ends
with node:
    for area in node.subscribe("ground/SearchArea", idl.Uav.SearchArea):
        print(area.value, flush=True)
