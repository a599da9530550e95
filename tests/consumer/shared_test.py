"""Builds Rabit with shared libraries, installs it, and tries what is installed: each library has a name with the version
of its interface, the programs start without help from the environment, and so do those of projects built against it.
Takes minutes: everything is compiled anew."""

import pathlib
import re
import sys
import tempfile

import consumer

SHARED = ["core", "gateway", "idl", "idl_dynamic", "links"]


def check_names(folder, version):
    """Libraries are found at run time by the version of their interface."""
    for name in SHARED:
        said = consumer.run("objdump", "-p", folder / f"librabit_{name}.so.{version}")
        soname = re.search(r"SONAME\s+(\S+)", said).group(1)
        interface = ".".join(version.split(".")[:2] if version.startswith("0.") else version.split(".")[:1])
        if soname != f"librabit_{name}.so.{interface}":
            sys.exit(f"librabit_{name}.so.{version} is called {soname}")
    print("ok: names of the libraries")


def main():
    cmake, source, version, transports = sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4].split(",")
    consumer.harness.enter_namespace()
    with tempfile.TemporaryDirectory(prefix="rabit_shared_") as folder:
        folder = pathlib.Path(folder)
        build, prefix = folder / "build", folder / "prefix"
        consumer.run(cmake, "-S", source, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                     "-DBUILD_SHARED_LIBS=ON", "-DRABIT_BUILD_TESTS=OFF", "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
        # Nothing can be installed yet, as after a build of some programs.
        said = consumer.run(cmake, "--install", build, "--prefix", prefix, fails=True)
        if f"cmake --build {build} --target rabit_package" not in said:
            sys.exit(f"installing an incomplete build said: {said}")
        print("ok: an incomplete build is refused")
        consumer.run(cmake, "--build", build, "--target", "rabit_package", "uav", "vision", "ground")
        consumer.run(cmake, "--install", build, "--prefix", prefix)
        check_names(prefix / "lib", version)
        # Programs alone, as for an image, bring their libraries along.
        consumer.run(cmake, "--install", build, "--prefix", folder / "image", "--component", "programs")
        for program in ("uav", "vision", "ground"):
            consumer.run(folder / "image/bin" / program, "--help")
        print("ok: the installed programs start")
        programs = consumer.build(cmake, "programs", folder, prefix)
        consumer.run_two_managers(programs / "two_managers")
        consumer.run_types(programs / "types")
        consumer.run_again(programs / "again", folder)
        for transport in transports:
            consumer.exchange(programs / "node", transport, transport)
        consumer.build_template(cmake, folder, prefix)


if __name__ == "__main__":
    main()
