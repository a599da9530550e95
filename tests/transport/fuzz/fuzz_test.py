#!/usr/bin/env python3
"""Two nodes on loopback while a stranger sends them damaged copies of their own traffic, discovery included: nobody ends,
their memory stays within its limit, and every queue message between them is delivered.

Usage: fuzz_test.py NODE FUZZER TRANSPORT DATAGRAMS [--content | --keys RABIT] [--seed N] [--memory MB]
Without an option everything is damaged but the content of the nodes' own samples, and no message may be in doubt.
--content: that too. Forged content of a sample with the right number cannot be told from honest content without a
signature: a link that is told of another life of its receiver takes it for restarted, and messages may be in doubt. All
others are delivered.
--keys: everything, of nodes that have keys, which the program RABIT makes. No message may be in doubt: whatever is forged is
nobody's.
--memory: what a node may take at most; one under AddressSanitizer needs more.
Needs to make network namespaces; ends with 77 where it may not."""

import argparse
import os
import pathlib
import re
import signal
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "interop"), str(HERE.parents[1] / "integration")]
import harness  # noqa: E402
import interop_keys  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
SLOWEST_PER_S = 500
RATE = 50
# More than eight times what a node of these tests needs without damaged datagrams.
MEMORY_MB = 256


def important(node):
    """What a node said, without what it says all the time."""
    return [text for _, text in node.lines if not re.search("hundred orders|ten counters|no sound|resumed", text)]


def memory_mb(process):
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text(encoding="ascii")
    return int(re.search(r"VmHWM:\s+(\d+) kB", status).group(1)) / 1024


def check_alive(nodes):
    for node in nodes:
        if not node.running():
            tail = "\n".join(important(node)[-40:])
            raise AssertionError(f"{node.argv} ended with {node.exit_code(5)}:\n{tail}")


def flood(fuzzer, nodes, seconds):
    """Until the fuzzer is done, or a node ends."""
    def done():
        check_alive(nodes)
        code = None if fuzzer.running() else fuzzer.exit_code(LIMIT_S)  # then all that it said has been read
        if any(text.startswith("done ") for _, text in list(fuzzer.lines)):
            return fuzzer.wait_for(re.compile(r"done (\d+) dropped (\d+) left out (\d+)").fullmatch, LIMIT_S)[1]
        if code is not None:
            raise AssertionError(f"the fuzzer ended with {code}: {fuzzer.lines[-5:]}")
        return None

    return harness.until(done, seconds)


def settle(node, nodes):
    """Until all that the node sent has an outcome. A failure shows what both nodes said."""
    pattern = re.compile(r"stopped round=(\d+) sent=(\d+) delivered=(\d+) in_doubt=(\d+)")
    try:
        return node.wait_for(pattern.fullmatch, LIMIT_S)[1]
    except AssertionError:
        said = "\n".join(f"{each.argv}\n  " + "\n  ".join(important(each)[-40:]) for each in nodes)
        raise AssertionError(f"{node.argv} has messages without an outcome:\n{said}") from None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("node")
    parser.add_argument("fuzzer")
    parser.add_argument("transport")
    parser.add_argument("count")
    parser.add_argument("--seed", default="1")
    parser.add_argument("--content", action="store_true")
    parser.add_argument("--keys", metavar="RABIT")
    parser.add_argument("--memory", metavar="MB", type=int, default=MEMORY_MB)
    options = parser.parse_args()
    node, transport, count, seed = options.node, options.transport, options.count, options.seed
    harness.enter_namespace_or_skip()
    names = ("first", "second")
    with tempfile.TemporaryDirectory() as folder, harness.Processes() as processes:
        if options.keys:
            interop_keys.make(options.keys, folder, names)
        save = os.environ.get("FUZZ_SAVE")
        keep = not options.content and not options.keys
        fuzzer = processes.start([options.fuzzer, "--count", count, "--seed", seed, *(["--keep-content"] if keep else []),
                                  *(["--save", save] if save else [])])
        fuzzer.wait_for(re.compile("recording").fullmatch, LIMIT_S)
        nodes = [processes.start([node, "--node", names[i], "--other", names[1 - i], "--transport", transport,
                                  "--interface", "127.0.0.1", "--count", 1000000000, "--rate", RATE,
                                  *(["--keys", pathlib.Path(folder) / "keys" / names[i]] if options.keys else [])])
                 for i in (0, 1)]
        for each in nodes:
            each.wait_for(re.compile("peer UP").fullmatch, LIMIT_S)
            each.wait_for(re.compile(r"frame life=\d+").fullmatch, LIMIT_S)
            each.wait_for(re.compile("hundred orders round=1").fullmatch, LIMIT_S)
        before = [memory_mb(each) for each in nodes]
        fuzzer.tell("")
        _, recorded = fuzzer.wait_for(re.compile(r"recorded (\d+) ports (\d+)").fullmatch, LIMIT_S)
        begin = time.monotonic()
        done = flood(fuzzer, nodes, LIMIT_S + int(count) / SLOWEST_PER_S)
        took = time.monotonic() - begin
        check_alive(nodes)
        after = [memory_mb(each) for each in nodes]
        for each in nodes:
            os.kill(each.pid, signal.SIGUSR1)
        settled = [settle(each, nodes) for each in nodes]
        check_alive(nodes)
        print(f"{transport}: {recorded.group(1)} datagrams recorded, {done.group(1)} sent to {recorded.group(2)} ports in "
              f"{took:.0f} s, {done.group(2)} dropped by full sockets, {done.group(3)} of forged content left out; seed {seed}")
        for how in settled:
            print(f"  {how.group(0)}")
        for each, old, new in zip(nodes, before, after):
            print(f"  {old:.0f} MB before, {new:.0f} MB at most")
            if new > options.memory:
                raise AssertionError(f"{each.argv} took {new:.0f} MB")
        for how in settled:
            doubtful = int(how.group(4)) if options.content else 0
            if int(how.group(2)) != int(how.group(3)) + doubtful:
                raise AssertionError(f"not all were delivered: {how.group(0)}")
        forbidden = "^lost" if options.content else "not in order|skipped round|in doubt|garbled|^lost"
        for each in nodes:
            wrong = [text for _, text in each.lines if re.search(forbidden, text)]
            if wrong:
                raise AssertionError(f"{each.argv} said: {wrong[0]}")
        for each in nodes:
            code = each.terminate()
            if code != 0:
                raise AssertionError(f"{each.argv} ended with {code}")


if __name__ == "__main__":
    main()
