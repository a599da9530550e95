"""Makes the Debian packages from the build, unpacks them into a root of their own, builds the template against what is
there, and starts the ground station of the package. docker/debian/README.md lists what is in them: that is compared."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import consumer

README = consumer.HERE.parents[1] / "docker" / "debian" / "README.md"


def make_packages(cmake, build, folder):
    """The packages by their names."""
    consumer.run(pathlib.Path(cmake).parent / "cpack", "--config", build / "CPackConfig.cmake", "-B", folder)
    return {path.name.split("_")[0]: path for path in folder.glob("*.deb")}


def field(package, name):
    return consumer.run("dpkg-deb", "-f", package, name).strip()


def files(package):
    """The files in a package, with the headers and CMake files of one folder as one line, as the README has them."""
    listed = subprocess.run(["dpkg-deb", "--fsys-tarfile", package], stdout=subprocess.PIPE, check=True)
    names = subprocess.run(["tar", "-t"], input=listed.stdout, stdout=subprocess.PIPE, check=True).stdout.decode()
    found = set()
    for name in names.splitlines():
        name = name.removeprefix(".")
        if not name.endswith("/"):
            found.add(re.sub(r"(/usr/include/rabit(?:/\w+)*|/usr/lib/cmake/Rabit|/usr/lib/rabit/objects-\w+|"
                             r"/usr/share/doc/rabit-doc/html)/.*", r"\1/", name)
                      if not name.endswith(".so") else name)
    return found


def files_in_readme(name):
    """The indented lines below the heading of that package."""
    section = re.search(rf"^## {re.escape(name)}\n(.*?)(?=^## |\Z)", README.read_text(), re.M | re.S)
    return set(re.findall(r"^    (/\S+)", section.group(1), re.M)) if section else set()


def compare_with_readme(packages):
    for name, package in packages.items():
        packed, said = files(package), files_in_readme(name)
        if packed != said:
            sys.exit(f"{README} and {name} differ: only in the package {sorted(packed - said)}, "
                     f"only in the README {sorted(said - packed)}")
    print(f"ok: the files of {', '.join(sorted(packages))}")


def check_dependencies(packages):
    version = field(packages["librabit-dev"], "Version")
    if f"rabit-tools (= {version})" not in field(packages["librabit-dev"], "Depends"):
        sys.exit("librabit-dev does not ask for the generator of its own version")
    if "cyclonedds-tools" not in field(packages["rabit-tools"], "Depends"):
        sys.exit("rabit-tools does not ask for idlc")
    for name in ("rabit-tools", "rabit-ground-station", "python3-rabit"):
        if name in packages and "libstdc++6" not in field(packages[name], "Depends"):
            sys.exit(f"{name} does not say what libraries it needs")
    print("ok: dependencies")


def check_rules(packages):
    """Debian's rules, as lintian knows them; docker/debian/overrides says which are broken, and why."""
    if shutil.which("lintian") is None:
        sys.exit("lintian is missing; docker/packages-pack.txt lists it")
    consumer.run("lintian", "--no-cfg", "--allow-root", "--fail-on", "error,warning", *packages.values())
    print("ok: lintian")


def main():
    cmake, build = sys.argv[1], pathlib.Path(sys.argv[2])
    consumer.harness.enter_namespace()
    with tempfile.TemporaryDirectory(prefix="rabit_packages_") as folder:
        folder = pathlib.Path(folder)
        packages = make_packages(cmake, build, folder / "packages")
        compare_with_readme(packages)
        check_dependencies(packages)
        check_rules(packages)
        for package in packages.values():
            consumer.run("dpkg-deb", "-x", package, folder / "root")
        usr = folder / "root" / "usr"
        if "rabit-ground-station" in packages:
            consumer.run(usr / "bin/rabit-ground", "--config", usr / "share/rabit/ground.yaml", "--check")
            print("ok: the ground station starts")
        if "python3-rabit" in packages:
            consumer.run("/usr/bin/env", f"PYTHONPATH={usr / 'lib/python3/dist-packages'}", "/usr/bin/python3", "-c",
                         "import rabit; print(rabit.__version__, rabit.transports())")
            print("ok: the Python package is imported")
        consumer.build_template(cmake, folder, usr)


if __name__ == "__main__":
    main()
