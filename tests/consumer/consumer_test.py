"""Installs the build into a prefix of its own, builds a project outside the tree against it, and runs its programs:
two managers in a process, and for each pair of backends that were built two nodes with messages of their own IDL."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 120


def run(*argv):
    """Runs a command to its end; shows what it said if it fails."""
    done = subprocess.run([str(a) for a in argv], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=10 * LIMIT_S, check=False)
    if done.returncode != 0:
        print(done.stdout)
        sys.exit(f"failed with {done.returncode}: {' '.join(str(a) for a in argv)}")
    return done.stdout


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


def main():
    cmake, build, transports = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3].split(",")
    harness.enter_namespace()
    with tempfile.TemporaryDirectory(prefix="rabit_consumer_") as folder:
        folder = pathlib.Path(folder)
        run(cmake, "--install", build, "--prefix", folder / "prefix")
        shutil.copytree(HERE / "project", folder / "project")
        run(cmake, "-S", folder / "project", "-B", folder / "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
            f"-DCMAKE_PREFIX_PATH={folder / 'prefix'}", "-DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF")
        run(cmake, "--build", folder / "build")
        said = run(folder / "build" / "two_managers")
        if said != "received 100, last post 100\n":
            sys.exit(f"two_managers said: {said}")
        print("ok: two managers")
        for first in transports:
            for second in transports:
                exchange(folder / "build" / "node", first, second)


if __name__ == "__main__":
    main()
