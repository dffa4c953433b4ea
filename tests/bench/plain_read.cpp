// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/bench/plain_read.hpp>

#define HWY_WANT_AVX3_DL 1
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "facula/tests/bench/plain_read.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace facula {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

std::uint64_t sum_bytes(const std::uint8_t* bytes, std::size_t count) {
  std::uint64_t sum = 0;
  std::size_t i = 0;
#if HWY_TARGET != HWY_SCALAR
  const hn::ScalableTag<std::uint8_t> d;
  const hn::Repartition<std::uint64_t, decltype(d)> d64;
  const std::size_t lanes = hn::Lanes(d);
  auto a = hn::Zero(d64);
  auto b = a;
  auto c = a;
  auto e = a;
  for (; i + 4 * lanes <= count; i += 4 * lanes) {
    a = hn::Add(a, hn::SumsOf8(hn::LoadU(d, bytes + i)));
    b = hn::Add(b, hn::SumsOf8(hn::LoadU(d, bytes + i + lanes)));
    c = hn::Add(c, hn::SumsOf8(hn::LoadU(d, bytes + i + 2 * lanes)));
    e = hn::Add(e, hn::SumsOf8(hn::LoadU(d, bytes + i + 3 * lanes)));
  }
  sum = hn::GetLane(hn::SumOfLanes(d64, hn::Add(hn::Add(a, b), hn::Add(c, e))));
#endif
  for (; i < count; ++i) sum += bytes[i];
  return sum;
}

}  // namespace HWY_NAMESPACE
}  // namespace facula
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace facula {

HWY_EXPORT(sum_bytes);

std::uint64_t plain_read(const std::uint8_t* bytes, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(sum_bytes)(bytes, count);
}

}  // namespace facula
#endif
