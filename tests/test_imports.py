"""Modules import each other in one direction only, for types too (`lint-imports` checks the layers of folders)."""

from __future__ import annotations

import grimp


def test_no_module_imports_what_imports_it() -> None:
    graph = grimp.build_graph("pursue_gen", "pursue_runtime", cache_dir=None)
    graph.remove_import(importer="pursue_gen", imported="pursue_gen.api")  # its names come when they are asked for
    left = {module: graph.find_modules_directly_imported_by(module) for module in graph.modules}
    while ends := [module for module, imported in left.items() if not imported & left.keys()]:
        for module in ends:
            del left[module]
    assert sorted(left) == []
