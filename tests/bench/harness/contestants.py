"""Who is measured against whom, and how one run of a pair of processes goes."""

import json
import pathlib
import sys
import time

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / "integration"), str(pathlib.Path(__file__).resolve().parents[2])]
import harness  # noqa: E402
import quiet  # noqa: E402,F401  for the programs of this folder

# Only keeps a broken run from hanging.
LIMIT_S = 300

RAW_WORKER = "raw, worker"      # the listener hands over to a thread of the application
RAW_LISTENER = "raw, listener"  # the application does its work in the vendor's listener
RAW_THREADS = "raw, two threads"  # and who sends hands over to a thread that writes, as with Rabit
NODE = "Rabit"                  # manager to manager, through two gateways
LOCAL = "one process"           # manager to manager, without a gateway


class Contestants:
    """The programs of one build."""

    def __init__(self, folder, domain):
        self.folder = pathlib.Path(folder)
        self.domain = domain
        self.transports = [name for name in ("fastdds", "cyclonedds") if (self.folder / f"bench_raw_{name}").exists()]

    def argv(self, contestant, transport, role, options):
        if contestant in (NODE, LOCAL):
            argv = [self.folder / "bench_node", "--transport", transport or self.transports[0]]
        else:
            argv = [self.folder / f"bench_raw_{transport}"]
            if contestant == RAW_LISTENER:
                argv.append("--in-listener")
            if contestant == RAW_THREADS:
                argv.append("--writer-thread")
        argv += ["--role", role, "--domain", self.domain]
        for name, value in options.items():
            argv += [f"--{name}", value]
        return argv

    def pair(self, contestant, transport, roles, options):
        """Runs the first role until it ends, against the second one. Returns what each has measured; without a second
        role both are in one process."""
        with harness.Processes() as processes:
            if roles[1] is None:
                both = processes.start(self.argv(contestant, transport, roles[0], options))
                results = [result(both), result(both, 1)]
                both.exit_code(LIMIT_S)
                # The receiver is complete before the sender has the last answer.
                return {"client": results[1], "server": results[0]} if "p50_ns" in results[1] else \
                       {"client": results[0], "server": results[1]}
            server = processes.start(self.argv(contestant, transport, roles[1], options))
            client = processes.start(self.argv(contestant, transport, roles[0], options))
            return {"client": result(client), "server": result(server)}

    def start_up(self, contestant, transport):
        """Seconds from the start of a process until it has the first message of one that runs already."""
        with harness.Processes() as processes:
            processes.start(self.argv(contestant, transport, "announce", {"period": 10_000_000}))
            time.sleep(2)
            options = {"spawned-at": time.monotonic_ns()}
            joined = processes.start(self.argv(contestant, transport, "join", options))
            return result(joined)["first_message_ns"] * 1e-9

    def idle(self, contestant, transport, nodes, seconds):
        """What each of one or two processes costs that have nothing to do: share of a processor, bytes a second."""
        with harness.Processes() as processes:
            options = {"carriage": "queue"}
            started = [processes.start(self.argv(contestant, transport, role, options))
                       for role in ("sink", "join")[:nodes]]
            time.sleep(6)
            before, began = [processor_ns(p.pid) for p in started], time.monotonic()
            bytes_before = loopback_bytes()
            time.sleep(seconds)
            passed = time.monotonic() - began
            used = [processor_ns(p.pid) - b for p, b in zip(started, before)]
            return {"processor": sum(used) / nodes / passed * 1e-9,
                    "bytes_per_s": (loopback_bytes() - bytes_before) / nodes / passed}


def result(process, index=0, limit_s=LIMIT_S):
    """The index-th line of JSON that the process writes."""
    seen = []

    def found(text):
        if text.startswith("{"):
            seen.append(json.loads(text))
            if "failed" in seen[-1]:
                raise AssertionError(f"{process.argv}: {text}")
        return seen[-1] if len(seen) > index else None
    return process.wait_for(found, limit_s)[1]


def processor_ns(pid):
    """Processor time of all threads so far."""
    return sum(int((task / "schedstat").read_text().split()[0])
               for task in pathlib.Path(f"/proc/{pid}/task").iterdir())


def loopback_bytes():
    """Sent on the loopback of this network namespace so far."""
    for line in pathlib.Path("/proc/net/dev").read_text().splitlines():
        name, _, counts = line.partition(":")
        if name.strip() == "lo":
            return int(counts.split()[8])
    raise AssertionError("there is no loopback")
