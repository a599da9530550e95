"""A Docker engine and an image of the fleet for the tests: those of the machine, or else made for the test alone.

An engine made here runs in network, mount and process namespaces of its own, so that its interfaces, firewall rules,
mounts, containers and itself end with this process, also by SIGKILL. It has no way out to a registry; its base image
is made from Debian's packages."""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import time

import field
import harness

ROOT = pathlib.Path(__file__).resolve().parents[2]
DEBIAN = f"debian:{harness.debian()}"  # the programs are built on this release
START_S = 60  # only keeps a broken engine from hanging the test
CONTROL_GROUPS = pathlib.Path("/sys/fs/cgroup")


def packages(name):
    """Those listed in docker/<name>, of alternatives the one that this machine has: building needs them, too."""
    lines = (ROOT / "docker" / name).read_text().splitlines()
    listed = [line.replace(" ", "").split("|") for line in lines if line.strip() and not line.startswith("#")]
    return [next((package for package in packages if _installed(package)), packages[-1]) for packages in listed]


def _installed(package):
    done = subprocess.run(["dpkg-query", "-W", "-f=${db:Status-Status}", package], text=True, check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    return done.stdout == "installed"


class Engine:
    """with Engine() as engine: engine.build(folder with bin/ and share/); engine.run("docker", "ps")"""

    def __init__(self):
        self.environment = dict(os.environ)
        self.mark = f"{field.PREFIX}-{os.getpid()}"
        self.image = f"rabit-fleet:{self.mark}"
        self._folder = None
        self._process = None
        self._images = []

    def __enter__(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, field.stop)
        sweep()
        try:
            self._folder = pathlib.Path(tempfile.mkdtemp(prefix=self.mark + "-"))
            self._folder.chmod(0o755)
            if not shutil.which("docker"):
                raise field.Unsupported("there is no docker; install docker.io")
            if not self._answers():
                self._start()
        except BaseException:
            self._remove()
            raise
        return self

    def __exit__(self, *_):
        self._remove()

    def run(self, *argv, check=True, text=None, seconds=600):
        """Runs a command that finds this engine; returns what it said."""
        done = subprocess.run([str(a) for a in argv], env=self.environment, input=text, text=True, check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=seconds)
        if check and done.returncode != 0:
            raise AssertionError(f"failed with {done.returncode}: {' '.join(map(str, argv))}\n{done.stdout}")
        return done.stdout

    def build(self, programs):
        """Makes the image of the fleet from programs that are built already."""
        base = DEBIAN if self._has_base() else self._make_base()
        with tempfile.TemporaryDirectory(prefix=self.mark + "-") as context:
            shutil.copytree(ROOT / "docker", pathlib.Path(context, "docker"))
            shutil.copytree(programs, pathlib.Path(context, "programs"))
            pathlib.Path(context).chmod(0o755)
            self._images.append(self.image)
            self.run("docker", "build", "--force-rm", "--tag", self.image, "--build-arg", f"MARK={self.mark}",
                     "--build-arg", f"BASE={base}", "--build-arg", "PREFIX=programs",
                     "--file", f"{context}/docker/Dockerfile", context)

    def _answers(self):
        return subprocess.run(["docker", "version"], env=self.environment, check=False, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL).returncode == 0

    def _has_base(self):
        if self._process:
            return False
        return (not subprocess.run(["docker", "image", "inspect", DEBIAN], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, check=False).returncode
                or not subprocess.run(["timeout", "120", "docker", "pull", DEBIAN], stdout=subprocess.DEVNULL,
                                      stderr=subprocess.DEVNULL, check=False).returncode)

    def _start(self):
        missing = [name for name in ("dockerd", "unshare", "ip", "iptables", "mmdebstrap") if not shutil.which(name)]
        if os.geteuid() != 0 or missing:
            raise field.Unsupported("no Docker engine answers, and none can be started: "
                                    + (f"there is no {missing[0]}; docker/packages-docker.txt lists what to install"
                                       if missing else "not root"))
        socket = f"unix://{self._folder}/socket"
        script = ('mount --make-rprivate / && ip link set lo up && exec dockerd --data-root "$0/data" '
                  '--exec-root "$0/exec" --pidfile "$0/pid" --host "$1" --cgroup-parent "$2" >"$0/log" 2>&1')
        # pylint: disable=consider-using-with
        self._process = subprocess.Popen(
            ["unshare", "--net", "--mount", "--pid", "--fork", "--kill-child", "--mount-proc",
             "sh", "-c", script, self._folder, socket, self.mark],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=harness.die_with_parent)
        self.environment["DOCKER_HOST"] = socket
        end = time.monotonic() + START_S
        while not self._answers():
            if self._process.poll() is not None or time.monotonic() > end:
                log = self._folder / "log"
                last = log.read_text().splitlines()[-1:] if log.exists() else []
                raise field.Unsupported(f"a Docker engine does not start here: {last}")
            time.sleep(0.2)

    def _make_base(self):
        """A small Debian with what the image needs, so that building the image needs no network."""
        name = f"rabit-base:{self.mark}"
        self._images.append(name)
        make = ["unshare", "--mount", "--pid", "--fork", "--kill-child", "--mount-proc", "mmdebstrap", "--quiet", "--variant=essential",
                "--include=" + ",".join(packages("packages-runtime.txt")), harness.debian(), "-"]
        with subprocess.Popen(make, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              env={**os.environ, "TMPDIR": str(self._folder)},
                              preexec_fn=harness.die_with_parent) as maker:
            subprocess.run(["docker", "import", "--change", f"LABEL rabit.build={self.mark}", "-", name],
                           env=self.environment, stdin=maker.stdout, check=True, stdout=subprocess.DEVNULL)
            maker.stdout.close()
            said = maker.stderr.read().decode(errors="replace")
            if maker.wait() != 0:
                raise field.Unsupported("no base image, no registry, and mmdebstrap fails: "
                                        + " ".join(said.split())[-300:])
        return name

    def _remove(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)
        if self._process:
            self._process.kill()
            self._process.wait()
            _remove_control_groups(self.mark)
        elif self._images:
            _remove_images(self.mark, self._images)
        if self._folder:
            shutil.rmtree(self._folder, ignore_errors=True)
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_DFL)


