"""Docker's work without Docker, for root: the steps of docker/Dockerfile.debian are executed on a Debian 12 that
debootstrap makes, one overlay for each as in an image; then the services of compose.yaml run from these images in a
network of their own, as users without rights on read-only roots, until the UI ends.

    python debian_image.py WORKSPACE FOLDER

prints what was found as JSON; the exit status is 0 if the mission reached its goal. All mounts are in namespaces of
processes that have ended when it returns: FOLDER can be deleted.
"""

from __future__ import annotations

import contextlib
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Tuple

import yaml

MIRROR = "http://deb.debian.org/debian"
PATH = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
Instruction = Tuple[str, str]


@dataclass(frozen=True)
class Image:
    """Layers, the lowest first, and what the instructions without layers say."""

    layers: Tuple[str, ...]
    environment: Mapping[str, str] = field(default_factory=dict)
    arguments: Mapping[str, str] = field(default_factory=dict)
    workdir: str = "/"
    user: str = "0:0"
    entrypoint: Tuple[str, ...] = ()


def instructions(text: str) -> List[Instruction]:
    """(word, rest) of each instruction of a Dockerfile; comments are left out, continued lines are joined."""
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    joined = re.sub(r"\\\n\s*", " ", "\n".join(lines))
    return [(line.split(None, 1)[0], line.split(None, 1)[1]) for line in joined.splitlines()]


def interpolated(value: Any, variables: Mapping[str, str]) -> Any:
    """Compose's ${NAME:-default} in every text."""
    if isinstance(value, str):
        return re.sub(r"\$\{(\w+):-([^}]*)\}", lambda m: variables.get(m[1]) or m[2], value)
    if isinstance(value, list):
        return [interpolated(one, variables) for one in value]
    return {key: interpolated(one, variables) for key, one in value.items()} if isinstance(value, dict) else value


def call(*words: str) -> None:
    """Runs a program to its end; what it says is told when it fails."""
    silent = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    done = subprocess.run(words, text=True, errors="replace", check=False, **silent)
    if done.returncode:
        raise SystemExit(f"{shlex.join(words)}: exit status {done.returncode}\n{done.stdout[-8000:]}")


def inside(root: Path, image: Image, words: List[str], more: Mapping[str, str]) -> List[str]:
    """The words that run a program in a root: as root while it is built, else without any rights."""
    uid, gid = image.user.split(":")
    bare = ["setpriv", "--no-new-privs", "--bounding-set=-all", f"--reuid={uid}", f"--regid={gid}", "--clear-groups"]
    variables = {"PATH": PATH, "HOME": "/", **image.environment, **more}
    set_up = ["env", "-i", "-C", image.workdir, *(f"{name}={value}" for name, value in variables.items())]
    return ["chroot", str(root), *([] if uid == "0" else bare), *set_up, *words]


