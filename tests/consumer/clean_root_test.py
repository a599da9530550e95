"""Makes the Debian packages from the build, installs them with what they depend on into a fresh Debian of this
machine's release, and there builds the template and runs its test. Needs root and a mirror of Debian; takes minutes."""

import os
import pathlib
import shutil
import sys
import tempfile

import consumer
import packages_test

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from skipped import skip  # noqa: E402

# The tools of a user beside the packages.
TOOLS = "g++,cmake,ninja-build"


def inside(root, script):
    """Runs a script in the root, with a process list of its own."""
    return consumer.run("unshare", "--mount", "--pid", "--fork", "sh", "-ec",
                        'mount --bind /dev "$0/dev"; mount -t proc proc "$0/proc"; exec chroot "$0" sh -ec "$1"',
                        root, script, env={"PATH": os.environ["PATH"], "DEBIAN_FRONTEND": "noninteractive"})


def main():
    cmake, build = sys.argv[1], pathlib.Path(sys.argv[2])
    if os.geteuid() != 0 or not shutil.which("mmdebstrap"):
        skip("needs root and mmdebstrap", "mmdebstrap")
    with tempfile.TemporaryDirectory(prefix="rabit_root_") as folder:
        folder = pathlib.Path(folder)
        root = folder / "root"
        packages = packages_test.make_packages(cmake, build, folder / "packages")
        consumer.run("mmdebstrap", "--mode=root", "--variant=apt", f"--include={TOOLS}", consumer.harness.debian(), root)
        (root / "packages").mkdir()
        for package in packages.values():
            shutil.copy(package, root / "packages")
        shutil.copytree(consumer.HERE / "project", root / "project")
        shutil.copy("/etc/resolv.conf", root / "etc/resolv.conf")
        inside(root, "apt-get update && apt-get install -y --no-install-recommends /packages/*.deb")
        print("ok: installed", *sorted(packages))
        inside(root, "cmake -S /project -B /build -G Ninja && cmake --build /build")
        inside(root, "rabit-ground --config /usr/share/rabit/ground.yaml --check")
        # Runs without the machine's network.
        consumer.run("unshare", "--net", "--mount", "sh", "-ec",
                     'ip link set lo up multicast on; ip route add 224.0.0.0/4 dev lo; mount --bind /dev "$0/dev"; '
                     'mount --bind /proc "$0/proc"; exec chroot "$0" ctest --test-dir /build --output-on-failure --no-tests=error',
                     root)
        print("ok: the template")
    return 0


if __name__ == "__main__":
    sys.exit(main())
