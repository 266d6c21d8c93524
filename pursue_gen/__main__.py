"""`python -m pursue_gen` is `pursue-gen`."""

from pursue_gen.cli import main

main()
