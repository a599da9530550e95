"""Instructions of whole processes for one message, counted by callgrind: a figure that hardly depends on how busy the
machine is. Each pair of processes runs twice, with few and with more round trips; the difference is what the messages
cost, for start and end are in both."""

import re
import shutil

from contestants import harness, result

FEW, MORE = 200, 1200
# Only keeps a broken run from hanging: callgrind makes everything fifty times as slow.
LIMIT_S = 300
END_S = 60


def available():
    return shutil.which("valgrind") is not None


def collected(process):
    text = "\n".join(line for _, line in process.lines)
    return int(re.search(r"Collected : (\d+)", text).group(1))


def of_a_run(programs, contestant, transport, options):
    """Instructions of all threads of both processes, from their start to their end, and the round trips that were not
    over within the patience of who asks, which is a second."""
    def start(processes, role):
        return processes.start(["valgrind", "--tool=callgrind", "--fair-sched=try", "--callgrind-out-file=/dev/null",
                                *programs.argv(contestant, transport, role, options)])
    with harness.Processes() as processes:
        server, client = start(processes, "pong"), start(processes, "ping")
        measured = result(client, limit_s=LIMIT_S)
        client.exit_code(END_S)
        result(server, limit_s=LIMIT_S)
        server.terminate(END_S)
        return collected(client) + collected(server), measured["lost"]


def of_a_message(programs, contestant, transport, options):
    """Instructions of both sides together; a round trip is two messages."""
    (few, lost_few), (more, lost_more) = (of_a_run(programs, contestant, transport, {**options, "count": count})
                                          for count in (FEW, MORE))
    return {"instructions": (more - few) / (MORE - FEW) / 2, "lost": lost_few + lost_more}
