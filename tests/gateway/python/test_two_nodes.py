"""Two nodes in one process, over each transport on loopback."""

import asyncio

import rabit
from conftest import wait_until


def pair(idl, network, **more):
    uav = rabit.Node("uav1", publish={"Pose": idl.Uav.Pose}, accept={"MissionControl": [idl.Uav.Goto]}, **network)
    ground = rabit.Node("ground", **network, **more)
    return uav, ground


def test_a_posted_message_and_a_command_arrive(idl, network):
    uav, ground = pair(idl, network)
    with uav, ground:
        poses = ground.subscribe("uav*/Pose", idl.Uav.Pose)
        uav.post("Pose", idl.Uav.Pose(altitude_m=80, number=1))
        pose = poses.get(timeout=120)
        assert (pose.node, pose.message, pose.value.altitude_m) == ("uav1", "uav1/Pose", 80)
        assert 0 <= pose.age < 30
        wait_until(lambda: ground.fleet().is_up("uav1"))
        receipt = ground.send("uav1/MissionControl", idl.Uav.Goto(id=5, altitude_m=120))
        command = uav.queue("MissionControl").get(timeout=120)
        assert command.value == idl.Uav.Goto(id=5, altitude_m=120) and not command.redelivered
        assert receipt.wait(120) is rabit.Outcome.DELIVERED


def test_the_same_with_an_event_loop(idl, network):
    async def program():
        uav, ground = pair(idl, network)
        async with uav, ground:
            poses = ground.subscribe("uav*/Pose", idl.Uav.Pose)
            uav.post("Pose", idl.Uav.Pose(altitude_m=80))
            async for pose in poses:
                outcome = await ground.send(f"{pose.node}/MissionControl", idl.Uav.Goto(altitude_m=120), expire=20.0)
                assert outcome is rabit.Outcome.DELIVERED
                break
            async for command in uav.queue("MissionControl"):
                assert command.value.altitude_m == 120
                break

    asyncio.run(asyncio.wait_for(program(), 240))


def test_a_node_of_several_paths_is_reached_by_one_that_works(idl, one_network, tmp_path):
    """The second path of the ground has nobody on it. A file is there, too: what the program gives counts more."""
    domain = {"domain": one_network["domain"], "transport": one_network["transport"]}
    file = tmp_path / "ground.yaml"
    file.write_text("node: ground\npaths: [{name: none, interfaces: [none0]}]\n")
    paths = [{"name": "mesh", "interfaces": ["127.0.0.1"]}, {"name": "modem", "interfaces": ["none1"]}]
    uav = rabit.Node("uav1", publish={"Pose": idl.Uav.Pose}, **one_network)
    with uav, rabit.Node(config=file, paths=paths, **domain) as ground:
        poses = ground.subscribe("uav1/Pose", idl.Uav.Pose)
        uav.post("Pose", idl.Uav.Pose(altitude_m=80))
        assert poses.get(timeout=120).value.altitude_m == 80