class Builder:
    """Builds images in a folder; a step that was done before on the same layers is not done again."""

    def __init__(self, folder: Path, context: Path) -> None:
        self.folder, self.context = folder, context
        self.done: Dict[Tuple[str, ...], str] = {}
        self.seconds: Dict[str, float] = {}

    def build(self, dockerfile: str, arguments: Mapping[str, str]) -> Image:
        """The image of the last stage."""
        stages: Dict[str, Image] = {}
        image, name = Image(()), ""
        for word, rest in instructions(dockerfile):
            if word == "FROM":
                base, _, name = rest.partition(" AS ")
                image = replace(stages.get(base) or Image((self.base(base),)), arguments={})
            else:
                image = self.step(image, word, rest, arguments, stages)
            stages[name] = image
        return image

    def base(self, name: str) -> str:
        """Debian 12, as small as an image of it."""
        assert name == "debian:12", name
        place = self.folder / "base"
        if not place.is_dir():
            begin = time.monotonic()
            part = self.folder / "base.part"
            call("debootstrap", "--variant=minbase", "bookworm", str(part), MIRROR)
            part.rename(place)
            self.seconds["debootstrap"] = time.monotonic() - begin
        return str(place)

    def step(self, image: Image, word: str, rest: str, given: Mapping[str, str], stages: Mapping[str, Image]) -> Image:
        """The image after an instruction."""
        if word == "ENV":
            name, _, value = rest.partition("=")
            return replace(image, environment={**image.environment, name: value})
        if word == "ARG":
            return replace(image, arguments={**image.arguments, rest: given[rest]})
        if word == "USER":
            return replace(image, user=rest)
        if word == "ENTRYPOINT":
            return replace(image, entrypoint=tuple(json.loads(rest)))
        if word == "CMD":
            return image
        if word == "WORKDIR":
            image = replace(image, workdir=rest)
        key = (*image.layers, word, rest, json.dumps(dict(image.arguments)))
        if word == "COPY" and rest.startswith("--from="):  # another image may be behind the same words
            key += stages[rest[len("--from=") :].split()[0]].layers
        if key not in self.done:
            begin = time.monotonic()
            self.done[key] = self.layer(image, word, rest, stages)
            self.seconds[f"{len(self.done)} {word} {rest[:50]}"] = time.monotonic() - begin
        return replace(image, layers=(*image.layers, self.done[key]))

    def layer(self, image: Image, word: str, rest: str, stages: Mapping[str, Image]) -> str:
        """What RUN, COPY or WORKDIR change, as a folder."""
        upper = self.folder / f"layer{len(self.done)}"
        with mounted(image, self.folder, f"step{len(self.done)}", upper) as root:
            if word == "RUN":
                (root / "etc/resolv.conf").touch()
                call("mount", "--bind", "/etc/resolv.conf", str(root / "etc/resolv.conf"))
                more = {**image.arguments, "DEBIAN_FRONTEND": "noninteractive"}
                call(*inside(root, replace(image, user="0:0"), ["/bin/sh", "-c", rest], more))
            elif word == "COPY":
                self.copy(image, root, rest, stages)
            else:
                (root / rest.lstrip("/")).mkdir(parents=True, exist_ok=True)
        return str(upper)

    def copy(self, image: Image, root: Path, rest: str, stages: Mapping[str, Image]) -> None:
        """COPY of one folder: its content goes into the target."""
        *options, source, target = rest.split()
        place = root / os.path.join(image.workdir, target).lstrip("/")
        if not options:
            shutil.copytree(str(self.context / source), str(place))
            return
        other = stages[options[0][len("--from=") :]]
        with mounted(other, self.folder, "copied", self.folder / "nothing") as there:
            shutil.copytree(str(there / source.lstrip("/")), str(place), symlinks=True)


@contextlib.contextmanager
def mounted(image: Image, folder: Path, name: str, upper: Path) -> Iterator[Path]:
    """The root of an image, with `upper` for what is written; unmounted afterwards."""
    root, work = folder / f"{name}.root", folder / f"{name}.work"
    for place in (root, work, upper):
        place.mkdir(exist_ok=True)
    lower = ":".join(reversed(image.layers))
    call("mount", "-t", "overlay", "overlay", "-o", f"lowerdir={lower},upperdir={upper},workdir={work}", str(root))
    try:
        call("mount", "-t", "proc", "proc", str(root / "proc"))
        yield root
    finally:
        call("umount", "--recursive", "--lazy", str(root))


def build(workspace: Path, folder: Path) -> Dict[str, Any]:
    """The images of all services that start by themselves: layers and the rest, and how long it took."""
    services = started(workspace)
    dockerfile = (workspace / "docker" / "Dockerfile.debian").read_text(encoding="utf-8")
    builder = Builder(folder, workspace / "src")
    images = {}
    for name, service in services.items():
        assert service["build"]["dockerfile"] == "../docker/Dockerfile.debian"
        images[name] = vars(builder.build(dockerfile, service["build"]["args"]))
    return {"images": images, "seconds": builder.seconds}


def started(workspace: Path) -> Dict[str, Any]:
    """The services without a profile; ROS's master first."""
    text = (workspace / "docker" / "compose.yaml").read_text(encoding="utf-8")
    compose = interpolated(yaml.safe_load(text), os.environ)
    return {name: service for name, service in compose["services"].items() if "profiles" not in service}


