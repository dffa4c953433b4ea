// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/dense_cast.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "facula/map/dense_cast_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifdef HWY_TARGET  // below the headers that choose it
#include <facula/map/dense_cast_simd-inl.hpp>
#endif

#if HWY_ONCE
namespace facula {
namespace {

HWY_EXPORT(walk_rays);

}  // namespace

void DenseCast::walk(const RayBlock& rays) {
  HWY_DYNAMIC_DISPATCH(walk_rays)(*this, rays);
}

}  // namespace facula
#endif
