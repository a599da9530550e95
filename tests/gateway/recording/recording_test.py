#!/usr/bin/env python3
"""A node that records itself and is killed hard, with somebody who records it from outside, and what is in the files.

Usage: recording_test.py RABIT SENSOR"""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integration"))
import harness  # noqa: E402

# Only keeps a broken program from hanging.
LIMIT = 300


def run(*argv):
    return subprocess.run(argv, capture_output=True, text=True, timeout=LIMIT, check=False)


def info(rabit, file):
    done = run(rabit, "info", "--json", str(file))
    return json.loads(done.stdout), done.returncode


def count(about, topic):
    return next((row["messages"] for row in about["topics"] if row["topic"] == topic), 0)


def only_file(folder):
    files = sorted(folder.glob("*.mcap"))
    assert len(files) == 1, files
    return files[0]


def main():
    harness.enter_namespace()
    rabit, sensor = sys.argv[1:3]
    domain = harness.domain()
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        config = folder / "sensor.yaml"
        config.write_text(f"node: sensor\ndomain: {domain}\ninterfaces: [lo]\n"
                          "publish:\n  - {message: Reading, type: TwoNodes::Reading}\n"
                          "accept:\n  - {queue: Sensor, types: [TwoNodes::Calibration]}\n"
                          f"record: {{folder: {folder}/inside, free: 0B}}\n")
        network = ["--interface", "lo", "--domain", str(domain)]
        with subprocess.Popen([sensor, "--config", str(config)], stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as node:
            try:
                outside = subprocess.Popen([rabit, "record", *network, "--to", f"{folder}/outside", "--wait", "60",
                                            "sensor/Reading"], stdout=subprocess.PIPE, text=True)
                sent = run(rabit, "send", *network, "--wait", "60", "sensor/Sensor", "TwoNodes::Calibration",
                           '{"offset_celsius": 1}')
                assert sent.stdout == "delivered\n", sent
                def both_have_readings():
                    files = [*folder.glob("inside/*.mcap"), *folder.glob("outside/*.mcap")]
                    return len(files) == 2 and all(count(info(rabit, file)[0], "sensor/Reading") >= 3 for file in files)

                harness.until(both_have_readings)
            finally:
                node.send_signal(signal.SIGKILL)
            outside.send_signal(signal.SIGINT)
            said, _ = outside.communicate(timeout=LIMIT)
            assert outside.returncode == 0, said

        inside = only_file(folder / "inside")
        before, code = info(rabit, inside)
        assert code == 1 and not before["ended"], before
        assert "the file was not ended in order" in before["problems"][0], before
        done = run(rabit, "recover", str(inside), "--to", f"{folder}/whole.mcap")
        assert done.returncode == 0, done
        about, code = info(rabit, folder / "whole.mcap")
        assert code == 0 and about["ended"] and about["node"] == "sensor", about
        assert count(about, "sensor/Reading") == count(before, "sensor/Reading") >= 3, about
        received = [row for row in about["topics"] if row["topic"].startswith("sensor/Recorder/received/rabit.")]
        assert [row["type"] for row in received] == ["TwoNodes::Calibration"], about
        assert count(about, "sensor/Gateway/Fleet") > 0 and count(about, "sensor/Recorder/Managers") > 0, about

        seen, code = info(rabit, only_file(folder / "outside"))
        assert code == 0 and seen["ended"], seen
        assert count(seen, "sensor/Reading") >= 3, seen
        assert os.path.basename(only_file(folder / "outside")) in said, said
    print("ok")


if __name__ == "__main__":
    main()
