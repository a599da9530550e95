"""The program `rabit` as one who types it runs it, beside two aircraft, one on each DDS implementation: what the tests here
share."""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "integration"))
import harness  # noqa: E402

# Only keeps a broken program from hanging.
LIMIT = 300
SWARM = harness.ROOT / "examples/swarm"


class Rabit:
    """Runs the program as one who types it."""

    def __init__(self, program, transport, domain, uav=None):
        self.program = program
        self.transport = transport
        self.domain = domain
        self.uav = uav
        self._network = ["--interface", "127.0.0.1", "--domain", str(domain), "--transport", transport]

    def argv(self, command, *arguments):
        return [self.program, command, *self._network, *arguments]

    def run(self, command, *arguments, text=None):
        return subprocess.run(self.argv(command, *arguments), input=text, capture_output=True, text=True,
                              timeout=LIMIT, check=False)

    def run_until_heard(self, command, *arguments, reason=""):
        """Lets the program wait for 4 s, and for longer if it has heard nobody by then (3), or does not give the reason. For
        what the program looks for in vain: it waits for all of the time, since that may still come."""
        done = self.run(command, *arguments, "--wait", "4")
        return self.run(command, *arguments, "--wait", "60") if done.returncode == 3 or reason not in done.stderr else done

    def objects(self, command, *arguments):
        done = self.run(command, "--json", *arguments)
        return [json.loads(line) for line in done.stdout.splitlines()], done


def aircraft_config(folder, extra=""):
    """The aircraft's configuration in a file, without the subscriptions to the ground station: it does not run here, and a
    node reports that as a problem. `extra`: further lines of `subscribe`."""
    lines = [line for line in (SWARM / "uav.yaml").read_text().splitlines(keepends=True)
             if not re.search("message: (SearchArea|Geofence)", line)]
    path = pathlib.Path(tempfile.mkstemp(dir=folder, suffix=".yaml")[1])
    path.write_text("".join(lines).replace("accept:\n", extra + "accept:\n", 1))
    return path


def is_well(done):
    """True if `nodes` or `doctor` found no other problem than that the aircraft have no camera here."""
    problems = [line for line in done.stdout.splitlines() if line.startswith("! ") or '"problem"' in line]
    return done.returncode == (1 if problems else 0) and all("subscribe Targets: " in line for line in problems)


def keys(thing):
    return list(thing.keys())


def main(tests):
    """Runs each of them, or those that are named on the command line, with the program on each DDS implementation."""
    harness.enter_namespace()
    program, uav, transports = sys.argv[1], sys.argv[2], sys.argv[3].split(",")
    failed = []
    with tempfile.TemporaryDirectory(prefix="rabit_two_aircraft_") as folder, harness.Processes() as processes:
        config = aircraft_config(folder)
        for number, transport in enumerate((transports * 2)[:2], 1):
            processes.start([uav, "--config", config, "--node", f"uav{number}", "--domain", harness.domain(),
                             "--transport", transport])
        for transport in transports:
            for test in [test for test in tests if not sys.argv[4:] or test.__name__ in sys.argv[4:]]:
                begin = time.monotonic()
                try:
                    test(Rabit(program, transport, harness.domain(), uav))
                    print(f"ok      {transport} {test.__name__}, {time.monotonic() - begin:.1f} s", flush=True)
                except Exception as error:  # pylint: disable=broad-except
                    failed.append(test.__name__)
                    print(f"FAILED  {transport} {test.__name__}: {type(error).__name__} {error}", flush=True)
    sys.exit(f"{len(failed)} failed" if failed else 0)
