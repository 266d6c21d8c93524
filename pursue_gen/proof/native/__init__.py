"""The checker's searches in C++."""
