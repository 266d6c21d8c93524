"""Tests of surveys on maps that are drawn here; without numpy and scipy they are skipped."""

import pytest

pytest.importorskip("numpy")
pytest.importorskip("scipy")
