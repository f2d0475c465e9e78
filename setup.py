# SPDX-License-Identifier: Apache-2.0
"""Builds the Python package: `pip install --no-build-isolation .` (docs/python.md). CMake builds
the extension module, in build/release where `make build` has made that for the same Python, else
in build/python."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = pathlib.Path(__file__).resolve().parent
MODULE = "_core" + sysconfig.get_config_var("EXT_SUFFIX")


def version():
    return re.search(r"project\(stillmap VERSION ([\d.]+)",
                     (SOURCE / "CMakeLists.txt").read_text()).group(1)


def is_for_this_python(build):
    """Whether a build folder makes the module of this Python. Ninja's list of targets tells."""
    ninja = build / "build.ninja"
    return ninja.is_file() and f"python/stillmap/{MODULE}" in ninja.read_text()


def configured_build():
    release = SOURCE / "build/release"
    if is_for_this_python(release):
        return release
    build = SOURCE / "build/python"
    subprocess.run(["cmake", "-G", "Ninja", "-S", SOURCE, "-B", build,
                    "-DCMAKE_BUILD_TYPE=Release", "-DSTILLMAP_BUILD_TESTS=OFF",
                    "-DSTILLMAP_BUILD_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}"],
                   check=True)
    return build


class BuildByCMake(build_ext):
    def build_extension(self, extension):
        build = configured_build()
        subprocess.run(["cmake", "--build", build, "--parallel", str(os.cpu_count() or 1),
                        "--target", "stillmap_python"], check=True)
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(build / "python/stillmap" / MODULE, target)
        subprocess.run(["strip", "--strip-unneeded", target], check=True)


setup(version=version(), ext_modules=[Extension("stillmap._core", sources=[])],
      cmdclass={"build_ext": BuildByCMake})
