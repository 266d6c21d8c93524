"""The commands `keys new`, `keys list` and `keys show`."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

import typer

from pursue_gen.cli.console import guarded, info, show, suggest
from pursue_gen.cli.groups import Commands
from pursue_gen.files import shell_quoted

keys = typer.Typer(
    cls=Commands,
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Keys that missions are signed with: robots take missions from those whose public key they have.",
    epilog="For example: pursue-gen keys new lab",
)

FOLDER = typer.Option(
    None, "--folder", metavar="DIR", help="Where the keys are; ~/.config/pursue/keys by default (XDG_CONFIG_HOME)."
)


@keys.command(epilog="For example: pursue-gen keys new lab")
@guarded
def new(
    name: str = typer.Argument(..., metavar="NAME", help="What the key is called, such as your name or your lab's."),
    folder: Optional[Path] = FOLDER,
    force: bool = typer.Option(False, "--force", help="Replace the key of this name."),
) -> None:
    """Make a pair of keys: NAME.key, which stays here, and NAME.pub, which the robots get.

    The private key's file is printed on stdout.
    """
    from pursue_gen.tools.transport.keys import keys_folder, new_key

    private, public = new_key(name, folder or keys_folder(), force)
    print(private)
    info(f"{private} signs missions: keep it to yourself.")
    info(f"{public} goes to every robot, into $ROS_HOME/pursue/keys (~/.ros/pursue/keys).")
    copied = f"ssh robot1 mkdir -p .ros/pursue/keys && scp {shell_quoted(public)} robot1:.ros/pursue/keys/"
    suggest(copied, "pursue-gen bundle SCENARIO.pur")


@keys.command("list", epilog="For example: pursue-gen keys list")
@guarded
def list_(folder: Optional[Path] = FOLDER) -> None:
    """List the keys: name, fingerprint, and whether missions can be signed with it here."""
    from pursue_gen.tools.transport.keys import key_names, keys_folder, public_keys
    from pursue_runtime.bundle import fingerprint

    place = folder or keys_folder()
    found, findings = public_keys(place)
    private = key_names(place)
    show(findings)
    for name, key in found.items():
        print(f"{name:20}  {fingerprint(key)}  {'private and public' if name in private else 'public only'}")
    if not found:
        info(f"There is no key in {place}.")
        suggest("pursue-gen keys new NAME")


@keys.command("show", epilog="For example: pursue-gen keys show lab")
@guarded
def show_(
    name: str = typer.Argument(..., metavar="NAME", help="The key's name."), folder: Optional[Path] = FOLDER
) -> None:
    """Print a key's public half: one line, which is what NAME.pub holds."""
    from pursue_gen.tools.transport.keys import keys_folder, load_public
    from pursue_runtime.bundle import fingerprint, write_public_key

    key = load_public(name, folder or keys_folder())
    print(write_public_key(key, name), end="")
    info(f"Its fingerprint is {fingerprint(key)}.")
    info(f"Put the line into a file {name}.pub in $ROS_HOME/pursue/keys (~/.ros/pursue/keys) on every robot.")
