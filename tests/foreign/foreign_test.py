#!/usr/bin/env python3
"""Nodes on each backend beside plain programs of each vendor, with the names, types and QoS of ROS 2 and of PX4's agent:
read and written, started in either order, silent, restarted, and what is said when nothing comes.

Usage: foreign_test.py NODE TRANSPORT,... PLAIN_PROGRAM..."""

import pathlib
import re
import signal
import sys
import tempfile
import threading

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300

CONFIG = """
node: uav1
domain: {domain}
transport: {transport}
interfaces: [127.0.0.1]
foreign:
  - {{subscribe: rt/chatter, type: std_msgs::msg::String, as: Chatter, names: ros2, each: queue}}
  - {{subscribe: /latched, type: std_msgs::msg::String, as: Latched, names: ros2}}
  - {{subscribe: rt/fmu/out/setpoint, type: px4_msgs::msg::TrajectorySetpoint, as: Autopilot/Setpoint, names: ros2,
     stale_after: 700ms}}
  - {{publish: Setpoint, topic: rt/fmu/in/trajectory_setpoint, type: px4_msgs::msg::TrajectorySetpoint, names: ros2,
     reliability: best_effort}}
  - {{publish: Words, topic: words, type: std_msgs::msg::String, names: ros2}}
  - {{publish: Orders, topic: orders, type: std_msgs::msg::String, names: ros2, each: queue}}
  - {{subscribe: rt/loud, type: std_msgs::msg::String, as: Loud, names: ros2, reliability: reliable}}
  - {{subscribe: rt/other, type: std_msgs::msg::String, as: Other, names: ros2}}
  - {{subscribe: rt/fmu/out/vehicle_status, type: std_msgs::msg::String, as: Status, names: ros2}}
"""
# The names and QoS of rmw and of PX4's agent.
TOPICS = ["write:rt/chatter:string:reliable:volatile",
          "write:rt/latched:string:reliable:transient_local",
          "write:rt/fmu/out/setpoint:setpoint:best_effort:transient_local",
          "read:rt/fmu/in/trajectory_setpoint:setpoint:best_effort:volatile",
          "read:rt/words:string:reliable:volatile",
          "read:rt/orders:string:reliable:volatile",
          "write:rt/loud:string:best_effort:volatile",
          "write:rt/other:setpoint:reliable:volatile",
          "write:rt/fmu/out/vehicle_status_v1:string:best_effort:transient_local"]
# Of std_msgs/msg/String, as `ros2 topic info -v` shows it.
HASH_OF_STRING = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
# The node's reasons for the topics that do not come.
REASONS = ["foreign rt/loud LOST a program that writes `rt/loud` is best effort, this node asks for reliable",
           "foreign rt/other LOST a program writes `rt/other` as `px4_msgs::msg::dds_::TrajectorySetpoint_`, this node "
           "reads it as `std_msgs::msg::dds_::String_`",
           "foreign rt/fmu/out/vehicle_status LOST no program writes `rt/fmu/out/vehicle_status` in domain {domain}; "
           "did you mean `rt/fmu/out/vehicle_status_v1`?"]
CYCLONE = """<CycloneDDS><Domain><General><Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces></General>
<Discovery><LeaseDuration>3s</LeaseDuration><ParticipantIndex>auto</ParticipantIndex>
<MaxAutoParticipantIndex>50</MaxAutoParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain>
</CycloneDDS>"""
# The guard cuts leases to five minutes. Within this time only the goodbye of a program can tell that it has ended.
GOODBYE_S = 120
CYCLONE_OF_LONG_LEASE = CYCLONE.replace("<LeaseDuration>3s<", "<LeaseDuration>1hr<")


