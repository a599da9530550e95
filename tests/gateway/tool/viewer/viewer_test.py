#!/usr/bin/env python3
"""A fleet in a viewer that speaks the Foxglove WebSocket protocol: values as they are and as panels know them, a State at once,
and an aircraft that comes back in the same channels.

Usage: viewer_test.py RABIT UAV TRANSPORT VIEWER"""

import json
import pathlib
import signal
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "integration"))
import harness  # noqa: E402

LIMIT_S = 300  # only keeps a broken test from hanging
SWARM = harness.ROOT / "examples/swarm"
TOPICS = ["uav1/Pose", "uav1/Pose/LocationFix", "uav1/Health", "uav1/MissionState/Log"]


def wait_value(viewer, topic, since=0.0):
    """Its next value, and when it came by the time that it carries, UTC in seconds."""
    start = f"value {topic} "
    when, text = viewer.wait_for(lambda line: line.startswith(start) and line, LIMIT_S, since)
    stamp, value = text[len(start):].split(" ", 1)
    return when, int(stamp) * 1e-9, json.loads(value)


def channel_of(viewer, topic):
    _, text = viewer.wait_for(lambda line: line.startswith("channel ") and line.split()[2] == topic and line, LIMIT_S)
    return text.split()[1:]


def main():
    rabit, uav, transport, program = sys.argv[1:]
    harness.enter_namespace()
    network = ["--domain", harness.domain(), "--transport", transport]
    with harness.Processes() as processes:
        def fly():
            return processes.start([uav, "--config", SWARM / "uav.yaml", "--node", "uav1", *network])

        aircraft = fly()
        server = processes.start([rabit, "foxglove", "--config", SWARM / "foxglove.yaml", "--port", "0", *network,
                                  "--interface", "127.0.0.1"])
        _, url = server.wait_for(lambda line: line.startswith("ws://") and line, LIMIT_S)
        viewer = processes.start(["node", program, url, *TOPICS])

        viewer.wait_for(lambda line: line == "server rabit", LIMIT_S)
        assert channel_of(viewer, "uav1/Pose")[2:] == ["cdr", "Uav::Pose"]
        assert channel_of(viewer, "uav1/Pose/LocationFix")[2:] == ["json", "foxglove.LocationFix"]
        _, stamp, pose = wait_value(viewer, "uav1/Pose")
        assert abs(stamp - time.time()) < LIMIT_S, stamp
        _, _, place = wait_value(viewer, "uav1/Pose/LocationFix")
        assert abs(place["latitude"] - pose["latitude_deg"]) < 0.1, (place, pose)
        assert place["frame_id"] == "uav1" and abs(place["timestamp"]["sec"] - time.time()) < LIMIT_S, place
        assert wait_value(viewer, "uav1/MissionState/Log")[2]["name"] == "uav1"

        # A State was posted earlier, and is there at once.
        late = processes.start(["node", program, url, "uav1/Health"])
        wait_value(late, "uav1/Health")

        aircraft.kill()
        killed = time.monotonic()
        fly()
        wait_value(viewer, "uav1/Pose", wait_value(viewer, "uav1/Pose", killed + 1)[0])
        channels = [line for _, line in viewer.lines if line.startswith("channel ") and line.split()[2] == "uav1/Pose"]
        assert len(channels) == 1, channels
        assert not any(line.startswith(("gone", "error")) for _, line in viewer.lines)

        server.signal(signal.SIGINT)
        assert server.exit_code(LIMIT_S) == 0, server.lines[-5:]
    print("seen")


if __name__ == "__main__":
    main()
