"""What a person reads on the console of real nodes that do not come together: a lonely one, one whose interface is
missing, two of one name, and two that were built with two versions of a type.

Usage: node_problems_test.py BIN ROOT TRANSPORT
"""

import pathlib
import re
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
INTERFACE = "127.0.0.1"


class Case:
    def __init__(self, programs, root, folder, transport):
        self.programs, self.transport, self.folder = programs, transport, folder
        for name in "sensor", "display":
            text = (root / f"examples/two_nodes/{name}.yaml").read_text()
            (folder / f"{name}.yaml").write_text(text + f"interfaces: [{INTERFACE}]\n")

    def start(self, processes, program, name):
        return processes.start([self.programs / program, "--config", self.folder / f"{name}.yaml", "--transport",
                                self.transport, "--domain", harness.domain()])


def a_lonely_node_says_what_it_can_know(case):
    with harness.Processes() as processes:
        sensor = case.start(processes, "sensor", "sensor")
        said = re.compile(f"gateway: network: nobody heard in domain {harness.domain()} on {INTERFACE} for 10 s; "
                          r"multicast goes out; peers: none \(docs/how_to/connect\.md\)$")
        sensor.wait_for(said.search, LIMIT_S)
        case.start(processes, "display", "display")
        sensor.wait_for(re.compile("no longer: network: nobody heard").search, LIMIT_S)


def a_missing_interface_is_named_before_anything_times_out(case):
    config = case.folder / "elsewhere.yaml"
    config.write_text((case.folder / "sensor.yaml").read_text().replace(INTERFACE, "nosuch0"))
    with harness.Processes() as processes:
        sensor = case.start(processes, "sensor", "elsewhere")
        sensor.wait_for(re.compile("gateway: interfaces nosuch0: the interface nosuch0 does not exist").search, LIMIT_S)
        assert not any("timed out" in text for _, text in sensor.lines), sensor.lines


def two_nodes_of_one_name_name_both_processes(case):
    with harness.Processes() as processes:
        first, second = (case.start(processes, "sensor", "sensor") for _ in range(2))
        display = case.start(processes, "display", "display")
        for one, other in (first, second), (second, first):
            one.wait_for(re.compile("another live node has the name of this one; this one is on host "
                                    f".*, process {one.pid}, the other on host .*, process {other.pid}$").search, LIMIT_S)
        pids = f"(({first.pid}; .*, process {second.pid})|({second.pid}; .*, process {first.pid}))"
        display.wait_for(re.compile(f"two live nodes have this name; one is on host .*, process {pids}$").search, LIMIT_S)


def two_versions_of_a_type_are_named(case):
    with harness.Processes() as processes:
        case.start(processes, "sensor", "sensor")
        display = case.start(processes, "other_version_display", "display")
        display.wait_for(re.compile("subscribe Reading, sensor: sensor was built with another definition of "
                                    "`TwoNodes::Reading`$").search, LIMIT_S)
        if any(text.startswith("reading ") for _, text in display.lines):
            sys.exit("FAILED: a reading of another version was shown")


def main():
    programs, root, transport = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    harness.enter_namespace()
    for test in a_lonely_node_says_what_it_can_know, a_missing_interface_is_named_before_anything_times_out, \
            two_nodes_of_one_name_name_both_processes, two_versions_of_a_type_are_named:
        with tempfile.TemporaryDirectory(prefix="rabit_node_problems_") as folder:
            test(Case(programs, root, pathlib.Path(folder), transport))
        print(f"ok: {test.__name__} over {transport}")


if __name__ == "__main__":
    main()
