"""Puts the module that CMake compiles into a wheel.

TELLTALE_BUILT names a build folder that holds the module already. Without it build/release is brought up to date.
"""

import os
import pathlib
import re
import shutil
import subprocess

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRATCH = ROOT / "build/wheel"  # and not beside the sources


def version():
    return re.search(r"^project\(telltale VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"), re.M)[1]


class BuildByCMake(build_ext):
    def build_extension(self, ext):
        built = os.environ.get("TELLTALE_BUILT")
        if not built:
            built = ROOT / "build/release"
            subprocess.run(["cmake", "--preset", "release"], cwd=ROOT, check=True)
            subprocess.run(["cmake", "--build", built, "--target", "telltale_python"], check=True)
        target = pathlib.Path(self.get_ext_fullpath(ext.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(pathlib.Path(built) / "client/python/telltale" / target.name, target)


SCRATCH.mkdir(parents=True, exist_ok=True)
setup(
    version=version(),
    packages=["telltale"],
    package_data={"telltale": ["py.typed", "*.pyi"]},
    ext_modules=[Extension("telltale._telltale", sources=[])],
    cmdclass={"build_ext": BuildByCMake},
    options={"build": {"build_base": str(SCRATCH)}, "egg_info": {"egg_base": str(SCRATCH)}},
)
