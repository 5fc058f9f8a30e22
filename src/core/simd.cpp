// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/simd.h"

#include "lisco/simd.h"

#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

std::int64_t target() {
  return HWY_TARGET;
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {
namespace {

HWY_EXPORT(target);

const std::vector<std::int64_t>& targets() {
  static const std::vector<std::int64_t> all = hwy::SupportedAndGeneratedTargets();
  return all;
}

/// Uses no better target than this one; 0: the best. Highway numbers better ones lower. Those below it serve files that
/// are not compiled for it.
void use(std::int64_t target) {
  std::int64_t allowed = 0;
  for (const std::int64_t other : targets())
    if (target != 0 && other >= target) allowed |= other;
  hwy::SetSupportedTargetsForTest(allowed);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace

void chooseSimdLevel() {
  HWY_DYNAMIC_DISPATCH(target)();
}

std::string simdLevel() {
  return hwy::TargetName(HWY_DYNAMIC_DISPATCH(target)());
}

std::vector<std::string> simdLevels() {
  std::vector<std::string> names;
  for (const std::int64_t target : targets()) names.emplace_back(hwy::TargetName(target));
  return names;
}

bool useSimdLevel(const std::string& name) {
  for (const std::int64_t target : targets())
    if (name.empty() || hwy::TargetName(target) == name) {
      use(name.empty() ? 0 : target);
      return true;
    }
  return false;
}

}  // namespace lisco
#endif
