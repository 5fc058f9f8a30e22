# SPDX-License-Identifier: BSD-3-Clause
"""Runs over archives by real processes, and the faults they survive."""

import ctypes
import filecmp
import os
import platform
import shutil
import signal
import socket
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

import lisco
import numpy as np
import pytest

distributed = pytest.importorskip("distributed")
psutil = pytest.importorskip("psutil")
pytest.importorskip("lisco._reading", reason="made without the programs")

SCANS, PIECE = 32, 2
COMMAND = [sys.executable, "-m", "lisco.archive"]
OPTIONS = ["--tolerance", "0.4", "--min-size", "5", "--piece", str(PIECE)]
TIMEOUT = 120  # seconds


def write_scans(folder, count, points=20000):
    rng = np.random.default_rng(3)
    folder.mkdir()
    for number in range(count):
        centers = rng.uniform(-40, 40, size=(300, 3))
        scan = centers[rng.integers(300, size=points)] + rng.normal(0, 0.3, size=(points, 3))
        np.concatenate([scan, np.ones((points, 1))], axis=1).astype(np.float32).tofile(folder / f"{number:04d}.bin")
    return folder


@pytest.fixture(scope="module")
def scans(tmp_path_factory):
    return write_scans(tmp_path_factory.mktemp("archive") / "scans", SCANS)


@pytest.fixture(scope="module")
def serial(scans):
    """Results of one process."""
    out = scans.parent / "serial"
    done = run(scans, out, "--workers", "0")
    assert done.returncode == 0, done.stderr
    assert f"{SCANS} scans" in done.stdout and done.stderr == ""
    return out


def run(source, out, *options):
    return subprocess.run(
        [*COMMAND, source, "-o", out, *OPTIONS, *options], capture_output=True, text=True, timeout=TIMEOUT
    )


def start(source, out, *options, environment=None):
    return subprocess.Popen(
        [*COMMAND, source, "-o", out, *OPTIONS, *options],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, **(environment or {})},
    )


def finish(process):
    """The output of a run, which must succeed."""
    out, errors = process.communicate(timeout=TIMEOUT)
    assert process.returncode == 0, errors
    return out


def files_of(folder):
    return sorted(str(path.relative_to(folder)) for path in Path(folder).rglob("*") if path.is_file())


def assert_identical(a, b):
    """Equal files, byte for byte, and nothing else."""
    assert files_of(a) == files_of(b)
    _, different, missing = filecmp.cmpfiles(a, b, files_of(a), shallow=False)
    assert different == missing == []


def wait_until(condition, process=None):
    deadline = time.monotonic() + TIMEOUT
    while not condition():
        assert process is None or process.poll() is None, process.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.005)


def test_results_and_tables_are_no_inputs(tmp_path, scans):
    source = tmp_path / "mixed"
    source.mkdir()
    shutil.copy(scans / "0000.bin", source / "a.bin")
    shutil.copy(scans / "0001.bin", source / "labels.pcd.bin")
    (source / "poses.csv").write_text("rotation,column\n1,0\n")
    (source / "clusters.csv").write_text("id,size\n1,10\n")
    (source / "labels.npy").write_bytes(b"no cloud")
    (source / ".lisco_results").write_text("These files:\nlisco_cluster labels.npy\nlisco_cluster clusters.csv\n")
    for _ in range(2):  # the second run goes on with its own results inside
        done = run(source, source / "out", "--workers", "0")
        assert done.returncode == 0, done.stderr
        assert "2 scans" in done.stdout
    other = run(source, tmp_path / "other", "--workers", "0")
    assert other.returncode == 0 and "2 scans" in other.stdout, other.stderr


def finished_pieces(out):
    return len(list(Path(out).glob("pieces/????????/piece.json")))


def is_at_work(out):
    """Whether some pieces are done and one is being written."""
    return 1 <= finished_pieces(out) < SCANS // PIECE / 2 and any(Path(out).glob("pieces/*.tmp/labels.npz"))


