#!/usr/bin/env python3
"""A run with a container: its node has the user and the rights of its image, and nothing is left of it.

Usage: lab_image_test.py RABIT UAV
Exit code 77: no Docker engine answers, or this is not root."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from lab_test import Case, check, check_passed, skip

USER = 1234
PROGRAMS = ("sh", "cat", "sleep", "id", "grep", "setsid", "touch")
SCENARIO = """  guest:
    image: IMAGE
    plain: true
    command:
      - sh
      - -c
      - |
        id -u
        grep CapEff /proc/self/status
        touch $RABIT_NODE_RECORD/file && echo writes results
        touch $RABIT_TEST_FOLDER/file || echo changes nothing else
        setsid sh -c 'while :; do echo child; sleep 0.1; done' &
        sleep 999
    env: {RABIT_TEST_FOLDER: FOLDER}
run: 4P
events:
  - {at: 1P, kill: guest}
  - {at: 2P, start: guest}
expect:
  - guest says child within 1P after 0s
  - guest says child within 1P after 2P
"""


def docker(*words, **how):
    return subprocess.run(["docker", *words], text=True, check=False, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, **how)


def make_image(folder, name):
    """A few programs of this machine."""
    for program in PROGRAMS:
        path = shutil.which(program)
        said = subprocess.run(["ldd", path], text=True, check=True, stdout=subprocess.PIPE).stdout
        for file in [path, *(word for word in said.split() if word.startswith("/"))]:
            target = folder / file.lstrip("/")
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(file, target)
    with subprocess.Popen(["tar", "-C", str(folder), "-c", "."], stdout=subprocess.PIPE) as tar:
        made = docker("import", "--change", f"USER {USER}", "--change", "ENV PATH=/usr/bin:/bin", "-", name, stdin=tar.stdout)
    if made.returncode != 0:
        sys.exit("docker import failed")


def main():
    rabit, uav = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:3])
    if os.geteuid() != 0 or not shutil.which("docker") or docker("info").returncode != 0:
        skip("no Docker engine answers, or this is not root", "docker.io")
    folder = pathlib.Path(tempfile.mkdtemp(prefix=f"rbtlab-{os.getpid()}-"))
    folder.chmod(0o755)
    image = f"rabit-lab-test:{os.getpid()}"
    try:
        make_image(folder / "image", image)
        scenario = SCENARIO.replace("IMAGE", f'"{image}"').replace("FOLDER", str(folder / "guest"))
        case = Case(folder, "guest", scenario, 1, rabit, uav)
        case.run()
        check_passed(case)
        lives = [line.split(None, 3)[2:] for line in (case.results / "log.txt").read_text(encoding="utf-8").splitlines()
                 if " guest " in line]
        said = [words for kind, words in lives if kind == "output"]
        for words in (str(USER), "CapEff:\t0000000000000000", "writes results", "changes nothing else"):
            check(said.count(words) == 2, case, f"two lives did not say `{words}`: {[one for one in said if one != 'child']}")
        check(lives[-1][0] == "lab" and "ended with" in lives[-1][1], case, f"a child goes on: {lives[-3:]}")
        left = docker("ps", "--all", "--quiet", "--filter", f"ancestor={image}").stdout
        check(not left, case, f"containers are left: {left}")
        print("ok: guest: the rights of its image, and nothing is left")
    finally:
        docker("rmi", "--force", image)
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
