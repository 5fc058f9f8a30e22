# SPDX-License-Identifier: BSD-3-Clause
"""Clusters archives of scans and recordings, on one machine or many: `python3 -m lisco.archive --help`."""
