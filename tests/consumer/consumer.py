"""What the tests of the installed package share: building projects outside the tree against it, and running them."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
from xml.etree import ElementTree

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
# Verdicts of a flight that tell times: whoever flies it reads them. tests/gateway/lab/lab_parts_test.py tests how they are reached.
OF_TIME = re.compile(r"\bwithin\b|\bage p90\b|^no false lost$")
# The exit code of `rabit lab run` where it is not allowed.
LAB_IMPOSSIBLE = 3


def run(*argv, fails=False, **options):
    """Runs a command to its end and returns what it said; shows that if it does not end as it should."""
    done = subprocess.run([str(a) for a in argv], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=30 * LIMIT_S, check=False, **options)
    if (done.returncode != 0) != fails:
        print(done.stdout)
        sys.exit(f"ended with {done.returncode}: {' '.join(str(a) for a in argv)}")
    return done.stdout


def build(cmake, name, folder, prefix):
    """Builds a copy of one of the projects here against the package below the prefix; returns the build directory."""
    shutil.copytree(HERE / name, folder / name)
    built = folder / f"{name}_build"
    run(cmake, "-S", folder / name, "-B", built, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
        f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF")
    run(cmake, "--build", built)
    return built


def build_template(cmake, folder, prefix):
    """Builds the template against the package and runs the test that it comes with."""
    built = build(cmake, "project", folder, prefix)
    run(pathlib.Path(cmake).parent / "ctest", "--test-dir", built, "--output-on-failure", "--no-tests=error")
    print("ok: the template")


def fly_template(folder, prefix):
    """Flies the built template in the lab of the package, by the scenario that comes with it."""
    done = subprocess.run([prefix / "bin" / "rabit", "lab", "run", "scenario.yaml", "--to", folder / "flight"],
                          cwd=folder / "project", env=os.environ | {"PATH": f"{folder / 'project_build'}:{os.environ['PATH']}"},
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=LIMIT_S, check=False)
    if done.returncode == LAB_IMPOSSIBLE:
        print(f"not judged: the template in the lab: {done.stdout.strip()}")
        return
    if done.returncode not in (0, 1):
        sys.exit(f"the flight of the template ended with {done.returncode}:\n{done.stdout}")
    cases = list(ElementTree.parse(folder / "flight" / "junit.xml").getroot().iter("testcase"))
    wrong = [case.get("name") for case in cases if case.find("failure") is not None and not OF_TIME.search(case.get("name"))]
    shown = (folder / "flight" / "logs" / "display.log").read_text(encoding="utf-8")
    if wrong or not {"exit codes: 0", "no node ends by itself"} <= {case.get("name") for case in cases} \
            or "m/s from 270 degrees" not in shown:
        sys.exit(f"the flight of the template: {wrong}; the display showed {shown[-500:]}\n{done.stdout}")
    print("ok: the template in the lab")


def run_two_managers(program):
    said = run(program)
    if said != "received 100, last post 100\n":
        sys.exit(f"two_managers said: {said}")
    print("ok: two managers")


def run_simulated(program):
    said = run(program)
    if said != "UP\n":
        sys.exit(f"simulated said: {said}")
    print("ok: nodes on a simulated network")


def run_types(program):
    """Also that the parser of IDL tells its reason to the program, and nothing to the terminal."""
    said = run(program)
    if said != '{"number":7}\nline 1: Scoped name \'Unknown\' cannot be resolved\n':
        sys.exit(f"types said: {said}")
    print("ok: types known at run time")


def run_again(program, folder):
    said = run(program, folder / "recording")
    if said != ("as recorded: 12 steps, 10 messages\n"
                "step 2, 0.500 s after its startup: message Reading, value: recorded 2, now 3\n"):
        sys.exit(f"again said: {said}")
    print("ok: a manager that is run again")


def exchange(node, first, second):
    """Runs two nodes against each other, each over its backend."""
    with harness.Processes() as processes:
        a = processes.start([node, "a", "b", first, harness.domain()])
        b = processes.start([node, "b", "a", second, harness.domain()])
        a.wait_for(re.compile("a has all of b/Exchange").search, LIMIT_S)
        b.wait_for(re.compile("b has all of a/Exchange").search, LIMIT_S)
        if a.terminate() != 0 or b.terminate() != 0:
            sys.exit("a node did not end well")
    print(f"ok: {first} and {second}")
