"""Bundles, orders and keys: what is signed comes through whole, and nothing else comes through at all."""

from __future__ import annotations

import base64
import dataclasses
import hashlib
import io
import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import Callable, Dict, List, Mapping, Tuple

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

pytest.importorskip("cryptography", reason="cryptography is not installed")

from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

from pursue_gen.workspace.packages import runtime_package
from pursue_runtime import bundle as mb
from pursue_runtime.manifest import OWN, Manifest, is_digest, make_manifest, mission_id

KEY = Ed25519PrivateKey.from_private_bytes(bytes(range(32)))
OTHER = Ed25519PrivateKey.from_private_bytes(bytes(range(1, 33)))
KEYS = {mb.fingerprint(KEY.public_key()): KEY.public_key()}
FILES = {"observer/model.yaml": b"format: 1\n", "UI/poses.yaml": b"poses: {}\n", "controller_bot/strategy.yaml": b""}
TICKET = "0123456789abcdef" * 2
ORDER = mb.Order(mb.PREPARE, "a" * 64, "bot1", TICKET, 17, "b" * 64)

NAMES = st.from_regex(r"[A-Za-z][A-Za-z0-9_]{0,12}", fullmatch=True)
DATA_NAMES = st.from_regex(r"[a-z][a-z0-9_]{0,9}", fullmatch=True).filter(lambda name: name != "mission")
PATHS = st.builds(lambda package, name: f"{package}/{name}.yaml", NAMES, DATA_NAMES)
FILE_SETS = st.dictionaries(PATHS, st.binary(max_size=200), min_size=1, max_size=6)


def manifest_of(files: Mapping[str, bytes]) -> Manifest:
    return make_manifest("thief", "0.1.0", ("controller_bot",), files)


def packed(files: Mapping[str, bytes] = FILES, key: Ed25519PrivateKey = KEY) -> bytes:
    return mb.pack(manifest_of(files), files, key)


def refused(content: bytes, keys: mb.Keys = KEYS, limit: int = mb.LIMIT) -> str:
    """The word for why it is not accepted."""
    with pytest.raises(mb.Refused) as caught:
        mb.unpack(content, keys, limit)
    assert str(caught.value)
    return caught.value.code


def sealed(text: bytes, key: Ed25519PrivateKey = KEY) -> bytes:
    """signature.json for any manifest: what somebody with the key could sign."""
    signature = base64.b64encode(key.sign(b"pursue-mission-1\0" + text)).decode()
    facts = {"format": 1, "key": mb.fingerprint(key.public_key()), "signature": signature}
    return json.dumps(facts, indent=1).encode() + b"\n"


