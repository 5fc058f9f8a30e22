// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

namespace lisco {

/// Chooses the best vector instructions, unless some are chosen. Asking the processor takes up to 0.1 ms on a virtual
/// machine: constructors call this, so that the first column or cloud does not take longer.
void chooseSimdLevel();

}  // namespace lisco
