// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "module.h"

#include <pybind11/stl.h>

#include "lisco/simd.h"
#include "lisco/version.h"

PYBIND11_MODULE(_core, module) {
  module.doc() = "The engine of the package lisco. Its functions expect arguments that the package has checked.";
  module.attr("__version__") = LISCO_VERSION;
  module.def("simd_level", &lisco::simdLevel);
  lisco_python::defineLabeller(module);
  lisco_python::defineColumns(module);
  lisco_python::defineEndless(module);
  lisco_python::defineGround(module);
  lisco_python::defineBoxes(module);
}
