# SPDX-License-Identifier: BSD-3-Clause
import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

settings.register_profile("lisco", deadline=None, derandomize=True, database=None)
settings.load_profile("lisco")


@pytest.fixture
def rng():
    return np.random.default_rng(1)


@pytest.fixture(scope="session")
def data():
    """The folder of real scans."""
    folder = Path(os.environ.get("LISCO_TEST_DATA", os.environ.get("LISCO_TEST_DATA_DEFAULT", "../shared/data")))
    if not (folder / "scans").is_dir():
        pytest.skip(f"no real scans in {folder}")
    return folder


@pytest.fixture(scope="session")
def kitti(data):
    """Points of a KITTI rotation above the ground, (N, 4) float32."""
    points = np.fromfile(data / "kitti" / "0000000000.bin", dtype=np.float32).reshape(-1, 4)
    return points[points[:, 2] >= -1.3]
