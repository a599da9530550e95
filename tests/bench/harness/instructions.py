"""Instructions of whole processes for one message, counted by callgrind: a figure that hardly depends on how busy the
machine is. Each pair of processes runs twice, with few and with more round trips; the difference is what the messages
cost, for start and end are in both."""

import re
import shutil

from contestants import harness, result

FEW, MORE = 200, 1200
END_S = 60


def available():
    return shutil.which("valgrind") is not None


def collected(process):
    text = "\n".join(line for _, line in process.lines)
    return int(re.search(r"Collected : (\d+)", text).group(1))


def of_a_run(programs, contestant, transport, options):
    """Instructions of all threads of both processes, from their start to their end."""
    def start(processes, role):
        return processes.start(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
                                *programs.argv(contestant, transport, role, options)])
    with harness.Processes() as processes:
        server, client = start(processes, "pong"), start(processes, "ping")
        measured = result(client)
        if measured["lost"]:
            raise AssertionError(f"{measured['lost']} round trips were lost: {client.argv}")
        client.exit_code(END_S)
        result(server)
        server.terminate(END_S)
        return collected(client) + collected(server)


def of_a_message(programs, contestant, transport, options):
    """Instructions of both sides together; a round trip is two messages."""
    few, more = (of_a_run(programs, contestant, transport, {**options, "count": count}) for count in (FEW, MORE))
    return (more - few) / (MORE - FEW) / 2
