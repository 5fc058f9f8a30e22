# SPDX-License-Identifier: BSD-3-Clause
from ._checks import Array

SIGNATURE: str

def page(
    x: Array,
    y: Array,
    z: Array,
    labels: Array,
    boxes: Array,
    is_ground: Array,
    intensity: Array,
    seen_by_camera: bool,
    tolerance: float,
    name: str,
) -> str: ...
