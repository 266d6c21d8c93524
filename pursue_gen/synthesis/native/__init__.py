"""The native engine: C++17 behind pybind11."""
