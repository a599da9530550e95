"""Flies every aircraft that is low to 120 m, and tells what became of it."""

import asyncio
import contextlib
import sys

import rabit

idl = rabit.load_idl(sys.argv[1])  # uav.idl


async def main() -> None:
    async with rabit.Node("planner", domain=int(sys.argv[2]), interfaces=["127.0.0.1"]) as node:
        async for pose in node.subscribe("uav*/Pose", idl.Uav.Pose):
            if pose.age < 0.5 and pose.value.altitude_m < 100:
                goto = idl.Uav.Goto(latitude_deg=pose.value.latitude_deg, longitude_deg=pose.value.longitude_deg,
                                    altitude_m=120)
                outcome = await node.send(f"{pose.node}/MissionControl", goto, expire=2.0)
                print(pose.node, outcome, flush=True)


with contextlib.suppress(KeyboardInterrupt):  # Ctrl-C
    asyncio.run(main())
