"""Nodes that record themselves, and a ground station that requests what it missed. For the tests beside this file."""

import json
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integration"))
import field  # noqa: E402,F401
import harness  # noqa: E402,F401

MESSAGES = ["Sample", "Finding"]
# Only keeps a broken program from hanging.
LIMIT = 300


class Fleet:
    def __init__(self, ground, programs, transport, folder):
        self.ground = ground
        self.programs = pathlib.Path(programs)
        self.transport = transport
        self.folder = pathlib.Path(folder)
        self.aircraft = [node for node in ground.nodes if node != "ground"]

    def network(self, node):
        """The lines of its configuration."""
        return f"interfaces: [{self.ground.address(node)}]\ntransport: {self.transport}\n"

    def write(self, node, more=""):
        common = (f"node: {node}\n{self.network(node)}"
                  f"state_dir: {self.folder}/state\n{more}")
        record = f"record:\n  folder: {self.recordings(node)}\n  free: 0B\n  split_time: 20s\n"
        if node == "ground":
            common += ("subscribe:\n" + "".join(f"  - {{message: {message}, type: BackfillTest::Sample}}\n"
                                                for message in MESSAGES))
            record += f"  backfill: [{', '.join(MESSAGES)}]\n"
        else:
            common += ("publish:\n  - {message: Sample, type: BackfillTest::Sample, qos: telemetry}\n"
                       "  - {message: Finding, type: BackfillTest::Sample}\n"
                       "accept:\n  - {queue: Commands, types: [BackfillTest::Command]}\n"
                       f"fetch: {{folder: {self.files(node)}, from: [\"*\"]}}\n")
            self.files(node).mkdir(parents=True, exist_ok=True)
        (self.folder / "state").mkdir(exist_ok=True)
        (self.folder / f"{node}.yaml").write_text(common + record)

    def recordings(self, node):
        return self.folder / "recordings" / node

    def files(self, node):
        return self.folder / "files" / node

    def start(self, node, *options):
        more = ["--commands", *self.aircraft] if node == "ground" else options
        return self.ground.start(node, [self.programs / "backfill_node", "--config", self.folder / f"{node}.yaml", *more])

    def judge(self, node):
        done = subprocess.run([self.programs / "backfill_judge", self.recordings(node), node, self.recordings("ground"),
                               "ground", *MESSAGES], capture_output=True, text=True, check=True)
        return [json.loads(line) for line in done.stdout.splitlines()]

    def posted(self, node):
        """Samples that the node's own recording has."""
        return self.judge(node)[0]["posted"]

    def until_posted(self, node, posts):
        harness.until(lambda: self.posted(node) >= posts)

    def wait_until_whole(self, nodes, posts=0):
        """Until so many samples were posted and nothing is missing in the recording of the ground station. Returns the
        figures."""
        figures = []

        def is_whole():
            figures[:] = [row for node in nodes for row in self.judge(node)]
            return not any(row["missing"] for row in figures) and all(
                row["posted"] >= posts for row in figures if row["message"] == "Sample")

        try:
            harness.until(is_whole)
        except AssertionError as error:
            raise AssertionError(f"still missing: {figures}") from error
        return figures

    def wait_until_whole_so_far(self, nodes, seconds):
        """Until nothing is missing in the recording of the ground station of the posts that were there at the beginning, while
        the nodes go on posting. Returns the figures. Fails after so many seconds."""
        posts = {(node, row["message"]): row["posted"] for node in nodes for row in self.judge(node)}
        figures = []

        def is_whole():
            figures[:] = [{**row, "node": node} for node in nodes for row in self.judge(node)]
            # Posts that come meanwhile are on their way, live.
            return all(row["oldest_missing"] >= posts[row["node"], row["message"]] for row in figures)

        try:
            harness.until(is_whole, seconds)
        except AssertionError as error:
            raise AssertionError(f"still missing: {figures}") from error
        return figures
