"""The command line of `rabit lab`."""

import argparse
import datetime
import pathlib
import secrets
import shutil
import sys

from rabit_lab import cage, containers, keys, network, new, real_time, runner, scenario as scenarios, table, tools, what_if
from rabit_lab.marked import ScenarioError
from rabit_lab.radio import Unsupported

GOOD, FAILED, USAGE, IMPOSSIBLE, INTERRUPTED = 0, 1, 2, 3, 130


def folder_for(name, wanted):
    """A new folder for the results."""
    now = datetime.datetime.now(datetime.timezone.utc).strftime("%Y%m%dT%H%M%SZ")
    path = pathlib.Path(wanted) if wanted else pathlib.Path("lab", f"{name}_{now}")
    try:
        if path.exists() and any(path.iterdir()):
            raise ScenarioError(path, "is there already; name another folder with --to")
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ScenarioError(path, f"cannot be made ({error.strerror}); name another folder with --to") from None
    return path.resolve()


def run(options):
    """`rabit lab run`"""
    scenario = scenarios.read(options.scenario)
    if options.check:
        print(f"{options.scenario}: {len(scenario.fleet())} nodes, {len(scenario.networks)} networks, {len(scenario.events)} "
              f"events, {len(scenario.expects)} expectations, {scenario.run:g} s")
        return GOOD
    bare = [node for node in scenario.nodes.values() if not node.image]
    if options.docker and bare:
        raise ScenarioError(f"{options.scenario}:{bare[0].line}", f"node {bare[0].name} has no `image`, which --docker needs")
    has_images = len(bare) < len(scenario.nodes)
    found = tools.find()
    folder = folder_for(scenario.path.stem, options.to)
    label = f"rabit-lab-{secrets.token_hex(4)}" if has_images else None
    code = IMPOSSIBLE
    try:
        made = keys.make(scenario, folder, found.rabit)
        code = cage.run(lambda: fly(scenario, folder, found, label, made), own_processes=not has_images)
    finally:
        if label and shutil.which("docker"):
            containers.remove(label)
        if code == IMPOSSIBLE:
            shutil.rmtree(folder, ignore_errors=True)
    return code


def fly(scenario, folder, found, label, made):
    """In the cage. `label`: of the containers, if nodes have images. `made`: the keys. Returns the exit code."""
    readable = {str(scenario.folder), str(pathlib.Path(found.stepped_clock).parent)}
    spaces = containers.Containers(scenario, folder, readable, label) if label else network.Spaces()
    verdicts = runner.Runner(scenario, folder, found, spaces, made).run()
    if verdicts is None:
        print(f"interrupted; {folder}/report.html has what was seen")
        return INTERRUPTED
    print()
    for verdict in verdicts:
        print(("met      " if verdict.good else "NOT MET  ")
              + table.safe(verdict.text + (f": {verdict.detail}" if verdict.detail else "")))
    wrong = [verdict for verdict in verdicts if not verdict.good]
    print(f"\n{'FAILED' if wrong else 'PASSED'}: {len(verdicts) - len(wrong)} of {len(verdicts)} expectations met; "
          f"{folder}/report.html")
    return FAILED if wrong else GOOD


def make(options):
    """`rabit lab new`"""
    print(new.write(options.folder, options.to))
    return GOOD


def replay(options):
    """`rabit lab replay`"""
    found = tools.find()
    radio = what_if.Radio.of(options)
    folder = folder_for(f"{pathlib.Path(options.recording[0]).stem}_what_if", options.to)
    is_shown = False
    try:
        if options.real_time:
            scenario, told = real_time.read(found.replay, options.recording, radio, folder)
            code = cage.run(lambda: replayed(real_time.fly(scenario, told, radio, folder, found), folder))
            is_shown = code != IMPOSSIBLE
            return code
        what_if.show(what_if.fly(found.replay, options.recording, radio), radio, folder)
        is_shown = True
    except KeyboardInterrupt:
        print("interrupted")
        return INTERRUPTED
    finally:
        if not is_shown:
            shutil.rmtree(folder, ignore_errors=True)
    return replayed(True, folder)


def replayed(good, folder):
    """The exit code. `good`: none if it was interrupted."""
    print(f"\n{folder}/report.html" if good is not None else f"interrupted; {folder}/report.html has what was seen")
    return INTERRUPTED if good is None else GOOD if good else FAILED


def parse(arguments):
    parser = argparse.ArgumentParser(prog="rabit lab", description="Flies a fleet of one's own through a scenario.")
    commands = parser.add_subparsers(dest="command", required=True)
    command = commands.add_parser("run", help="run a scenario, and judge it")
    command.add_argument("scenario", metavar="SCENARIO", help="a file of YAML")
    command.add_argument("--to", metavar="FOLDER", help="folder of the results; default: lab/NAME_TIME")
    command.add_argument("--check", action="store_true", help="only check the scenario; nothing starts")
    command.add_argument("--docker", action="store_true", help="each node in a container; each needs an `image`")
    command.set_defaults(act=run)
    command = commands.add_parser("new", help="write a scenario for the configurations of a folder")
    command.add_argument("folder", metavar="FOLDER")
    command.add_argument("--to", metavar="FILE", help="the file, which is made; default: FOLDER/scenario.yaml")
    command.set_defaults(act=make)
    command = commands.add_parser("replay", help="fly a recorded flight over another radio, in simulated time or in real time")
    command.add_argument("recording", metavar="FILE", nargs="+", help="recordings on one time line, as flight.mcap")
    for option in what_if.OPTIONS:
        command.add_argument(f"--{option.name}", metavar=option.word, help=option.text, default=option.default)
    command.add_argument("--to", metavar="FOLDER", help="folder of the results; default: lab/NAME_TIME")
    command.add_argument("--real-time", action="store_true", help="fly real gateways over an emulated radio, in real time")
    command.set_defaults(act=replay)
    return parser.parse_args(arguments)


def main(arguments):
    """Returns the exit code: 0 passed, 1 failed, 2 a mistake in the scenario or the command line, 3 this machine does not
    allow it, 130 interrupted."""
    options = parse(arguments)
    try:
        return options.act(options)
    except ScenarioError as error:
        print(f"rabit: {error}", file=sys.stderr)
        return USAGE
    except Unsupported as error:
        print(f"rabit: {error}", file=sys.stderr)
        return IMPOSSIBLE
