"""Installs the generator with its templates and dependencies; builds the native solver where a C++17 compiler is found,
else says so."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from typing import Any, List

from setuptools import setup
from setuptools.command.build_ext import build_ext
from setuptools.command.build_py import build_py

sys.path.insert(0, str(Path(__file__).resolve().parent))  # not every installer runs this file with its folder there
from pursue_gen.needs import NEEDS

TEMPLATES = "templates/catkin"
PAGES = "docs/diagnostics"
EXAMPLES = "scenarios"


EXTENSIONS = {
    "pursue_gen.synthesis.native._core": "pursue_gen/synthesis/native/module.cpp",
    "pursue_gen.proof.native._proof": "pursue_gen/proof/native/module.cpp",
    "pursue_gen.zones.native._zones": "pursue_gen/zones/native/module.cpp",
}
"""The native solver, the native checker, and their zone library for tests."""


def native_modules() -> List[Any]:
    """The extensions, or nothing where pybind11 is missing."""
    try:
        from pybind11.setup_helpers import Pybind11Extension
    except ImportError:
        excuse("pybind11 is missing")
        return []
    modules = [
        Pybind11Extension(
            name,
            [source],
            include_dirs=["pursue_gen"],
            depends=sorted(header.as_posix() for header in Path("pursue_gen").rglob("*.hpp")),
            cxx_std=17,
            extra_compile_args=["-O3", "-g0", "-fno-stack-protector"],
        )
        for name, source in EXTENSIONS.items()
    ]
    for module in modules:
        module.optional = True  # setuptools then goes on without it
    return modules


def excuse(reason: object) -> None:
    """Why there is no native solver, and what to do."""
    print(
        f"pursue-gen: the native solver and checker were not built ({reason}).\n"
        "pursue-gen: install a C++17 compiler (Debian: g++ python3-dev) and install again; until then nothing can be\n"
        "pursue-gen: solved.",
        file=sys.stderr,
    )


class OptionalBuild(build_ext):
    """Builds solver and checker if it can, at the same time; without them nothing is solved, but all else works."""

    def initialize_options(self) -> None:
        """Options as they are, but for as many compilers as there are processors."""
        super().initialize_options()
        self.parallel = True

    def run(self) -> None:
        """Never fails the installation."""
        try:
            super().run()
        except Exception as problem:  # whatever the compiler or its absence raises
            excuse(problem)

    def build_extension(self, ext: Any) -> None:
        """Never fails the installation."""
        try:
            super().build_extension(ext)
        except Exception as problem:  # as above
            excuse(problem)


class WithTemplates(build_py):
    """Puts the templates of catkin packages, the pages on messages and the scenarios beside the modules.

    An editable installation finds them in the checkout.
    """

    def run(self) -> None:
        """Copies what pursue_gen.workspace.templates_dir, .cli.explain and .tools.authoring.examples look for."""
        super().run()
        if getattr(self, "editable_mode", False):
            return
        stories = ("*.md", "*.png", "*.svg")  # of the scenarios themselves only
        parts = ((TEMPLATES, "_templates", ()), (PAGES, "_diagnostics", ()), (EXAMPLES, "_scenarios", stories))
        for folder, name, left_out in parts:
            target = Path(self.build_lib) / "pursue_gen" / name
            shutil.rmtree(target, ignore_errors=True)  # nothing of an earlier build stays
            shutil.copytree(folder, str(target), ignore=shutil.ignore_patterns("__pycache__", ".*", *left_out))


setup(
    install_requires=[need.requirement for need in NEEDS],
    ext_modules=native_modules(),
    cmdclass={"build_ext": OptionalBuild, "build_py": WithTemplates},
)
