"""The commands of the tools, one file each, as those of the pipeline in `pursue_gen.cli`."""