class Run:
    """Services that run, in the namespaces of this process."""

    def __init__(self, workspace: Path, folder: Path, images: Mapping[str, Any]) -> None:
        self.folder, self.services = folder, started(workspace)
        self.images = {name: Image(**image) for name, image in images.items()}
        self.roots: Dict[str, Path] = {}
        self.processes: Dict[str, "subprocess.Popen[bytes]"] = {}
        self.stack = contextlib.ExitStack()
        (folder / "hosts").write_text("127.0.0.1 localhost " + " ".join(self.services) + "\n", encoding="utf-8")
        (folder / "logs").mkdir(exist_ok=True)

    def prepare(self, name: str) -> None:
        """The root of a service: read-only but for its volumes and tmpfs."""
        service, image = self.services[name], self.images[name]
        root = self.stack.enter_context(mounted(image, self.folder, name, self.folder / f"{name}.upper"))
        (root / "etc/hosts").touch()
        call("mount", "--bind", str(self.folder / "hosts"), str(root / "etc/hosts"))
        for volume in service["volumes"]:
            source, target = volume.split(":")[:2]
            place, there = self.folder / f"volume-{source}", root / target.lstrip("/")
            if not place.is_dir():  # as Docker: a new volume looks like what is in the image
                place.mkdir()
                shutil.copystat(str(there), str(place))
                os.chown(place, there.stat().st_uid, there.stat().st_gid)
            call("mount", "--bind", str(place), str(there))
        for target in service["tmpfs"]:
            call("mount", "-t", "tmpfs", "tmpfs", str(root / target.lstrip("/")))
        if service["read_only"]:
            call("mount", "-o", "remount,ro", str(root))
        self.roots[name] = root

    def words(self, name: str, command: List[str]) -> List[str]:
        """A command in the service's container."""
        return inside(self.roots[name], self.images[name], command, self.services[name]["environment"])

    def start(self, name: str) -> None:
        """Starts the service's process."""
        self.prepare(name)
        words = self.words(name, [*self.images[name].entrypoint, *self.services[name]["command"]])
        with open(self.folder / "logs" / f"{name}.log", "wb") as log:
            self.processes[name] = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=log, stderr=log)

    def healthy(self, name: str, patience: float) -> bool:
        """Asks the service's healthcheck until it is content."""
        deadline = time.monotonic() + patience
        words = self.words(name, self.services[name]["healthcheck"]["test"][1:])
        while time.monotonic() < deadline:
            with contextlib.suppress(subprocess.TimeoutExpired):
                if subprocess.run(words, capture_output=True, timeout=patience, check=False).returncode == 0:
                    return True
            time.sleep(0.5)
        return False

    def play(self) -> Dict[str, Any]:
        """The mission: who was healthy, the exit statuses, and how long it took."""
        begin = time.monotonic()
        health: Dict[str, bool] = {}
        others = [name for name in self.services if name not in ("master", "ui")]
        for several in (["master"], others, ["ui"]):  # the UI begins the mission, and with its end all are gone
            for name in several:
                self.start(name)
            health.update((name, self.healthy(name, 120)) for name in several)
        self.processes["ui"].wait(600)
        for name in others:
            with contextlib.suppress(subprocess.TimeoutExpired):
                self.processes[name].wait(60)
        statuses = {name: self.processes[name].poll() for name in self.processes}
        words = self.words("observer", self.services["observer"]["healthcheck"]["test"][1:])
        dead = subprocess.run(words, capture_output=True, timeout=60, check=False).returncode
        return {"healthy": health, "statuses": statuses, "dead": dead, "seconds": time.monotonic() - begin}

    def end(self) -> None:
        """Ends every process, and unmounts."""
        for process in self.processes.values():
            process.terminate()
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(10)
            process.kill()
        self.stack.close()


def in_namespaces(phase: str, workspace: Path, folder: Path) -> Dict[str, Any]:
    """Runs a phase of this script with mounts and processes of its own; `play` has a network of its own, too."""
    words = ["unshare", "--mount", "--propagation", "private", "--pid", "--fork", "--kill-child", "--mount-proc"]
    words += ["--net"] if phase == "play" else []
    words += [sys.executable, __file__, str(workspace), str(folder), phase]
    done = subprocess.run(words, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        raise SystemExit(done.returncode)
    found = json.loads(done.stdout)
    assert isinstance(found, dict)
    return found


def main(arguments: List[str]) -> int:
    """See above."""
    workspace, folder = Path(arguments[0]).resolve(), Path(arguments[1]).resolve()
    phase = arguments[2] if len(arguments) > 2 else ""
    if phase == "build":
        print(json.dumps(build(workspace, folder)))
        return 0
    if phase == "play":
        call("ip", "link", "set", "lo", "up")
        run = Run(workspace, folder, json.loads((folder / "images.json").read_text(encoding="utf-8")))
        try:
            print(json.dumps(run.play()))
        finally:
            run.end()
        return 0
    built = in_namespaces("build", workspace, folder)
    (folder / "images.json").write_text(json.dumps(built["images"]), encoding="utf-8")
    told = {"built": built["seconds"], **in_namespaces("play", workspace, folder)}
    print(json.dumps(told, indent=1))
    return 0 if told["statuses"]["ui"] == 0 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