def workers_of(process):
    return [
        child
        for child in psutil.Process(process.pid).children(recursive=True)
        if "spawn_main" in " ".join(child.cmdline())
    ]


def test_results_are_labels_and_a_table_of_clusters(scans, serial):
    table = sqlite3.connect(f"file:{serial / 'clusters.sqlite'}?mode=ro", uri=True)
    rows = table.execute("SELECT id, name, piece, member, points, clusters FROM scans ORDER BY id").fetchall()
    assert [Path(row[1]).name for row in rows] == [f"{number:04d}.bin" for number in range(SCANS)]
    for scan, name, piece, member, points, clusters in rows[::13]:
        cloud = np.fromfile(name, np.float32).reshape(-1, 4)[:, :3]
        expected = lisco.cluster(cloud, 0.4, 5)
        labels = np.load(serial / "pieces" / piece / "labels.npz")[member[: -len(".npy")]]
        assert np.array_equal(labels, expected) and points == len(cloud) and clusters == expected.max() + 1
        found = table.execute("SELECT * FROM clusters WHERE scan = ? ORDER BY cluster", (scan,)).fetchall()
        assert len(found) == clusters
        for row in (found[0], found[-1]):
            members = cloud[expected == row[1]]
            assert row[2] == len(members)
            assert np.allclose(row[3:6], members.mean(axis=0, dtype=np.float64))
            assert np.array_equal(np.float32(row[6:9]), members.min(axis=0))
            assert np.array_equal(np.float32(row[9:12]), members.max(axis=0))


def test_the_table_may_be_left_to_the_pieces(scans, serial, tmp_path):
    out = tmp_path / "out"
    done = run(scans, out, "--workers", "0", "--no-table")
    again = run(scans, serial, "--workers", "0")
    assert done.returncode == again.returncode == 0 and done.stdout.split(" in ")[0] == again.stdout.split(" in ")[0]
    assert not (out / "clusters.sqlite").exists()
    rows = np.concatenate([np.load(file) for file in sorted(out.glob("pieces/*/clusters.npy"))])
    table = sqlite3.connect(f"file:{serial / 'clusters.sqlite'}?mode=ro", uri=True)
    sizes = [size for (size,) in table.execute("SELECT size FROM clusters ORDER BY scan, cluster")]
    assert rows["size"].tolist() == sizes
    assert run(scans, out, "--workers", "0").returncode == 0
    assert_identical(serial, out)


def test_results_do_not_depend_on_workers(scans, serial, tmp_path):
    done = run(scans, tmp_path / "out", "--workers", "2")
    assert done.returncode == 0 and "2 worker processes" in done.stdout
    assert_identical(serial, tmp_path / "out")


def test_a_killed_worker_is_replaced(scans, serial, tmp_path):
    process = start(scans, tmp_path / "out", "--workers", "2")
    wait_until(lambda: is_at_work(tmp_path / "out"), process)
    for worker in workers_of(process)[:1]:
        worker.send_signal(signal.SIGKILL)
    finish(process)
    assert_identical(serial, tmp_path / "out")


def test_the_pieces_of_a_stalled_worker_are_given_to_others(scans, serial, tmp_path):
    ttl = {"DASK_DISTRIBUTED__SCHEDULER__WORKER_TTL": "3s"}
    process = start(scans, tmp_path / "out", "--workers", "2", environment=ttl)
    wait_until(lambda: is_at_work(tmp_path / "out"), process)
    stalled = workers_of(process)[0]
    stalled.send_signal(signal.SIGSTOP)
    finish(process)
    assert not stalled.is_running()
    assert_identical(serial, tmp_path / "out")


def test_a_killed_run_goes_on_where_it_stopped(scans, serial, tmp_path):
    out = tmp_path / "out"
    process = start(scans, out, "--workers", "0")
    wait_until(lambda: is_at_work(out), process)
    process.kill()
    process.communicate()
    assert not (out / "clusters.sqlite").exists()
    before = {path: path.stat().st_mtime_ns for path in out.glob("pieces/????????/labels.npz")}
    assert run(scans, out, "--workers", "0").returncode == 0
    assert before and all(path.stat().st_mtime_ns == changed for path, changed in before.items())
    assert_identical(serial, out)


