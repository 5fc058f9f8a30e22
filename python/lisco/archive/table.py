# SPDX-License-Identifier: BSD-3-Clause
"""One table of all clusters, merged from the pieces in their order."""

import os
import sqlite3
import uuid
from typing import Iterable

import numpy as np

from .pieces import Piece
from .work import CLUSTERS, ROW, published

TABLE = "clusters.sqlite"


def merge(out: str, pieces: Iterable[Piece]) -> None:
    """Writes the table under a temporary name and renames it. Holds the clusters of one piece at a time."""
    final = os.path.join(out, TABLE)
    temporary = f"{final}.{uuid.uuid4().hex}.tmp"
    names = ROW.names or ()
    columns = ", ".join(f"{name} {'INTEGER' if ROW[name].kind == 'i' else 'REAL'} NOT NULL" for name in names)
    try:
        connection = sqlite3.connect(temporary, isolation_level=None)
        try:
            connection.execute("PRAGMA journal_mode = OFF")  # the file counts only once it is renamed
            connection.execute("PRAGMA synchronous = OFF")
            connection.execute("PRAGMA page_size = 16384")  # a quarter less time than with 4096
            connection.execute("BEGIN")
            connection.execute(
                "CREATE TABLE scans (id INTEGER PRIMARY KEY, name TEXT NOT NULL, time REAL, piece TEXT NOT NULL,"
                " member TEXT NOT NULL, points INTEGER NOT NULL, clusters INTEGER NOT NULL)"
            )
            connection.execute(f"CREATE TABLE clusters ({columns}, PRIMARY KEY (scan, cluster)) WITHOUT ROWID")
            first = 0
            for piece in pieces:
                report = published(out, piece)
                if report is None:
                    raise FileNotFoundError(f"{out}: piece {piece.name} is missing")
                scans = report["scans"]
                connection.executemany(
                    "INSERT INTO scans VALUES (?, ?, ?, ?, ?, ?, ?)",
                    (
                        (first + i, s["name"], s["time"], piece.name, f"{i:06d}.npy", s["points"], s["clusters"])
                        for i, s in enumerate(scans)
                    ),
                )
                rows = np.load(os.path.join(out, "pieces", piece.name, CLUSTERS))
                rows["scan"] += first
                marks = ", ".join("?" * len(names))
                connection.executemany(f"INSERT INTO clusters VALUES ({marks})", rows.tolist())
                first += len(scans)
            connection.execute("COMMIT")
        finally:
            connection.close()
        with open(temporary, "rb") as file:
            os.fsync(file.fileno())
        os.replace(temporary, final)
    except sqlite3.Error as error:
        raise OSError(f"{final}: cannot be written: {error}") from None
    finally:
        if os.path.exists(temporary):
            os.remove(temporary)
