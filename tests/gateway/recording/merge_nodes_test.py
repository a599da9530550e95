#!/usr/bin/env python3
"""Three nodes that record themselves, one of them killed hard and started again; their recordings on one time line, what
they knew of each other, and what the packages that Foxglove reads with make of it.

Usage: merge_nodes_test.py RABIT SENSOR DISPLAY TRANSPORT STOCK_READER_TEST WORK_DIRECTORY"""

import itertools
import json
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
    return subprocess.run([str(word) for word in argv], capture_output=True, text=True, timeout=LIMIT, check=False)


def lines_of(done):
    return [json.loads(line) for line in done.stdout.splitlines()]


class Fleet:
    """The nodes, their configurations and recordings in one folder."""

    def __init__(self, folder, transport, programs):
        self.folder = folder
        self.programs = programs
        self.running = {}
        common = f"domain: {harness.domain()}\ninterfaces: [lo]\ntransport: {transport}\n"
        for node, rules in {
                "sensor": "publish:\n  - {message: Reading, type: TwoNodes::Reading}\n"
                          "accept:\n  - {queue: Sensor, types: [TwoNodes::Calibration]}\n",
                "display": "subscribe:\n  - {message: Reading, type: TwoNodes::Reading, from: [sensor]}\n",
                "display2": "subscribe:\n  - {message: Reading, type: TwoNodes::Reading, from: [sensor]}\n"}.items():
            (folder / f"{node}.yaml").write_text(
                f"node: {node}\n{common}{rules}record: {{folder: {folder}/rec, free: 0B, split_time: 4s}}\n")

    def start(self, node):
        self.running[node] = harness.Process([self.programs[node], "--config", self.folder / f"{node}.yaml"])

    def wait_for(self, node, count):
        """Until the node has shown that many readings since it was started."""
        seen = itertools.count(1)
        self.running[node].wait_for(lambda text: text.startswith("reading") and next(seen) >= count, LIMIT)

    def shown(self, node):
        return sum(text.startswith("reading") for _, text in self.running[node].lines)

    def stop(self, node, how):
        process = self.running.pop(node)
        process.signal(how)
        process.exit_code(LIMIT)


def fly(fleet):
    for node in ("sensor", "display", "display2"):
        fleet.start(node)
    fleet.wait_for("display", 8)
    fleet.wait_for("display2", 8)
    fleet.stop("sensor", signal.SIGKILL)
    shown = fleet.shown("display")
    fleet.start("sensor")
    fleet.wait_for("display", shown + 8)
    fleet.stop("display2", signal.SIGKILL)
    for node in ("display", "sensor"):
        fleet.stop(node, signal.SIGTERM)


def check_merge(rabit, folder):
    files = sorted((folder / "rec").glob("*.mcap"))
    merged = folder / "merged.mcap"
    done = run(rabit, "merge", "--json", merged, *files)
    assert done.returncode == 0, done
    about = json.loads(done.stdout)
    recordings = {(one["node"], one["life"]): one for one in about["recordings"]}
    assert set(recordings) == {("sensor", 1), ("sensor", 2), ("display", 1), ("display2", 1)}, about
    assert 0 < about["worst_uncertainty_s"] < LIMIT, about
    first, second = recordings["sensor", 1], recordings["sensor", 2]
    assert int(first["end_ns"]) < int(second["begin_ns"]) and first["incarnation"] != second["incarnation"], about
    assert recordings["display", 1]["files"] > 1, about
    again = run(rabit, "merge", merged, *files)
    assert again.returncode == 1 and "merged.mcap" in again.stderr, again
    assert "is merged already" in run(rabit, "merge", folder / "x.mcap", merged).stderr
    return merged, recordings


def check_info(rabit, merged):
    done = run(rabit, "info", "--json", merged)
    about = json.loads(done.stdout)
    # If two threads post at the same time, the recorder sees one post and counts the other. These may be managers' states,
    # and info reports them.
    assert all(topic.endswith("/Recorder/Managers") for topic in about["lost"]), done
    assert done.returncode == (1 if about["lost"] else 0) and about["ended"], done
    topics = [row["topic"] for row in about["topics"]]
    assert topics.count("sensor/Reading") == 2, topics  # two lives
    for topic in ("display/Recorder/knew/sensor/Reading", "display2/Recorder/knew/sensor/Reading",
                  "display/Recorder/Clocks", "display/Recorder/TimeLine"):
        assert topic in topics, (topic, topics)
    return about


def check_knew(rabit, merged, recordings, about):
    rows = lines_of(run(rabit, "knew", "--json", merged))
    assert {(row["knower"], row["node"], row["message"]) for row in rows} >= {
        ("display", "sensor", "Reading"), ("display2", "sensor", "Reading")}, rows
    # The middle of the second incarnation of the sensor.
    second = recordings["sensor", 2]
    moment = f"{((int(second['begin_ns']) + int(second['end_ns'])) / 2 - int(about['begin_ns'])) / 1e9:.6f}"
    known = lines_of(run(rabit, "knew", "--json", merged, "display", "sensor/Reading", "--at", moment))
    own = lines_of(run(rabit, "knew", "--json", merged, "sensor", "sensor/Reading", "--at", moment))
    assert len(known) == len(own) == 1, (known, own)
    assert known[0]["incarnation"] == own[0]["incarnation"] == second["incarnation"], (known, own)
    assert 0 < known[0]["age_s"] and 0 < known[0]["uncertainty_s"] < LIMIT, known
    # The known value is the one that the sensor posted then.
    assert own[0]["value"]["number"] - known[0]["value"]["number"] in (0, 1), (known, own)
    if own[0]["value"]["number"] == known[0]["value"]["number"]:
        assert abs(known[0]["age_s"] - own[0]["age_s"]) < known[0]["uncertainty_s"] + 0.05, (known, own)
    text = run(rabit, "knew", merged, "display", "sensor/Reading", "--at", moment)
    assert text.stdout.startswith("display knew sensor/Reading (life 2)  age "), text
    late = run(rabit, "knew", merged, "display2", "sensor/Reading", "--at", "100000")
    assert late.returncode == 1 and " is from " in late.stderr, late
    plot = merged.parent / "ages.svg"
    done = run(rabit, "knew", merged, "--plot", plot)
    assert done.returncode == 0 and "what display knew of sensor" in plot.read_text(), done


def check_stock(merged, reader, work):
    """The reader test copies what it reads by a program that is given."""
    copy = merged.parent / "copy.sh"
    copy.write_text(f"#!/bin/sh\ncp '{merged}' \"$1/merged.mcap\"\n")
    copy.chmod(0o755)
    done = run(reader, "reads_a_merged_file", copy, work)
    assert done.returncode in (0, harness.SKIPPED), done
    if done.returncode == harness.SKIPPED:
        print(done.stdout, end="")


def main():
    rabit, sensor, display, transport, reader, work = sys.argv[1:7]
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        fleet = Fleet(folder, transport, {"sensor": sensor, "display": display, "display2": display})
        fly(fleet)
        merged, recordings = check_merge(rabit, folder)
        check_knew(rabit, merged, recordings, check_info(rabit, merged))
        check_stock(merged, reader, work)
    print("ok")


if __name__ == "__main__":
    main()
