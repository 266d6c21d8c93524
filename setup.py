"""Installs the generator; builds the native solver where a C++17 compiler is found, and says so where not."""

from __future__ import annotations

from setuptools import setup
from setuptools.command.build_ext import build_ext


def native_modules():  # type: ignore[no-untyped-def]
    """The extension, or nothing where pybind11 is missing."""
    try:
        from pybind11.setup_helpers import Pybind11Extension
    except ImportError:
        print("pursue-gen: pybind11 is missing, the native solver is not built; the slower Python solver serves")
        return []
    core = "pursue_gen/synthesis/core"
    headers = [f"{core}/{name}.hpp" for name in ("dbm", "federation", "game", "relaxed", "solver")]
    module = Pybind11Extension(
        "pursue_gen.synthesis._core",
        [f"{core}/module.cpp"],
        depends=headers,
        cxx_std=17,
        extra_compile_args=["-O2", "-g0"],
    )
    return [module]


class OptionalBuild(build_ext):
    """Builds the native solver if it can; without it the Python reference serves."""

    def run(self) -> None:
        """Never fails the installation."""
        try:
            super().run()
        except Exception as problem:  # whatever the compiler or its absence raises
            self._excuse(problem)

    def build_extension(self, ext) -> None:  # type: ignore[no-untyped-def]
        """Never fails the installation."""
        try:
            super().build_extension(ext)
        except Exception as problem:  # as above
            self._excuse(problem)

    @staticmethod
    def _excuse(problem: Exception) -> None:
        print(f"pursue-gen: the native solver was not built ({problem}).")
        print("pursue-gen: install a C++17 compiler (Debian: g++ python3-dev) and install again; until then the slower")
        print("pursue-gen: Python solver serves.")


setup(ext_modules=native_modules(), cmdclass={"build_ext": OptionalBuild})
