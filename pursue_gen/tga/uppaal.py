"""UPPAAL's files: networks (`TGA.xml`) and queries (`TCTL.q`)."""

from pursue_gen.tga.uppaal_read import read_network, read_query

__all__ = ["read_network", "read_query"]
