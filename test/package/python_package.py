# SPDX-License-Identifier: BSD-3-Clause
"""Prints the version and the place of the Python package, and labels of three points."""
import lisco

print(lisco.__version__, lisco.__file__, lisco.cluster([[1.0, 2, 3], [1.1, 2, 3], [9, 9, 9]], 0.4, min_size=2).tolist())