def zipped(entries: List[Tuple[str, bytes]], compression: int = zipfile.ZIP_STORED) -> bytes:
    """As bundles are zipped, but for what is asked; names may stand twice."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        for name, content in entries:
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.create_system, entry.external_attr, entry.compress_type = 3, 0o644 << 16, compression
            archive.writestr(entry, content)
    return out.getvalue()


def signed_by_hand(there: Mapping[str, bytes], **changes: object) -> bytes:
    """A bundle with a right signature on a manifest that `pack` would not write."""
    facts = json.loads(manifest_of(there).text())
    facts.update(changes)
    text = json.dumps(facts, indent=1, sort_keys=True).encode() + b"\n"
    return zipped([(mb.MANIFEST, text), (mb.SIGNATURE, sealed(text)), *sorted(there.items())])


# What is right --------------------------------------------------------------------------------------------------------


@given(FILE_SETS, NAMES, st.lists(NAMES, max_size=3))
def test_what_is_packed_comes_out_whole(files: Dict[str, bytes], scenario: str, controllers: List[str]) -> None:
    manifest = make_manifest(scenario, "1.2.3", tuple(controllers), files)
    content = mb.pack(manifest, files, KEY)
    bundle = mb.unpack(content, KEYS)
    assert (bundle.manifest, dict(bundle.files)) == (manifest, files)
    assert bundle.digest == manifest.digest == hashlib.sha256(manifest.text()).hexdigest()
    assert bundle.signed_by == mb.fingerprint(KEY.public_key())
    backwards = dict(reversed(list(files.items())))
    assert mb.pack(make_manifest(scenario, "1.2.3", tuple(controllers), backwards), backwards, KEY) == content


def test_the_bytes_are_these_on_every_system() -> None:
    """A robot with another Python must make the same archive, or it would refuse every bundle."""
    assert hashlib.sha256(packed()).hexdigest() == "f40b932d8fa0c791ae62e05ae45d6733034fcf95198f257643d1daed607a54dc"
    assert manifest_of(FILES).digest == "f98db10c3bcea4554d25ff2da2e6c574776812cf6ff72656151bbc0abdba2dbd"


def test_a_bundle_is_a_zip_file_that_anybody_can_list() -> None:
    with zipfile.ZipFile(io.BytesIO(packed())) as archive:
        assert archive.namelist() == [mb.MANIFEST, mb.SIGNATURE, *sorted(FILES)]
        assert archive.testzip() is None


@given(FILE_SETS, FILE_SETS)
def test_different_files_have_different_digests(one: Dict[str, bytes], other: Dict[str, bytes]) -> None:
    assert (manifest_of(one).digest == manifest_of(other).digest) == (one == other)


def test_robots_have_the_same_code(tmp_path: Path) -> None:
    """The copy in a workspace needs nothing of pursue_gen, and accepts what the desk packs."""
    for path, content in runtime_package().data.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_bytes(content)
    (tmp_path / "bundle").write_bytes(packed())
    (tmp_path / "lab.pub").write_text(mb.write_public_key(KEY.public_key(), "lab"))
    program = (
        "import sys; sys.path.insert(0, 'src'); from pursue_runtime import bundle as mb; keys, _ = mb.read_keys('.');"
        "print(mb.unpack(open('bundle', 'rb').read(), keys).digest, 'pursue_gen' in sys.modules)"
    )
    environment = {**os.environ, "PYTHONPATH": ""}
    words = [sys.executable, "-c", program]
    done = subprocess.run(words, cwd=str(tmp_path), env=environment, capture_output=True, text=True, check=False)
    assert done.stdout.split() == [manifest_of(FILES).digest, "False"], done.stderr


# What is not ----------------------------------------------------------------------------------------------------------


def test_every_single_byte_counts() -> None:
    content = packed()
    for place in range(len(content)):
        changed = bytearray(content)
        changed[place] ^= 1 << place % 8
        refused(bytes(changed))


@given(st.data())
def test_no_mutation_is_accepted_and_none_raises_anything_else(data: st.DataObject) -> None:
    content = packed()
    start = data.draw(st.integers(0, len(content)))
    end = data.draw(st.integers(start, min(len(content), start + 60)))
    changed = content[:start] + data.draw(st.binary(max_size=60)) + content[end:]
    if changed != content:
        refused(changed)


@given(st.binary(max_size=400))
@example(b"")
@example(b"PK\5\6" + bytes(18))
def test_junk_is_refused(junk: bytes) -> None:
    assert refused(junk) == "bad_bundle"


@pytest.mark.parametrize("cut", [1, 22, 100, 500])
def test_half_a_bundle_is_refused(cut: int) -> None:
    refused(packed()[:-cut])
    refused(packed()[cut:])


@pytest.mark.parametrize("junk", [b"x", b"#!/bin/sh\nrm -rf ~\n", bytes(1000)])
def test_nothing_travels_before_or_behind_a_mission(junk: bytes) -> None:
    assert refused(junk + packed()) == refused(packed() + junk) == "bad_bundle"


def test_nothing_travels_between_the_files() -> None:
    """The list of files is moved back, and its new place told: zip allows it."""
    content = packed()
    end = content.rindex(b"PK\5\6")
    listed = int.from_bytes(content[end + 16 : end + 20], "little")
    tail = bytearray(content[end:])
    tail[16:20] = (listed + 5).to_bytes(4, "little")
    moved = content[:listed] + b"virus" + content[listed:end] + bytes(tail)
    with zipfile.ZipFile(io.BytesIO(moved)) as archive:
        assert archive.testzip() is None
    assert refused(moved) == "bad_bundle"


def test_a_comment_is_refused() -> None:
    out = io.BytesIO(packed())
    with zipfile.ZipFile(out, "a") as archive:
        archive.comment = b"hello"
    assert refused(out.getvalue()) == "bad_bundle"


@pytest.mark.parametrize("compression", [zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_nothing_is_uncompressed(compression: int) -> None:
    text = manifest_of(FILES).text()
    assert refused(zipped([(mb.MANIFEST, text), (mb.SIGNATURE, sealed(text)), *FILES.items()], compression))


def test_a_bomb_does_not_go_off() -> None:
    bomb = zipped([("observer/model.yaml", bytes(50_000_000))], zipfile.ZIP_DEFLATED)
    assert len(bomb) < 100_000 and refused(bomb) == "bad_bundle"


def test_a_file_that_is_there_twice_is_refused() -> None:
    text = manifest_of(FILES).text()
    entries = [(mb.MANIFEST, text), (mb.SIGNATURE, sealed(text)), *sorted(FILES.items())]
    with pytest.warns(UserWarning, match="Duplicate"):
        twice = zipped([*entries, ("observer/model.yaml", b"format: 2\n")])
    assert refused(twice) == "bad_bundle"


def test_zip64_is_refused() -> None:
    text = manifest_of(FILES).text()
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        for name, content in [(mb.MANIFEST, text), (mb.SIGNATURE, sealed(text)), *sorted(FILES.items())]:
            with archive.open(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), "w", force_zip64=True) as stream:
                stream.write(content)
    assert refused(out.getvalue()) == "bad_bundle"


def test_more_files_than_a_mission_can_have_are_refused_unread() -> None:
    many = zipped([(f"p/f{number}.yaml", b"") for number in range(mb.FILES + 3)])
    assert refused(many) == "bad_bundle"
    files = {f"p/f{number}.yaml": b"" for number in range(mb.FILES)}
    assert len(mb.unpack(packed(files), KEYS).files) == mb.FILES
    assert refused(packed({**files, "p/one_more.yaml": b""})) == "bad_bundle"


def test_a_bundle_may_be_as_large_as_the_limit_says() -> None:
    content = packed()
    assert mb.unpack(content, KEYS, len(content)).files == FILES
    assert refused(content, limit=len(content) - 1) == "too_large"


@pytest.mark.parametrize(
    "path",
    [
        "../evil.yaml", "observer/../../evil.yaml", "/etc/evil.yaml", "observer//model.yaml", "./model.yaml",
        "model.yaml",
        "observer/model.yaml/", "observer/sub/model.yaml", "observer\\model.yaml", "C:/model.yaml",
        "observer/.yaml",
        "observer/.model.yaml", "observer/model.py", "observer/model.yaml.sh", "observer/model.yaml\n",
        "observer/mödel.yaml",
        "observer/MODEL.yaml", "observer/mission.yaml", ".ssh/keys.yaml", "-rf/a.yaml", "a b/model.yaml", "",
        f"{'p' * 101}/model.yaml", f"observer/{'m' * 101}.yaml",
    ],
)
def test_a_signed_file_goes_nowhere_else(path: str) -> None:
    """Even who has the key can only send data files, and only to packages."""
    assert refused(packed({**FILES, path: b"x"})) == "bad_bundle"


def test_a_name_with_a_nul_is_refused() -> None:
    files = {"observer/model.yaml": b"x", "observer/a.yaml": b"y"}
    content = packed(files).replace(b"observer/a.yaml", b"observer/\0.yaml")
    assert refused(content) == "bad_bundle"


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"format": 2}, "bad_version"), ({"format": None}, "bad_version"), ({"format": 10**400}, "bad_bundle"),
        ({"scenario": "../x"}, "bad_bundle"), ({"scenario": 7}, "bad_bundle"), ({"scenario": ""}, "bad_bundle"),
        ({"generator": 1}, "bad_bundle"), ({"generator": "1\x1b[31m"}, "bad_bundle"),
        ({"generator": ""}, "bad_bundle"),
        ({"controllers": "all"}, "bad_bundle"), ({"controllers": ["a b"]}, "bad_bundle"),
        ({"controllers": [[]]}, "bad_bundle"),
        ({"files": {}}, "bad_bundle"), ({"files": []}, "bad_bundle"),
        ({"files": {"observer/model.yaml": 1}}, "bad_bundle"),
        ({"files": {"observer/model.yaml": "A" * 64}}, "bad_bundle"), ({"more": 1}, "bad_bundle"),
    ],
)
def test_a_signed_manifest_says_what_it_should_and_no_more(changes: Dict[str, object], code: str) -> None:
    assert mb.unpack(signed_by_hand(FILES), KEYS).files == FILES
    assert refused(signed_by_hand(FILES, **changes)) == code


@pytest.mark.parametrize("text", [b"", b"[]", b"{", b"null", b"[" * 100_000, b"\xff", b'{"format": 1}'])
def test_a_signed_manifest_that_is_none_is_refused(text: bytes) -> None:
    content = zipped([(mb.MANIFEST, text), (mb.SIGNATURE, sealed(text)), *sorted(FILES.items())])
    assert refused(content).startswith("bad_")


def with_seal(change: Callable[[bytes], bytes]) -> bytes:
    text = manifest_of(FILES).text()
    return zipped([(mb.MANIFEST, text), (mb.SIGNATURE, change(sealed(text))), *sorted(FILES.items())])


@pytest.mark.parametrize(
    "change",
    [
        lambda seal: seal + b" ",
        lambda seal: seal.replace(b'"format": 1', b'"format": 1, "note": "hello"'),
        lambda seal: seal.replace(b'"format": 1', b'"format": 2'),
        lambda seal: seal[:-6] + bytes([seal[-6] + 1]) + seal[-5:],  # bits of base64 that say nothing
        lambda seal: b"9" * 10_000_000,
        lambda seal: b"[" * 900,
        lambda seal: b"null",
        lambda seal: b'{"key": [], "signature": {}}',
    ],
)
def test_a_signature_is_written_in_one_way_only(change: Callable[[bytes], bytes]) -> None:
    assert mb.unpack(with_seal(bytes), KEYS).files == FILES
    refused(with_seal(change))


def test_files_that_are_not_those_that_were_signed_are_refused() -> None:
    text = manifest_of(FILES).text()
    head = [(mb.MANIFEST, text), (mb.SIGNATURE, sealed(text))]
    assert refused(zipped([*head, *sorted({**FILES, "UI/poses.yaml": b"poses: 1\n"}.items())])) == "bad_bundle"
    assert refused(zipped([*head, *sorted({**FILES, "UI/more.yaml": b""}.items())])) == "bad_bundle"
    assert refused(zipped([*head, *sorted(FILES.items())[1:]])) == "bad_bundle"
    assert refused(zipped([*head, *sorted(FILES.items(), reverse=True)])) == "bad_bundle"
    for part in (head[:1], head[1:], sorted(FILES.items())):
        assert refused(zipped(part)) == "bad_bundle"


def test_a_key_counts_only_where_it_is_trusted() -> None:
    assert refused(packed(key=OTHER)) == "unknown_key"
    assert refused(packed(), {}) == "unknown_key"
    assert refused(packed(key=OTHER), {mb.fingerprint(OTHER.public_key()): KEY.public_key()}) == "bad_signature"


def test_an_order_is_no_mission() -> None:
    """What is signed as one thing cannot be used as the other."""
    text = manifest_of(FILES).text()
    signature = base64.b64encode(KEY.sign(b"pursue-order-1\0" + text)).decode()
    seal = {"format": 1, "key": mb.fingerprint(KEY.public_key()), "signature": signature}
    content = json.dumps(seal, indent=1).encode() + b"\n"
    assert refused(zipped([(mb.MANIFEST, text), (mb.SIGNATURE, content), *sorted(FILES.items())])) == "bad_signature"


# Orders ---------------------------------------------------------------------------------------------------------------


def order_refused(text: str, keys: mb.Keys = KEYS) -> str:
    with pytest.raises(mb.Refused) as caught:
        mb.read_order(text, keys)
    return caught.value.code


def forged(**changes: object) -> str:
    """An order with a right signature that `write_order` would not write."""
    body = json.dumps({"format": 1, **dataclasses.asdict(ORDER), **changes}, sort_keys=True).encode()
    parts = (body, KEY.sign(b"pursue-order-1\0" + body))
    said, signature = (base64.urlsafe_b64encode(part).decode() for part in parts)
    return f"{said}.{mb.fingerprint(KEY.public_key())}.{signature}"


DIGESTS = st.binary(min_size=32, max_size=32).map(bytes.hex)
OWN_TOO = st.one_of(DIGESTS, st.just(OWN))
ORDERS = st.one_of(
    st.builds(mb.Order, st.sampled_from(mb.ACTIONS), OWN_TOO, st.text(max_size=60), st.just(TICKET)),
    st.builds(mb.Order, st.just(mb.PREPARE), DIGESTS, NAMES, st.just(TICKET), st.integers(1, 2**40), DIGESTS),
)


@given(ORDERS)
def test_an_order_comes_through(order: mb.Order) -> None:
    text = mb.write_order(order, KEY)
    assert mb.read_order(text, KEYS) == order
    assert text.isascii() and " " not in text  # it travels in a header


def test_every_single_letter_of_an_order_counts() -> None:
    text = mb.write_order(ORDER, KEY)
    for place, letter in enumerate(text):
        for other in ("A", "B", ".", "+", "=", "\n", "é"):
            if other != letter:
                order_refused(text[:place] + other + text[place + 1 :])
        order_refused(text[:place] + text[place + 1 :])


@given(st.text(max_size=200))
@example("..")
@example("A.B.C")
@example("." * 4096)
def test_junk_is_no_order(junk: str) -> None:
    assert order_refused(junk) in ("bad_order", "unknown_key")


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"format": 2}, "bad_version"), ({"action": "explode"}, "bad_order"), ({"action": []}, "bad_order"),
        ({"mission": "a" * 63}, "bad_order"), ({"mission": None}, "bad_order"),
        ({"mission": "../" + "a" * 61}, "bad_order"),
        ({"robot": 1}, "bad_order"), ({"ticket": ""}, "bad_order"), ({"ticket": TICKET.upper()}, "bad_order"),
        ({"size": -1}, "bad_order"), ({"size": True}, "bad_order"), ({"size": 1.5}, "bad_order"),
        ({"size": "17"}, "bad_order"),
        ({"size": 0}, "bad_order"), ({"bundle": ""}, "bad_order"), ({"bundle": "b"}, "bad_order"),
        ({"action": "commit"}, "bad_order"), ({"action": "abort"}, "bad_order"), ({"mission": ""}, "bad_order"),
    ],
)
def test_a_signed_order_says_what_it_should(changes: Dict[str, object], code: str) -> None:
    assert mb.read_order(forged(), KEYS) == ORDER
    assert order_refused(forged(**changes)) == code


def test_who_gives_an_order_must_be_trusted() -> None:
    text = mb.write_order(ORDER, OTHER)
    assert order_refused(text) == "unknown_key"
    said, _, signature = text.split(".")
    assert order_refused(f"{said}.{mb.fingerprint(KEY.public_key())}.{signature}") == "bad_signature"


def test_an_order_that_is_too_long_is_not_looked_at() -> None:
    robot = "r" * mb.ORDER_LENGTH
    assert order_refused(mb.write_order(dataclasses.replace(ORDER, robot=robot), KEY)) == "bad_order"


def test_tickets_are_never_the_same() -> None:
    tickets = {mb.new_ticket() for _ in range(100)}
    assert len(tickets) == 100
    for ticket in tickets:
        order = dataclasses.replace(ORDER, ticket=ticket)
        assert mb.read_order(mb.write_order(order, KEY), KEYS) == order


# Keys -----------------------------------------------------------------------------------------------------------------


@given(st.binary(min_size=32, max_size=32), st.from_regex(r"[a-z][a-z0-9 _-]{0,20}[a-z0-9]", fullmatch=True))
def test_a_public_key_is_one_line(seed: bytes, name: str) -> None:
    key = Ed25519PrivateKey.from_private_bytes(seed).public_key()
    line = mb.write_public_key(key, name)
    again, whose = mb.read_public_key(line)
    assert (mb.fingerprint(again), whose) == (mb.fingerprint(key), name)
    assert line.count("\n") == 1 and line.endswith("\n")


@pytest.mark.parametrize(
    "text",
    [
        "", "pursue-ed25519", "pursue-ed25519 AAAA lab", "ssh-ed25519 AAAAC3NzaC1lZDI1NTE5AAAAI me",
        "pursue-ed25519 é x",
        mb.write_public_key(KEY.public_key(), "a") + mb.write_public_key(OTHER.public_key(), "b"),
        "-----BEGIN PRIVATE KEY-----\n",
    ],
)
def test_what_is_no_public_key_is_refused(text: str) -> None:
    with pytest.raises(mb.Refused) as caught:
        mb.read_public_key(text)
    assert caught.value.code == "bad_key"


@given(st.text(max_size=120))
def test_no_text_makes_reading_a_key_fail_otherwise(text: str) -> None:
    with pytest.raises(mb.Refused):
        mb.read_public_key(text)


def test_a_folder_of_keys_is_read_with_what_is_wrong_in_it(tmp_path: Path) -> None:
    assert mb.read_keys(str(tmp_path / "none")) == ({}, [])
    (tmp_path / "lab.pub").write_text(mb.write_public_key(KEY.public_key(), "lab"))
    (tmp_path / "friend.pub").write_text(mb.write_public_key(OTHER.public_key(), "friend"))
    (tmp_path / "note.txt").write_text("not a key")
    (tmp_path / "broken.pub").write_bytes(b"\xff\xfe")
    (tmp_path / "folder.pub").mkdir()
    keys, problems = mb.read_keys(str(tmp_path))
    assert set(keys) == {mb.fingerprint(KEY.public_key()), mb.fingerprint(OTHER.public_key())}
    assert len(problems) == 2 and "broken.pub" in problems[0] and "folder.pub" in problems[1]


def test_short_names_of_missions() -> None:
    digest = manifest_of(FILES).digest
    assert mission_id(digest) == digest[:12] and mission_id(OWN) == "own"
    assert is_digest(digest) and not is_digest(digest.upper()) and not is_digest(None)
    assert not is_digest(digest + "\n")