def test_what_killed_workers_left_is_removed(scans, serial, tmp_path):
    out = tmp_path / "out"
    assert run(scans, out, "--workers", "0").returncode == 0
    (out / "pieces" / "00000099.tmp").mkdir()
    for left in ("pieces/00000099.tmp/labels.npz.tmp", "pieces/lone.tmp"):
        (out / left).write_bytes(b"cut off")
    done = run(scans, out, "--workers", "0")
    assert done.returncode == 0, done.stderr
    assert not list(out.rglob("*.tmp"))
    assert_identical(serial, out)


def test_a_run_started_twice_is_refused(scans, serial, tmp_path):
    out = tmp_path / "out"
    process = start(scans, out, "--workers", "0")
    wait_until(lambda: is_at_work(out), process)
    second = run(scans, out, "--workers", "0")
    assert second.returncode == 2 and "another run is writing into it" in second.stderr
    finish(process)
    assert_identical(serial, out)


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


def test_a_scheduler_may_restart(scans, serial, tmp_path):
    file = str(tmp_path / "scheduler.json")
    port = free_port()

    def dask(what, *arguments):
        command = [sys.executable, "-m", f"distributed.cli.dask_{what}", *arguments, "--no-dashboard"]
        return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=tmp_path)

    def cluster():
        scheduler = dask("scheduler", "--host", "127.0.0.1", "--port", str(port), "--scheduler-file", file)
        worker = dask("worker", "--scheduler-file", file, "--nthreads", "1", "--no-nanny", "--death-timeout", "60")
        return scheduler, worker

    out = tmp_path / "out"
    processes = [*cluster()]
    try:
        process = start(scans, out, "--scheduler", file)
        processes.append(process)
        wait_until(lambda: is_at_work(out), process)
        processes[0].kill()
        processes[1].kill()
        time.sleep(1)
        assert process.poll() is None and finished_pieces(out) < SCANS // PIECE
        processes += cluster()
        assert file in finish(process)
        assert_identical(serial, out)
    finally:
        for process in processes:
            process.kill()
            process.wait()


def test_unreadable_inputs_are_reported_and_the_rest_is_done(tmp_path):
    source = write_scans(tmp_path / "scans", 9)
    (source / "0004.pcd").write_bytes(b"no cloud")
    (source / "0005.pcap").write_bytes(b"no capture")
    done = run(source, tmp_path / "out", "--workers", "0", "--sensor", "vlp16")
    assert done.returncode == 1 and "9 scans" in done.stdout
    assert len(done.stderr.splitlines()) == 2
    assert "0004.pcd" in done.stderr and "0005.pcap" in done.stderr
    again = run(source, tmp_path / "out", "--workers", "0", "--sensor", "vlp16")
    assert again.returncode == 1 and again.stderr == done.stderr and "9 scans" in again.stdout


@pytest.fixture
def small_disk(tmp_path):
    """A file system of half a megabyte; the function makes it larger."""
    folder = tmp_path / "disk"
    folder.mkdir()
    libc = ctypes.CDLL(None, use_errno=True)
    path = str(folder).encode()
    if os.geteuid() != 0 or libc.mount(b"tmpfs", path, b"tmpfs", 0, b"size=512k") != 0:
        pytest.skip("needs the right to mount a file system")
    remount = 32  # MS_REMOUNT
    yield folder, lambda: libc.mount(b"tmpfs", path, b"tmpfs", remount, b"size=64m")
    libc.umount2(path, 2)  # MNT_DETACH


def test_a_full_disk_ends_the_run_and_a_larger_one_completes_it(scans, serial, small_disk):
    disk, enlarge = small_disk
    done = run(scans, disk / "out", "--workers", "2")
    assert done.returncode == 2 and "No space left on device" in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert not (disk / "out" / "clusters.sqlite").exists()
    assert enlarge() == 0
    assert run(scans, disk / "out", "--workers", "0").returncode == 0
    assert_identical(serial, disk / "out")


