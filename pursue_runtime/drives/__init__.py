"""Drives that measure how long robots take from place to place, without a mission."""
