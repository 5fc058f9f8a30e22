# SPDX-License-Identifier: BSD-3-Clause
"""Builds the extension of the Python package by CMake; pyproject.toml has the rest. CMAKE_ARGS adds options."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent


class BuildByCMake(build_ext):
    def build_extension(self, extension):
        build = Path(self.build_temp).resolve() / "cmake"
        options = [
            "-DCMAKE_BUILD_TYPE=Release",
            "-DBUILD_SHARED_LIBS=OFF",
            "-DLISCO_BUILD_PCL=OFF",
            "-DLISCO_BUILD_PYTHON=ON",
            "-DLISCO_INSTALL=OFF",
            f"-DPython3_EXECUTABLE={sys.executable}",
        ]
        try:
            import pybind11

            options.append(f"-Dpybind11_DIR={pybind11.get_cmake_dir()}")
        except ImportError:
            pass  # CMake finds the system's
        options += shlex.split(os.environ.get("CMAKE_ARGS", ""))
        subprocess.run(["cmake", "-S", ROOT, "-B", build, *options], check=True)
        subprocess.run(["cmake", "--build", build, "--parallel", "--target", "lisco_python_modules"], check=True)
        target = Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        for made in (build / "python" / "lisco").glob("_*.so"):
            self.copy_file(str(made), str(target.parent / made.name))


version = re.search(r"project\(lisco VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
setup(version=version, ext_modules=[Extension("lisco._core", sources=[])], cmdclass={"build_ext": BuildByCMake})
