"""A mission of the swarm example: all aircraft search an area, until targets are validated or the time is over; then they
fly home. Each command's outcome and its stages are printed.

    mission.py --idl uav.idl --domain 7 --aircraft 3 [--seconds 120]
"""

import argparse
import asyncio
import itertools
from typing import Any

import rabit

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--idl", required=True)
parser.add_argument("--domain", type=int, default=0)
parser.add_argument("--interface", action="append", default=[])
parser.add_argument("--transport", default="fastdds")
parser.add_argument("--aircraft", type=int, default=1, help="as many are waited for")
parser.add_argument("--seconds", type=float, default=120, help="of search, at most")
parser.add_argument("--targets", type=int, default=1, help="validated ones that end the search")
options = parser.parse_args()

idl = rabit.load_idl(options.idl)
numbers = itertools.count(1)


async def aircraft(poses: rabit.Subscription, count: int) -> dict[str, Any]:
    """The first poses of so many aircraft."""
    seen: dict[str, Any] = {}
    async for pose in poses:
        seen[pose.node] = pose.value
        if len(seen) >= count:
            return seen
    return seen


async def command(node: rabit.Node, kind: Any, names: list[str], **members: Any) -> None:
    """Sends a command to each of them, and tells the outcomes."""
    # The announcement of an aircraft that has just started may not have come.
    for name in names:
        message = kind(id=next(numbers), reply_to="ground/Commands", **members)
        receipt = node.send(f"{name}/MissionControl", message, expire=10)
        while receipt.outcome is rabit.Outcome.REFUSED:
            await asyncio.sleep(0.2)
            receipt = node.send(f"{name}/MissionControl", message, expire=10)
        print(f"{kind.__name__} to {name}: {(await receipt).name}", flush=True)


async def acknowledged(node: rabit.Node, count: int) -> None:
    """Prints answers until so many commands are accepted or declined."""
    async for received in node.queue("Commands"):
        ack = received.value
        print(f"{ack.node}: command {ack.id} {ack.stage.name} {ack.reason}", flush=True)
        count -= ack.stage in (idl.Uav.CommandStage.COMMAND_ACCEPTED, idl.Uav.CommandStage.COMMAND_DECLINED)
        if count <= 0:
            return


async def validated(findings: rabit.Subscription, count: int) -> None:
    """Returns when so many targets are validated."""
    known: set[tuple[str, int]] = set()
    async for found in findings:
        for item in found.value.items:
            if item.stage >= idl.Uav.TargetStage.TARGET_VALIDATED and (found.node, item.target) not in known:
                known.add((found.node, item.target))
                print(f"{found.node}: target {item.target} {item.stage.name} by {item.validated_by}", flush=True)
        if len(known) >= count:
            return


async def main() -> None:
    node = rabit.Node(
        "ground",  # the aircraft take search areas from this name
        domain=options.domain,
        interfaces=options.interface,
        transport=options.transport,
        publish={"SearchArea": idl.Uav.SearchArea},
        accept={"Commands": [idl.Uav.CommandAck]},
    )
    async with node:
        seen = await aircraft(node.subscribe("uav?/Pose", idl.Uav.Pose), options.aircraft)
        names = sorted(seen)
        middle = seen[names[0]]
        # Aircraft keep the area with the highest number.
        states = [node.subscribe(f"{name}/MissionState", idl.Uav.MissionState) for name in names]
        newest = max([(await asyncio.wait_for(anext(state), 10)).value.search_area for state in states])
        node.post("SearchArea", idl.Uav.SearchArea(
            number=newest + 1, latitude_deg=middle.latitude_deg, longitude_deg=middle.longitude_deg, north_m=300, east_m=300,
            altitude_m=middle.altitude_m, speed_mps=15, lane_m=60))
        await command(node, idl.Uav.Search, names)
        await acknowledged(node, len(names))
        try:
            findings = node.subscribe("uav?/Findings", idl.Uav.Findings)
            await asyncio.wait_for(validated(findings, options.targets), options.seconds)
        except asyncio.TimeoutError:
            print("the time is over", flush=True)
        await command(node, idl.Uav.GoHome, names, reason="the mission is over")
        await acknowledged(node, len(names))


asyncio.run(main())
