"""`pip install .`: builds the extension module and the program rabit with CMake.

The variable RABIT_BUILD names a build directory that has them already.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]


def version():
    text = (ROOT / "core/include/rabit/RabitVersion.h").read_text()
    return ".".join(re.findall(r"^#define RABIT_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)$", text, re.M))


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        package = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve().parent
        build = os.environ.get("RABIT_BUILD")
        if not build:
            build = pathlib.Path(self.build_temp).resolve()
            build.mkdir(parents=True, exist_ok=True)
            subprocess.run(["cmake", "-G", "Ninja", "-S", ROOT, "-B", build, "-DCMAKE_BUILD_TYPE=Release",
                            "-DRABIT_BUILD_TESTS=OFF", "-DRABIT_BUILD_EXAMPLES=OFF", f"-DRABIT_PYTHON={sys.executable}"],
                           check=True)
            subprocess.run(["cmake", "--build", build, "--target", "rabit_python", "rabit"], check=True)
        (package / "bin").mkdir(parents=True, exist_ok=True)
        shutil.copy(pathlib.Path(build) / "python/rabit/_rabit.so", package / "_rabit.so")
        tool = pathlib.Path(build) / "bin/rabit"
        if tool.exists():
            shutil.copy(tool, package / "bin/rabit")


setup(version=version(), ext_modules=[Extension("rabit._rabit", [])], cmdclass={"build_ext": CMakeBuild})
