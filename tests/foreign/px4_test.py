#!/usr/bin/env python3
"""A PX4 that speaks DDS is an aircraft of the fleet, with either backend: its position is `uav1/Pose` elsewhere, a Goto moves it,
and what it is not ready for, and what it refuses, is said with the reason.

Usage: px4_test.py UAV TRANSPORT,... SIMULATED_PX4 RABIT"""

import json
import pathlib
import re
import sys
import tempfile
import threading

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))
import harness  # noqa: E402
from foreign_test import CYCLONE, LIMIT_S  # noqa: E402


def goto(altitude_m, latitude_deg=47.399):
    return json.dumps({"id": 1, "reply_to": "", "latitude_deg": latitude_deg, "longitude_deg": 8.5456,
                       "altitude_m": altitude_m, "speed_mps": 20})


def fly(uav, transport, px4, rabit, domain, folder):
    """One flight, and its end."""
    # Publishes the autopilot's flight mode too, which usually stays within the aircraft.
    config = folder / f"{domain}.yaml"
    config.write_text((harness.ROOT / "examples/swarm/uav.yaml").read_text().replace(
        "publish:\n", "publish:\n  - {message: FlightMode, type: Uav::FlightMode}\n"))
    network = ["--domain", domain, "--interface", "127.0.0.1"]
    with harness.Processes() as processes:
        aircraft = processes.start([uav, "--config", config, "--px4", "dds",
                                    "--transport", transport, "--domain", domain])
        plain = processes.start([px4, domain], {"CYCLONEDDS_URI": CYCLONE})
        poses = processes.start([rabit, "echo", "uav1/Pose", "--field", "latitude_deg", "--wait", LIMIT_S, *network])
        poses.wait_for(lambda text: text.startswith("47.3977"), LIMIT_S)

        def command(altitude_m):
            processes.start([rabit, "send", "uav1/MissionControl", "Uav::Goto", goto(altitude_m), "--wait", LIMIT_S,
                             *network])

        modes = processes.start([rabit, "echo", "uav1/FlightMode", "--json", "--wait", LIMIT_S, *network])
        modes.wait_for(lambda text: '"not_ready":"PX4 is not armed"' in text, LIMIT_S)
        plain.tell("arm")
        modes.wait_for(lambda text: '"not_ready":""' in text, LIMIT_S)
        command(520)
        plain.wait_for(re.compile(r"command 192 47\.3990 8\.5456 520 from 191: 0").fullmatch, LIMIT_S)
        poses.wait_for(lambda text: text.startswith("47.399"), LIMIT_S)

        command(440)
        plain.wait_for(re.compile(r"command 192 .* 440 from 191: 2").fullmatch, LIMIT_S)
        modes.wait_for(lambda text: '"not_ready":"PX4 refused the point: denied"' in text, LIMIT_S)

        plain.kill()
        aircraft.wait_for(lambda text: "rt/fmu/out/vehicle_status" in text, LIMIT_S)
        assert aircraft.terminate() == 0, aircraft.lines[-5:]


def main():
    uav, transports, px4, rabit = sys.argv[1], sys.argv[2].split(","), sys.argv[3], sys.argv[4]
    harness.enter_namespace()
    with tempfile.TemporaryDirectory(prefix="rabit_px4_") as folder:
        failures = []

        def run(transport, domain):
            try:
                fly(uav, transport, px4, rabit, domain, pathlib.Path(folder))
            except Exception as error:  # the others go on
                failures.append(f"{transport}: {error}")

        threads = [threading.Thread(target=run, args=(transport, (harness.domain() + 5 * i) % 200))
                   for i, transport in enumerate(transports)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    print("\n".join(failures) or f"flown over {' and '.join(transports)}")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