def test_captures_are_cut_by_rotations(data, tmp_path):
    capture = data / "captures" / "hdl32e_outdoor.pcap"
    options = ("--sensor", "hdl32e", "--ground-z", "-1.7", "--workers", "0")
    done = run(capture, tmp_path / "out", *options)
    assert done.returncode == 0, done.stderr
    expected = []
    for scan in lisco.read(capture, sensor="hdl32e"):
        scan[scan[..., 2] < -1.7] = np.nan
        expected.append(lisco.cluster(scan, 0.4, 5))
    pieces = sorted((tmp_path / "out" / "pieces").iterdir())
    labels = []
    for piece in pieces:
        with np.load(piece / "labels.npz") as members:
            labels += [members[name] for name in sorted(members)]
    assert len(pieces) > 3 and len(labels) == len(expected)
    assert all(np.array_equal(a, b) for a, b in zip(labels, expected))


def test_memory_does_not_grow_with_the_scans_of_a_piece(tmp_path):
    peaks = []
    for count in (5, 60):
        source = write_scans(tmp_path / f"scans{count}", count, points=40000)
        command = [*COMMAND, source, "-o", tmp_path / f"out{count}", "--tolerance", "0.4", "--workers", "0"]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        assert status == 0
        peaks.append(usage.ru_maxrss)
    assert peaks[1] < 1.1 * peaks[0]  # 55 more scans are 35 MB of points and 9 MB of labels
    assert peaks[1] - peaks[0] < 8 * 1024  # kilobytes


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="not glibc")
def test_memory_stays_for_the_next_scan(tmp_path):
    faults = []
    for count in (5, 25):
        source = write_scans(tmp_path / f"scans{count}", count, points=40000)
        command = [*COMMAND, source, "-o", tmp_path / f"out{count}", "--tolerance", "0.4", "--workers", "0"]
        environment = {**os.environ, "MALLOC_TRIM_THRESHOLD_": "65536"}  # as Dask starts workers
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, env=environment)
        _, status, usage = os.wait4(process.pid, 0)
        assert status == 0
        faults.append(usage.ru_minflt)
    assert (faults[1] - faults[0]) / 20 < 300  # 40 measured, 2300 if memory goes back to the system


def test_wrong_arguments_are_one_line(scans, tmp_path):
    (tmp_path / "foreign").mkdir()
    (tmp_path / "foreign" / "letter.txt").write_text("mine")
    for arguments, message in (
        ([tmp_path / "none", "-o", tmp_path / "out", "--tolerance", "0.4"], "does not exist"),
        ([tmp_path / "foreign", "-o", tmp_path / "out", "--tolerance", "0.4"], "holds no scans"),
        ([scans, "-o", tmp_path / "foreign", "--tolerance", "0.4"], "holds files that no run has made"),
        ([scans, "-o", tmp_path / "out", "--tolerance", "1", "--min-size", "5", "--max-size", "4"], "must not exceed"),
    ):
        done = subprocess.run([*COMMAND, *arguments, "--workers", "0"], capture_output=True, text=True)
        assert done.returncode == 2 and message in done.stderr and len(done.stderr.splitlines()) == 1
    for arguments in (["--tolerance", "-1"], ["--tolerance", "0"], ["--tolerance", "nan"], []):
        done = subprocess.run([*COMMAND, scans, "-o", tmp_path / "out", *arguments], capture_output=True, text=True)
        assert done.returncode == 2 and "error:" in done.stderr


def test_other_settings_or_inputs_are_refused(scans, serial):
    other = subprocess.run(
        [*COMMAND, scans, "-o", serial, "--tolerance", "0.5", "--workers", "0"], capture_output=True, text=True
    )
    assert other.returncode == 2 and "other settings" in other.stderr
    assert run(scans / "0001.bin", serial, "--workers", "0").returncode == 2
