"""What is decided a second time, by readable code in Python: tests and benchmarks compare the product with it."""

from __future__ import annotations

from typing import Dict

from pursue_gen.synthesis.engine import Engine
from pursue_gen.synthesis.native.engine import NativeEngine
from tests.oracle.engine import ReferenceEngine

ENGINES: Dict[str, Engine] = {"native": NativeEngine(), "python": ReferenceEngine()}
"""The product's engine and its readable twin, by the names that tests have for them."""
