"""Measurements: what synthesis costs, and how that grows. `python -m benchmarks.synthesis --help` says how."""
