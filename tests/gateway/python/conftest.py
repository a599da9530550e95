"""Nodes on loopback, and the classes of the example's IDL file."""

import ctypes
import itertools
import os
import pathlib
import subprocess
import sys
import textwrap
import time

import pytest

import rabit

ROOT = pathlib.Path(__file__).resolve().parents[3]
FIRST = os.getpid() % 100
# The ports of higher domains are among those that the kernel gives to any socket.
DOMAINS = itertools.cycle([*range(FIRST, 100), *range(FIRST)])


def enter_own_network():
    """A loopback of this process and its children alone, so that tests do not disturb each other. If the machine forbids
    that, they use the machine's, each test a domain of its own."""
    new_network = 0x40000000  # CLONE_NEWNET
    if ctypes.CDLL(None).unshare(new_network) == 0:
        subprocess.run(["ip", "link", "set", "lo", "up"], check=True)


enter_own_network()


@pytest.fixture(scope="session")
def idl():
    return rabit.load_idl(ROOT / "idl/messages/uav.idl")


@pytest.fixture(params=rabit.transports())
def network(request):
    """Settings of nodes that hear each other and nobody else."""
    return {"domain": next(DOMAINS), "transport": request.param, "interfaces": ["127.0.0.1"]}


@pytest.fixture
def one_network():
    """The same of one transport, for what does not depend on it."""
    return {"domain": next(DOMAINS), "transport": rabit.transports()[0], "interfaces": ["127.0.0.1"]}


def wait_until(holds, seconds=120.0):
    """Returns what `holds` returns once that is true."""
    end = time.monotonic() + seconds
    while not (result := holds()):
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.01)
    return result


def run(program, **more):
    return subprocess.Popen([sys.executable, "-c", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, **more)


PRELUDE = """
import asyncio, os, signal, sys, tempfile, threading, time
import rabit
idl = rabit.load_idl({idl!r})
network = {network!r}

def forked(function):
    '''Calls the function in a forked process, which then ends as any interpreter does. Its output goes to a file of its own.
    Returns a function that waits for that process and asserts its success.'''
    output = tempfile.TemporaryFile("w+")
    child = os.fork()
    if child == 0:
        os.dup2(output.fileno(), 1)
        os.dup2(output.fileno(), 2)
        function()
        sys.exit()
    def wait():
        status = os.waitpid(child, 0)[1]
        output.seek(0)
        assert status == 0, output.read()
    return wait
"""


def program(network, text):
    return PRELUDE.format(idl=str(ROOT / "idl/messages/uav.idl"), network=network) + textwrap.dedent(text)
