"""Namespaces of the run's own, for processes, mounts and, without root, users. All that runs, is mounted or is connected in
them ends with this process, also by SIGKILL: the kernel cleans up."""

import ctypes
import os
import signal
import sys

from rabit_lab import processes
from rabit_lab.radio import Unsupported

CLONE_NEWNS, CLONE_NEWUSER, CLONE_NEWPID, CLONE_NEWNET = 0x00020000, 0x10000000, 0x20000000, 0x40000000
MS_REC, MS_PRIVATE = 0x4000, 0x40000
ADVICE = ("run it as root (sudo); or allow namespaces to users: sysctl kernel.unprivileged_userns_clone=1, "
          "kernel.apparmor_restrict_unprivileged_userns=0; in a container: docker run --privileged")
_libc = ctypes.CDLL(None, use_errno=True)


def mount(source, target, kind, flags=0, data=""):
    """mount(2)"""
    if _libc.mount(source.encode(), target.encode(), kind.encode(), ctypes.c_ulong(flags), data.encode()) != 0:
        error = ctypes.get_errno()
        raise Unsupported(f"cannot mount {target} ({os.strerror(error)}); {ADVICE}")


def _unshare(own_processes):
    user, group = os.geteuid(), os.getegid()
    # `ip netns` returns to the network that it was started in, which a user may do only if that is the user's, too.
    flags = CLONE_NEWNS | (CLONE_NEWPID if own_processes else 0) | (CLONE_NEWUSER | CLONE_NEWNET if user != 0 else 0)
    if _libc.unshare(flags) != 0:
        raise Unsupported(f"no namespaces can be made here ({os.strerror(ctypes.get_errno())}); {ADVICE}")
    if user != 0:
        for name, text in (("setgroups", "deny"), ("uid_map", f"0 {user} 1"), ("gid_map", f"0 {group} 1")):
            with open(f"/proc/self/{name}", "w", encoding="ascii") as file:
                file.write(text)


def _furnish(own_processes):
    mount("none", "/", "none", MS_REC | MS_PRIVATE)
    if own_processes:
        mount("proc", "/proc", "proc")
    try:
        os.makedirs("/run/netns", exist_ok=True)
        mount("tmpfs", "/run/netns", "tmpfs")
    except PermissionError:  # without root: /run belongs to another user
        mount("tmpfs", "/run", "tmpfs")
        os.mkdir("/run/netns")


def run(work, own_processes=True):
    """Runs `work()` in the namespaces, and returns what it returns, an exit code. SIGINT and SIGTERM are for `work`."""
    sys.stdout.flush()
    _unshare(own_processes)
    child = os.fork()
    if child == 0:
        code = 1
        try:
            processes.die_with_parent()
            _furnish(own_processes)
            code = work()
        except Unsupported as error:
            print(f"rabit: {error}", file=sys.stderr)
            code = 3
        except BaseException:  # pylint: disable=broad-except
            sys.excepthook(*sys.exc_info())
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(code)  # pylint: disable=protected-access
    # A terminal sends Ctrl-C to both; a `kill` comes to this process alone.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, lambda number, _: os.kill(child, number))
    _, status = os.waitpid(child, 0)
    return os.waitstatus_to_exitcode(status) if not os.WIFSIGNALED(status) else 1
