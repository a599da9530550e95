#!/usr/bin/env python3
"""Runs one part of the night and writes its result into results.json. Called by .ci/night.

  run.py PART [--minutes N] [--jobs N] [--again] [--try]
  run.py due       names the parts whose subject was touched since they ran
Tests that no time decides run --jobs at once (4). Those that know time (label `timed`) run by themselves, each when the
machine is quiet. After --minutes (50) no further test is started; the same command then goes on where it stopped, as long as
the commit is the same. --again begins anew. --try: uncommitted changes are allowed, and nothing is recorded.
Exit code: 0 if all passed, 1 if a test failed, 3 if tests are left for the next call."""

import argparse
import concurrent.futures
import contextlib
import datetime
import json
import pathlib
import re
import subprocess
import sys
import threading
import time
import xml.etree.ElementTree as xml

import parts

sys.path.insert(0, str(parts.ROOT / "tests"))
import quiet  # noqa: E402  it lies in tests/
import skipped  # noqa: E402


class Test:
    """One test of ctest, with the properties that decide how it runs."""

    def __init__(self, description):
        properties = {entry["name"]: entry["value"] for entry in description.get("properties", [])}
        self.name = description["name"]
        self.labels = properties.get("LABELS", [])
        self.is_timed = "timed" in self.labels
        self.is_alone = self.is_timed or properties.get("RUN_SERIAL") in (True, "ON")
        self.cost = float(properties.get("COST", 0))
        self.locks = properties.get("RESOURCE_LOCK", [])


class Progress:
    """The tests of a part that have ended at this commit, in a file of the build folder, so that a run can go on."""

    def __init__(self, path, commit, is_new):
        self._path = path
        self._lock = threading.Lock()
        self._state = {"commit": commit, "ended": {}}
        if path.exists() and not is_new:
            state = json.loads(path.read_text(encoding="utf-8"))
            if state["commit"] == commit:
                self._state = state

    def ended(self):
        """Name -> [status, reason, seconds]."""
        return self._state["ended"]

    def add(self, name, status, reason, seconds):
        with self._lock:
            self._state["ended"][name] = [status, reason, round(seconds, 1)]
            self._path.parent.mkdir(parents=True, exist_ok=True)
            self._path.write_text(json.dumps(self._state, indent=1), encoding="utf-8")


def labels_of(name, part):
    return part.get("labels", [f"night_{name}"])


def tests_of(name, part, build):
    arguments = [word for label in labels_of(name, part) for word in ("-L", f"^({label})$")]
    listing = subprocess.run(("ctest", "--test-dir", build, "--show-only=json-v1", *arguments), capture_output=True, text=True,
                             check=True).stdout
    return [Test(description) for description in json.loads(listing)["tests"]]


def outcome_of(junit):
    """(status, reason) of the only test in a junit file: passed, failed or skipped."""
    case = xml.parse(junit).getroot().find("testcase")
    if case is None:
        return "failed", "ctest did not run it"
    if case.get("status") == "run":
        return "passed", ""
    if skipped.is_skipped(case):
        return "skipped", skipped.reason_of(case)
    return "failed", ""