def control_groups():
    """Those that any engine of these tests made."""
    return [path for path, _, _ in os.walk(CONTROL_GROUPS) if field.NAME.match(os.path.basename(path) + "-")]


def _remove_control_groups(mark):
    end = time.monotonic() + START_S
    for path in control_groups():
        if os.path.basename(path) != mark:
            continue
        for below, _, _ in os.walk(path, topdown=False):
            while True:
                try:
                    os.rmdir(below)
                    break
                except FileNotFoundError:
                    break
                except OSError:  # a process in it is still ending
                    if time.monotonic() > end:
                        return
                    time.sleep(0.1)


def sweep():
    """Removes what makers that were killed have left: folders and empty control groups, for the rest ends with them;
    and, in the machine's own engine, their images, containers and networks."""
    field.sweep()
    for path in control_groups():
        mark = os.path.basename(path)
        if not os.path.exists(f"/proc/{re.search(r'[0-9]+', mark).group()}"):
            _remove_control_groups(mark)
    if shutil.which("docker"):
        for what, remove, label in (("ps --all", "rm --force", "rabit.fleet"),
                                    ("network ls", "network rm", "rabit.fleet")):
            for ident, mark in _listed(what, label, '{{.ID}} {{.Label "rabit.fleet"}}'):
                if field.dead(mark + "-"):
                    _quietly("docker", *remove.split(), ident)
        for tag, mark in _listed("image ls", "rabit.build", "{{.Repository}}:{{.Tag}} {{.Tag}}"):
            if field.dead(mark + "-"):
                _remove_images(mark, [tag])


def _listed(what, label, form):
    text = subprocess.run(["docker", *what.split(), "--filter", f"label={label}", "--format", form], text=True,
                          check=False, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
    return [line.split(" ", 1) for line in text.splitlines() if " " in line]


def _quietly(*argv):
    subprocess.run(argv, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def _remove_images(mark, tags):
    """The tagged ones, and those that building them has left."""
    _quietly("docker", "image", "rm", "--force", *tags)
    _quietly("docker", "image", "prune", "--force", "--filter", f"label=rabit.build={mark}")
