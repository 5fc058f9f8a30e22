# SPDX-License-Identifier: BSD-3-Clause
"""The page of a scan, and what a browser makes of it."""

import html
import json
import os
import re
import shutil
import subprocess

import lisco
import numpy as np
import pytest

pytest.importorskip("lisco._view", reason="made without zlib or nlohmann-json")

SECONDS = 120


def scan():
    """Three posts of 40, 30 and 20 returns at 4 m, 6 m and 8 m, five points apart, and two rows of ground."""
    posts = [
        np.stack([np.full(n, 4.0 + 2 * i), np.zeros(n), 0.02 * np.arange(n)], axis=1)
        for i, n in enumerate((40, 30, 20))
    ]
    alone = np.stack([np.full(5, -5.0), 3.0 * np.arange(5), np.zeros(5)], axis=1)
    ground = np.stack([np.arange(25) - 12.0, np.full(25, 3.0), np.full(25, -2.0)], axis=1)
    points = np.concatenate([*posts, alone, ground])
    labels = np.repeat([0, 1, 2, -1], [40, 30, 20, 30])
    return points, labels, np.arange(len(points)) >= 95


@pytest.fixture(scope="module")
def browser():
    names = [os.environ.get("LISCO_CHROMIUM"), "chromium", "chromium-browser", "google-chrome"]
    found = [shutil.which(name) for name in names if name]
    if not any(found):
        pytest.skip("no Chromium: apt-get install --no-install-recommends chromium")
    return next(filter(None, found))


def shown(browser, folder, page):
    """What a browser shows of a page in a frame: the page's own numbers."""
    script = """
      const frame = document.querySelector('iframe');
      frame.onload = async () => {
        const lisco = frame.contentWindow.lisco;
        await lisco.ready;
        const scan = lisco.view.scan, of = scan.labellings[0];
        document.querySelector('pre').textContent = JSON.stringify({
          name: scan.name, points: scan.points, ground: of.ground, noise: of.noise, rings: scan.rings?.length,
          tolerance: of.tolerance, clusters: of.clusters, levels: scan.levels && [...scan.levels],
          message: frame.contentDocument.querySelector('#message').innerText});
      };
    """
    file = folder / "notebook.html"
    file.write_text(f"<!doctype html><meta charset=utf-8><pre></pre><script>addEventListener('DOMContentLoaded', () => "
                    f"{{ {script} }});</script>{page._repr_html_()}", encoding="utf-8")
    command = [browser, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder / 'profile'}",
               "--virtual-time-budget=20000", "--dump-dom", file.as_uri()]
    dom = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=True).stdout
    return json.loads(html.unescape(re.search("<pre>(.*?)</pre>", dom, re.S).group(1)))


def test_a_notebook_shows_the_scan(browser, tmp_path):
    points, labels, ground = scan()
    page = lisco.view(points, labels, ground=ground, intensity=np.arange(120), tolerance=0.4, name='a "scan" <b>')
    found = shown(browser, tmp_path, page)
    assert found["name"] == 'a "scan" <b>' and found["message"] == "" and found["tolerance"] == 0.4
    assert (found["points"], found["ground"], found["noise"]) == (120, 25, 5)
    assert sorted(found["levels"]) == list(range(120)) and "rings" not in found
    boxes = lisco.boxes(points, labels)
    assert [cluster["id"] for cluster in found["clusters"]] == [1, 2, 3]
    for cluster, box in zip(found["clusters"], boxes):
        assert cluster["size"] == box["size"] and np.allclose(cluster["center"], box["center"], atol=1e-4)
        assert cluster["height"] == pytest.approx(box["height"], abs=1e-4)
        assert cluster["range"] == pytest.approx(box["nearest_range"], abs=1e-4)


def test_organized_scans_have_rings_and_labels_may_have_gaps(browser, tmp_path):
    points, labels, _ = scan()
    labels = np.where(labels == 1, 77, labels).reshape(8, 15)
    points = points.astype(np.float32).reshape(8, 15, 3)
    points[0, :3] = np.nan
    found = shown(browser, tmp_path, lisco.view(points, labels))
    assert found["points"] == found["rings"] == 117
    assert [(c["id"], c["size"]) for c in found["clusters"]] == [(1, 37), (3, 20), (78, 30)]


def test_pages_are_files_that_replace_only_pages(tmp_path):
    points, labels, _ = scan()
    file = tmp_path / "view.html"
    page = lisco.view(points, labels, file)
    assert file.read_text(encoding="utf-8") == page.page and page.page.startswith("<!doctype html>")
    assert page.page in html.unescape(page._repr_html_()) and "save" in repr(page)
    other = lisco.view(points, labels * 0, str(file))
    assert file.read_text(encoding="utf-8") == other.page != page.page
    letter = tmp_path / "letter.html"
    letter.write_text("mine")
    with pytest.raises(FileExistsError, match="no page of lisco"):
        lisco.view(points, labels, letter)
    with pytest.raises(FileNotFoundError):
        lisco.view(points, labels, tmp_path / "none" / "view.html")
    assert letter.read_text() == "mine" and sorted(p.name for p in tmp_path.iterdir()) == ["letter.html", "view.html"]


def test_empty_scans_have_pages():
    for shape in ((0, 3), (0, 5, 3), (5, 0, 3)):
        assert "</html>" in lisco.view(np.zeros(shape), np.zeros(shape[:-1], int)).page
    assert "</html>" in lisco.view(np.full((4, 3), np.nan), [-1, 0, 1, 2], camera=True, intensity=[1e300] * 4).page


@pytest.mark.parametrize(
    "labels, options, message",
    [
        (np.zeros(4, int), {}, "labels must be of the shape of points"),
        (np.zeros(5), {}, "whole numbers"),
        (np.full(5, 5), {}, "labels must be less than the number of points, 5, not 5"),
        (np.zeros(5, int), {"ground": [True]}, "ground must be of the shape of points"),
        (np.zeros(5, int), {"intensity": list("abcde")}, "intensity must be numbers"),
        (np.zeros(5, int), {"tolerance": -1}, "tolerance must be"),
    ],
)
def test_wrong_arguments_are_value_errors(labels, options, message):
    with pytest.raises(ValueError, match=message):
        lisco.view(np.ones((5, 3)), labels, **options)
