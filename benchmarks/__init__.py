"""Measurements: what synthesis costs, and how that grows. `python benchmarks/synthesis.py --help` says how."""
