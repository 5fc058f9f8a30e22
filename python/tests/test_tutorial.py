# SPDX-License-Identifier: BSD-3-Clause
"""The examples of the manual."""

import runpy
import sys
from pathlib import Path

import lisco
import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")
pytest.importorskip("lisco._reading", reason="made without the programs")
pytest.importorskip("lisco._view", reason="made without zlib or nlohmann-json")

EXAMPLES = Path(__file__).resolve().parents[2] / "doc" / "examples"


def street():
    """A ground 1.7 m below the sensor with a box of 4 x 2 x 1.5 m on it, as KITTI stores scans: (N, 4) float32."""
    azimuths, ranges = np.meshgrid(np.radians(np.arange(0, 360, 0.5)), np.geomspace(3, 60, 70))
    ground = np.stack([ranges * np.cos(azimuths), ranges * np.sin(azimuths), np.full_like(ranges, -1.7)], axis=2)
    ground = ground.reshape(-1, 3)
    ground = ground[~((ground[:, 0] > 8) & (8 * abs(ground[:, 1]) < ground[:, 0]))]  # the box and its shadow
    across, up = np.meshgrid(np.linspace(-1, 1, 40), np.linspace(-1.6, -0.2, 20))
    along, _ = np.meshgrid(np.linspace(8, 12, 80), up[:, 0])
    front = np.stack([np.full_like(across, 8), across, up], axis=2).reshape(-1, 3)
    side = np.stack([along, np.full_like(along, -1), np.repeat(up[:, :1], 80, axis=1)], axis=2).reshape(-1, 3)
    points = np.concatenate([ground, front, side])
    return np.pad(points, ((0, 0), (0, 1))).astype(np.float32)


def test_labelled_boxes_of_a_kitti_file(tmp_path, monkeypatch):
    street().tofile(tmp_path / "street.bin")
    files = [tmp_path / name for name in ("street.bin", "boxes.png", "boxes.html")]
    monkeypatch.setattr(sys, "argv", ["labelled_boxes.py", *map(str, files)])
    result = runpy.run_path(str(EXAMPLES / "labelled_boxes.py"))
    (box,) = result["boxes"]
    # A return of the ground beside the box may be left, which widens it.
    assert box["length"] == pytest.approx(4, abs=0.1) and box["width"] == pytest.approx(2, abs=0.5)
    assert "0: 4.0 m" in [text.get_text() for text in result["ax"].texts]
    assert matplotlib.image.imread(files[1]).shape[0] > 400
    assert files[2].read_text(encoding="utf-8") == lisco.view(
        result["points"], result["labels"], ground=lisco.ground(result["points"]), tolerance=0.5
    ).page