class Row:
    """One backend beside programs of one vendor, in a domain of their own."""

    def __init__(self, node, transport, plain, domain, folder):
        self.node, self.transport, self.plain, self.domain = node, transport, plain, domain
        self.config = folder / f"{domain}.yaml"
        self.config.write_text(CONFIG.format(domain=domain, transport=transport))
        self.failure = None

    def run(self):
        try:
            with harness.Processes() as self.processes:
                self.exchange()
        except Exception as error:  # the others go on
            self.failure = f"{self.transport} beside {pathlib.Path(self.plain).name}: {error}"

    def start_node(self):
        return self.processes.start([self.node, self.config])

    def start_plain(self):
        return self.processes.start([self.plain, self.domain, *TOPICS], {"CYCLONEDDS_URI": CYCLONE_OF_LONG_LEASE})

    def wait(self, process, pattern, since=0.0, limit=LIMIT_S):
        try:
            return process.wait_for(re.compile(pattern).fullmatch, limit, since)
        except AssertionError as error:
            raise AssertionError(f"no `{pattern}`: {error}") from error

    def all_flow(self, node, plain, since):
        """That all that fits goes in both directions. The queue gets each and every number."""
        when, first = self.wait(node, r"queue Chatter (\d+)", since)
        first = int(first.group(1))
        self.wait(node, f"queue Chatter {first + 20}", since)
        values = [int(text.split()[2]) for at, text in node.lines if at >= when and text.startswith("queue Chatter")]
        assert values[:21] == list(range(first, first + 21)), values[:21]
        # Its age since it arrived: below a second. It is written all the time, so that one is shown soon enough.
        self.wait(node, r"message Latched \d+ (0|0\.\d+|\d\S*e-\d+)", since)
        self.wait(node, r"message Autopilot/Setpoint \d+ .*", since)
        self.wait(plain, r"got rt/fmu/in/trajectory_setpoint \d+ -5", since)
        self.wait(plain, r"got rt/words \d+", since)
        when, first = self.wait(plain, r"got rt/orders (\d+)", since)
        first = int(first.group(1))
        self.wait(plain, f"got rt/orders {first + 20}", since)
        values = [int(text.split()[2]) for at, text in plain.lines if at >= when and text.startswith("got rt/orders")]
        assert values[:21] == list(range(first, first + 21)), values[:21]

    @staticmethod
    def nothing_is_dropped(node):
        """That the node took all datagrams of the programs for sound, those with which one ends included."""
        dropped = [text for _, text in node.lines if "no sound RTPS message" in text]
        assert not dropped, dropped

    def exchange(self):
        node = self.start_node()
        self.wait(node, r"foreign rt/chatter LOST no program writes .*")
        plain = self.start_plain()
        self.all_flow(node, plain, 0.0)
        if "cyclone" in pathlib.Path(self.plain).name:  # the other program does not show it
            self.wait(plain, f"announced rt/words rabit=1;typehash={HASH_OF_STRING};")
        for reason in REASONS:
            self.wait(node, re.escape(reason.format(domain=self.domain)))

        stopped, _ = self.wait(node, "foreign rt/fmu/out/setpoint UP")
        plain.signal(signal.SIGSTOP)
        stale, _ = self.wait(node, "foreign rt/fmu/out/setpoint STALE nothing newer than 0.7 s", stopped)
        plain.signal(signal.SIGCONT)
        again, _ = self.wait(node, "foreign rt/fmu/out/setpoint UP", stale)

        assert plain.terminate() == 0
        gone, _ = self.wait(node, "foreign rt/chatter LOST no program writes .*", again, GOODBYE_S)
        self.all_flow(node, self.start_plain(), gone)

        # The node starts while the programs run.
        assert node.terminate() == 0, node.lines[-5:]
        self.nothing_is_dropped(node)
        other = self.start_plain()
        node = self.start_node()
        self.wait(node, r"message Latched \d+ .*")
        self.wait(node, r"queue Chatter \d+")
        self.wait(other, r"got rt/fmu/in/trajectory_setpoint \d+ -5")
        assert node.terminate() == 0, node.lines[-5:]
        self.nothing_is_dropped(node)


def main():
    node, transports, plain = sys.argv[1], sys.argv[2].split(","), sys.argv[3:]
    harness.enter_namespace()
    with tempfile.TemporaryDirectory(prefix="rabit_foreign_") as folder:
        pairs = [(transport, program) for transport in transports for program in plain]
        rows = [Row(node, transport, program, (harness.domain() + 5 * i) % 200, pathlib.Path(folder))
                for i, (transport, program) in enumerate(pairs)]
        threads = [threading.Thread(target=row.run) for row in rows]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    failures = [row.failure for row in rows if row.failure]
    print("\n".join(failures) or f"{len(rows)} pairs")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