def run_test(test, build, folder):
    """Runs one test; returns (status, reason, seconds). Its output stays in the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / re.sub(r"[^\w.-]", "_", test.name)
    begin = time.monotonic()
    with open(f"{file}.log", "w", encoding="utf-8") as log:
        subprocess.run(("ctest", "--test-dir", build, "-R", f"^{re.escape(test.name)}$", "--output-on-failure", "--output-junit",
                        f"{file}.xml"), stdin=subprocess.DEVNULL, stdout=log, stderr=log, check=False)
    return (*outcome_of(f"{file}.xml"), time.monotonic() - begin)


class Runner:
    """Runs the tests of a part that have not ended, and says how each one ended."""

    def __init__(self, build, folder, progress, deadline, say=print):
        self._build = build
        self._folder = folder
        self._progress = progress
        self._deadline = deadline
        self._say = say
        self._locks = {}

    def run(self, tests, jobs):
        waiting = [test for test in tests if test.name not in self._progress.ended()]
        waiting.sort(key=lambda test: -test.cost)
        for test in waiting:
            for lock in test.locks:
                self._locks.setdefault(lock, threading.Lock())
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            list(pool.map(self._run_one, [test for test in waiting if not test.is_alone]))
        for test in waiting:
            if test.is_alone:
                self._run_one(test)

    def _run_one(self, test):
        with contextlib.ExitStack() as locks:
            for lock in sorted(test.locks):
                locks.enter_context(self._locks[lock])
            if time.monotonic() > self._deadline:
                return
            if test.is_timed:
                share = quiet.wait_until_quiet()
                if share >= quiet.QUIET:
                    self._say(f"{test.name}: other programs use {share * 100:.0f} % of a processor: not run")
                    return
            load = quiet.Load()
            status, reason, seconds = run_test(test, self._build, self._folder)
            self._progress.add(test.name, status, reason, seconds)
            beside = f", beside {load.share() * 100:.0f} % of a processor" if test.is_timed else ""
            self._say(f"{status}: {test.name}, {seconds:.0f} s{beside}{': ' + reason if reason else ''}")


def result_of(ended, commit, date, before):
    """The entry of results.json for the tests of a part that have all ended. `before`: its last entry, or None."""
    skips = before["skipped"] if before else {}
    return {
        "commit": commit,
        "date": date,
        "seconds": round(sum(seconds for _, _, seconds in ended.values())),
        "passed": sum(status == "passed" for status, _, _ in ended.values()),
        "failed": sorted(name for name, (status, _, _) in ended.items() if status == "failed"),
        "skipped": {name: {"reason": reason, "runs": skips.get(name, {"runs": 0})["runs"] + 1}
                    for name, (status, reason, _) in ended.items() if status == "skipped"},
    }


def due(all_parts, results, history):
    """The parts whose subject was touched since they ran, those that never ran first."""
    found = [(bool(results[name]["date"]) if name in results else False, name) for name, part in all_parts.items()
             if name not in results or not results[name]["date"]
             or history.commits_since(results[name]["commit"], part["touches"]) != 0]
    return [name for _, name in sorted(found)]


def run_part(name, options):
    history = parts.History()
    changed = [file for file in history.changed_files() if not file.startswith("tests/night/results.json")]
    if changed and not options.attempt:
        sys.exit(f"night: commit first, since a result names a commit: {changed[0]} is changed (or --try: nothing is recorded)")
    part = parts.parts()[name]
    preset = part.get("preset", "release")
    build = parts.ROOT / "build" / preset
    deadline = time.monotonic() + options.minutes * 60
    if subprocess.run((parts.ROOT / "docker" / "build-preset.sh", preset, *part.get("targets", ["all"])), check=False).returncode:
        sys.exit(f"night: {name}: its programs could not be built, so nothing was tested")
    tests = tests_of(name, part, build)
    if not tests:
        sys.exit(f"night: {name}: no test has its label, so nothing was tested")
    folder = parts.ROOT / "build" / "night" / name
    progress = Progress(folder / "progress.json", history.head(), options.again)
    Runner(build, folder, progress, deadline).run(tests, options.jobs)
    ended = {test.name: progress.ended()[test.name] for test in tests if test.name in progress.ended()}
    left = len(tests) - len(ended)
    if left:
        print(f"night: {name}: {len(ended)} of {len(tests)} tests have ended; run it again to go on")
        return 3
    results = parts.results()
    result = result_of(ended, history.head(), datetime.date.today().isoformat(), results.get(name))
    if not options.attempt:
        results[name] = result
        parts.write_results(results)
    print(f"night: {name}: {result['passed']} passed, {len(result['failed'])} failed, {len(result['skipped'])} skipped")
    for test, skip in result["skipped"].items():
        print(f"skipped: {test}: {skip['reason'] or 'it does not say why'}")
    for test in result["failed"]:
        print(f"failed: {test}; its output: {folder.relative_to(parts.ROOT)}/{re.sub(r'[^A-Za-z0-9_.-]', '_', test)}.log")
    return 1 if result["failed"] else 0


def main():
    parser = argparse.ArgumentParser(usage="see the first lines of this file")
    parser.add_argument("part", choices=[*parts.parts(), "due"])
    parser.add_argument("--minutes", type=float, default=50)
    parser.add_argument("--jobs", type=int, default=4)
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--try", dest="attempt", action="store_true")
    options = parser.parse_args()
    if options.part == "due":
        print("\n".join(due(parts.parts(), parts.results(), parts.History())))
        return 0
    return run_part(options.part, options)


if __name__ == "__main__":
    sys.exit(main())
