// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <pybind11/pybind11.h>

namespace lisco_python {

// Each adds its classes to the module `lisco._core`.
void defineLabeller(pybind11::module_& module);
void defineColumns(pybind11::module_& module);
void defineEndless(pybind11::module_& module);
void defineGround(pybind11::module_& module);
void defineBoxes(pybind11::module_& module);

}  // namespace lisco_python
