#!/usr/bin/env python3
"""Says how old each part of the night is, and fails if the night cannot be relied upon.

  check.py              one line for each part; fails if a part is too old, or red for a cause that known.md does not name
  check.py changed PART PATH...   succeeds if a path was touched since the newest run of that part
Age is a number of commits that touch what flies: no clock decides."""

import sys

import parts

OLDEST = 200  # commits that touch what flies
SKIPS = 3     # runs in a row in which a test was skipped without a reason


def judge(name, result, known, age):
    """(the line about one part, the list of what is wrong with it). `age`: commits, or None if git does not know the commit."""
    if result is None:
        return f"{name}: no entry in results.json", ["it has no result: run .ci/night " + name]
    wrong = []
    unknown = sorted(set(result["failed"]) - set(known))
    if unknown:
        wrong.append("red, and known.md does not say why: " + ", ".join(unknown))
    silent = sorted(test for test, skip in result["skipped"].items() if not skip["reason"] and skip["runs"] >= SKIPS)
    if silent:
        wrong.append(f"skipped {SKIPS} times in a row without a reason: " + ", ".join(silent))
    if age is None:
        wrong.append(f"its commit {result['commit'][:8]} is not in the history of this tree")
    elif age >= OLDEST:
        wrong.append(f"{age} commits old, {OLDEST} is the limit: run .ci/night {name}")
    done = "never run" if not result["date"] else (
        f"{result['date']}, {result['passed']} passed, {len(result['failed'])} failed, {len(result['skipped'])} skipped")
    return f"{name}: {done}, {'an unknown number of' if age is None else age} commits old", wrong


def check(all_parts, results, known, history, say=print):
    """True if the night can be relied upon."""
    if history.is_shallow():
        say("night: this clone has no history, so the age of the night is not known")
        return True
    sound = True
    for name in all_parts:
        result = results.get(name)
        age = history.commits_since(result["commit"], parts.FLIES) if result else None
        line, wrong = judge(name, result, known, age)
        say(f"night: {line}")
        for fault in wrong:
            say(f"night: {name}: {fault}")
            sound = False
    return sound


def main(arguments):
    history = parts.History()
    if arguments[:1] == ["changed"]:
        result = parts.results().get(arguments[1])
        return 0 if not result or history.commits_since(result["commit"], arguments[2:]) != 0 else 1
    return 0 if check(parts.parts(), parts.results(), parts.known(), history) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
