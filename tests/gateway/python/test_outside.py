"""Nodes with keys, and foreign programs with types of ROS 2. RABIT_BIN: the folder of the program rabit. RABIT_PLAIN: a plain
program of DDS."""

import os
import pathlib
import subprocess

import pytest

import rabit
from conftest import program, run, wait_until

TOOL = pathlib.Path(os.environ.get("RABIT_BIN", "/nowhere")) / "rabit"
PLAIN = os.environ.get("RABIT_PLAIN", "")
LOOPBACK = ("<CycloneDDS><Domain><General><Interfaces><NetworkInterface address='127.0.0.1'/></Interfaces></General><Discovery>"
            "<ParticipantIndex>auto</ParticipantIndex><Peers><Peer address='127.0.0.1'/></Peers></Discovery></Domain></CycloneDDS>")
STRING = "module std_msgs { module msg { @final struct String { string data; }; }; };"


def make_keys(folder):
    """Makes the keys of a fleet of two nodes, and of a node that another authority admits."""
    made = {}
    for fleet in ("own", "other"):
        subprocess.run([TOOL, "keys", "init", folder / fleet], check=True, stdout=subprocess.DEVNULL)
    sections = {"uav1": "publish:\n  - {message: Pose, type: Uav::Pose}\naccept:\n  - {queue: Commands, types: [Uav::Goto]}\n",
                "ground": "subscribe:\n  - {message: Pose, type: Uav::Pose, from: [uav1]}\nsend:\n  - {to: uav1, queue: Commands}\n"}
    for name, fleet in (("uav1", "own"), ("ground", "own"), ("ground", "other")):
        config = folder / f"{name}.yaml"
        config.write_text(f"node: {name}\n{sections[name]}")
        subprocess.run([TOOL, "keys", "add", name, "--config", config, "--keys", folder / fleet], check=True,
                       stdout=subprocess.DEVNULL)
        made[fleet, name] = {"keys": str(folder / fleet / name)}
    return made


@pytest.mark.skipif(not TOOL.exists(), reason="the program rabit is not built")
def test_nodes_with_keys_hear_their_fleet_alone(idl, network, tmp_path):
    keys = make_keys(tmp_path)
    ground = """
        with rabit.Node("ground", security=KEYS, **network) as node:
            poses = node.subscribe("uav1/Pose", idl.Uav.Pose)
            try:
                print(poses.get(timeout=SECONDS).value.altitude_m)
            except TimeoutError:
                sys.exit("nothing came")
            while (receipt := node.send("uav1/Commands", idl.Uav.Goto(altitude_m=120))).outcome is rabit.Outcome.REFUSED:
                time.sleep(0.01)
            print(receipt.wait(60))
        """
    uav = rabit.Node("uav1", publish={"Pose": idl.Uav.Pose}, accept={"Commands": [idl.Uav.Goto]},
                     security=keys["own", "uav1"], **network)
    with uav:
        uav.post("Pose", idl.Uav.Pose(altitude_m=80))
        for fleet, seconds, said in (("own", 60, "80.0\nOutcome.DELIVERED\n"), ("other", 3, "")):
            text = ground.replace("KEYS", repr(keys[fleet, "ground"])).replace("SECONDS", str(seconds))
            with run(program(network, text)) as child:
                out, errors = child.communicate(timeout=120)
                assert (out, child.returncode) == (said, 0 if said else 1), errors
        assert uav.queue("Commands").get(timeout=1).value.altitude_m == 120 and len(uav.queue("Commands")) == 0


def test_a_folder_without_keys_is_a_wrong_configuration(idl, one_network, tmp_path):
    node = rabit.Node("uav1", security={"keys": str(tmp_path)}, **one_network)
    with pytest.raises(rabit.ConfigError, match=str(tmp_path)):
        node.start()


@pytest.mark.skipif(not PLAIN, reason="RABIT_PLAIN is not set")
def test_a_topic_of_ros_is_read_and_written(network, tmp_path):
    file = tmp_path / "string.idl"
    file.write_text(STRING)
    string = rabit.load_idl(file).std_msgs.msg.String
    common = {"type": string, "names": "ros2"}
    foreign = [{"subscribe": "chatter", "as": "Chatter", **common}, {"subscribe": "all", "as": "All", "each": "queue", **common},
               {"publish": "Words", "topic": "words", **common}]
    plain = subprocess.Popen(
        [PLAIN, str(network["domain"]), "write:rt/chatter:string:reliable:volatile", "write:rt/all:string:reliable:volatile",
         "read:rt/words:string:reliable:volatile"],
        env={**os.environ, "CYCLONEDDS_URI": LOOPBACK}, stdout=subprocess.PIPE, text=True)
    try:
        with rabit.Node("bridge", foreign=foreign, **network) as node:
            first = node.subscribe("Chatter", string).get(timeout=240)
            numbers = [int(node.queue("All").get(timeout=240).value.data.split()[-1]) for _ in range(5)]
            assert numbers == list(range(numbers[0], numbers[0] + 5)) and first.value.data
            written = iter(range(100000))
            os.set_blocking(plain.stdout.fileno(), False)
            wait_until(lambda: (node.post("Words", string(data=f"word {next(written)}")), plain.stdout.readline())[1], 240)
    finally:
        plain.terminate()
        plain.wait(120)
