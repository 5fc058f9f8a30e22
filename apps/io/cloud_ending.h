// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "io/text.h"

namespace lisco_apps {

/// Whether a file's name has an ending of readCloudFile ().
bool isCloudFile(const fs::path& file);

}  // namespace lisco_apps
