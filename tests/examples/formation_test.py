"""examples/formation with real processes, over both backends: the leader is killed in flight, another one takes over, and
no two aircraft come close.

Usage: formation_test.py BIN ROOT TRANSPORT,...
"""

import math
import pathlib
import re
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 240
SAFE_M = 8  # of the 20 m between neighbours; poses of one look differ in age by 0.3 s
AIRCRAFT = [f"uav{i}" for i in range(1, 7)]


def check(good, what):
    if not good:
        sys.exit(f"FAILED: {what}")
    print(f"ok: {what}")


def main():
    programs, root, transports = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3].split(",")
    harness.enter_namespace()
    folder = root / "examples/formation"
    with tempfile.TemporaryDirectory(prefix="rabit_formation_") as work, harness.Processes() as processes:
        config = pathlib.Path(work) / "ground.yaml"
        config.write_text((folder / "formation_ground.yaml").read_text().replace("leg_m: 200", "leg_m: 60"))

        def start(program, file, name, transport):
            return processes.start([programs / program, "--config", file, "--node", name, "--transport", transport,
                                    "--domain", harness.domain()])
        ground = start("formation_ground", config, "ground", transports[0])
        uavs = {name: start("formation_uav", folder / "formation_uav.yaml", name, transports[i % len(transports)])
                for i, name in enumerate(AIRCRAFT)}
        # The ground program tells the least distance that it saw on each leg: `inf` if it saw none.
        def check_next_leg(what, since=0.0):
            when, reached = ground.wait_for(re.compile(r"^reached \S+ m, closest (\S+) m$").search, LIMIT_S, since)
            check(SAFE_M < float(reached.group(1)) < math.inf, f"no two aircraft came close {what}: {reached.group(1)} m")
            return when
        when = check_next_leg("before the leader was killed")
        when, accepted = ground.wait_for(re.compile(r"^(uav\d)/Leadership: accepted$").search, LIMIT_S, when)
        former = accepted.group(1)
        uavs[former].kill()
        when, leads = ground.wait_for(re.compile(r"^leader (uav\d)$").search, LIMIT_S, when)
        check(leads.group(1) != former, f"another aircraft than {former} leads")
        check_next_leg("on the leg on which it was killed", when)
        others = [name for name in AIRCRAFT if name != former]
        told = re.compile(f": info: Leadership: {leads.group(1)} leads$")
        uavs[others[-1]].wait_for(told.search, LIMIT_S)
        for name in others:
            check(uavs[name].terminate() == 0, f"{name} ends in order")
        check(ground.terminate() == 0, "the ground program ends in order")


if __name__ == "__main__":
    main()
