"""The zone library in C++17, which the native engine is built on; `_zones` binds it for tests."""
