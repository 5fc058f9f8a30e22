# SPDX-License-Identifier: BSD-3-Clause
"""Files and recordings."""

import lisco
import numpy as np
import pytest
from scipy.spatial import cKDTree

pytest.importorskip("lisco._reading", reason="made without the programs")


def write_pcd(path, scan):
    """An organized ASCII PCD."""
    rows, columns = scan.shape[:2]
    header = f"FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {columns}\nHEIGHT {rows}\n"
    lines = "\n".join(" ".join(f"{value:.9g}" for value in point) for point in scan.reshape(-1, 3))
    path.write_text(f"{header}VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {rows * columns}\nDATA ascii\n{lines}\n")


def test_clouds_are_read_as_they_are_organized(rng, tmp_path):
    scan = rng.normal(size=(4, 10, 3)).astype(np.float32)
    write_pcd(tmp_path / "scan.pcd", scan)
    assert np.array_equal(lisco.read(tmp_path / "scan.pcd"), scan)
    np.concatenate([scan.reshape(-1, 3), np.ones((40, 1), np.float32)], axis=1).tofile(tmp_path / "scan.bin")
    points = lisco.read(str(tmp_path / "scan.bin"))
    assert points.dtype == np.float32 and np.array_equal(points, scan.reshape(-1, 3))


def test_unreadable_files_are_errors(tmp_path):
    with pytest.raises(FileNotFoundError, match="missing.pcd: does not exist"):
        lisco.read(tmp_path / "missing.pcd")
    for name, content in (("scan.xyz", b"1 2 3"), ("scan.pcd", b"no cloud"), ("empty.pcd", b"")):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(ValueError, match=name):
            lisco.read(tmp_path / name)
    (tmp_path / "broken.pcap").write_bytes(b"no capture")
    for name in ("broken.pcap", "broken.mcap", "broken.bag", "broken.db3"):
        (tmp_path / name).write_bytes(b"no recording")
        with pytest.raises(ValueError, match=name):
            list(lisco.read(tmp_path / name, sensor="vlp16"))
    with pytest.raises(TypeError):
        lisco.read(3)
    with pytest.raises(ValueError, match="only a recording"):
        lisco.read(tmp_path / "scan.pcd", sensor="vlp16")


def test_kitti_scans_are_their_floats(data):
    file = data / "kitti" / "0000000000.bin"
    assert np.array_equal(lisco.read(file), np.fromfile(file, dtype=np.float32).reshape(-1, 4)[:, :3])


def test_captures_are_rotations(data):
    rotations = list(lisco.read(data / "captures" / "hdl32e_outdoor.pcap", sensor="hdl32e"))
    assert 16 <= len(rotations) <= 19
    whole = rotations[5]
    assert whole.shape[0] == 32 and 1500 < whole.shape[1] < 2500 and whole.shape[2] == 4
    expected = lisco.read(data / "scans" / "hdl32e_outdoor_0.pcd")
    assert 0.8 < np.isfinite(whole[..., 0]).sum() / np.isfinite(expected[..., 0]).sum() < 1.2


def without_packets(capture, left_out, file):
    """A copy of a capture without some of its packets, counted from 0, or from the end."""
    content = capture.read_bytes()
    records, at = [], 24
    while at < len(content):
        size = 16 + int.from_bytes(content[at + 8 : at + 12], "little")
        records.append(content[at : at + size])
        at += size
    for number in sorted((n % len(records) for n in left_out), reverse=True):
        del records[number]
    file.write_bytes(content[:24] + b"".join(records))
    return file


def test_captures_are_cut_and_put_in_order_as_by_the_programs(data, tmp_path):
    late = data / "ouster" / "OS-1-32-G_v2.1.1_1024x10.pcap"
    for name, left_out, columns in (
        (late, (-4,), [1008]),  # the last packets wait for it
        (data / "ouster" / "OS-1-128_v2.3.0_1024x10_lb_n3.pcap", range(20), [752, 1024, 1024]),  # frames
    ):
        metadata = next(file for file in sorted(name.parent.glob("*.json")) if file.stem in name.stem)
        capture = without_packets(name, left_out, tmp_path / "part.pcap")
        scans = list(lisco.read(capture, sensor="ouster", metadata=metadata))
        assert [scan.shape[1] for scan in scans] == columns


def test_streams_of_captures_are_clustered_rotations(data):
    capture = data / "captures" / "vlp16_street.pcap"
    rotations = list(lisco.stream(capture, 0.4, sensor="vlp16", min_size=10))
    points = list(lisco.read(capture, sensor="vlp16"))
    assert len(rotations) == len(points) > 0
    for rotation, expected in zip(rotations, points):
        assert np.array_equal(rotation.points, expected, equal_nan=True)
        assert np.array_equal(rotation.labels, lisco.cluster(expected, 0.4, 10))


def test_endless_streams_of_captures_hold_each_return_once(data):
    capture = data / "captures" / "vlp16_street.pcap"
    returns = sum(int(np.isfinite(scan[..., 0]).sum()) for scan in lisco.read(capture, sensor="vlp16"))
    clusters = list(lisco.endless(capture, 0.4, sensor="vlp16"))
    assert sum(len(cluster.points) for cluster in clusters) == returns
    assert len(clusters) < returns / 4


def test_bags_of_packets_are_rotations(data):
    scans = list(lisco.read(data / "bags" / "vlp16.db3", sensor="vlp16"))
    assert len(scans) > 0 and all(scan.shape[0] in (16, 32) for scan in scans)  # with one or two returns a laser
    expected = lisco.read(data / "bags" / "vlp16_expected.pcd")
    found = np.concatenate([scan[np.isfinite(scan[..., 0])][:, :3] for scan in scans])
    distances = cKDTree(found).query(expected.reshape(-1, 3))[0]
    assert (distances < 0.02).mean() > 0.9


def test_arguments_of_streams_are_checked(data):
    capture = data / "captures" / "vlp16_street.pcap"
    with pytest.raises(ValueError, match="columns_per_rotation is of columns"):
        lisco.stream(capture, 0.4, 100, sensor="vlp16")
    with pytest.raises(ValueError, match="columns_per_turn is of columns"):
        lisco.endless(capture, 0.4, 100, sensor="vlp16")
    with pytest.raises(ValueError, match="only a recording has these"):
        lisco.stream([], 0.4, 100, sensor="vlp16")
    with pytest.raises(ValueError, match="needs columns_per_rotation"):
        lisco.stream([], 0.4)
    with pytest.raises(ValueError, match="port"):
        lisco.read(capture, sensor="vlp16", port=0)


def test_the_sensor_is_found_by_its_packets(data):
    capture = data / "captures" / "hdl32e_outdoor.pcap"
    for found, named in zip(lisco.read(capture), lisco.read(capture, sensor="hdl32e")):
        assert np.array_equal(found, named, equal_nan=True)
