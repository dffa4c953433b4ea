// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled once per instruction set, from dense_cast_simd.cpp alone.
#if defined(FACULA_MAP_DENSE_CAST_SIMD_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FACULA_MAP_DENSE_CAST_SIMD_INL
#undef FACULA_MAP_DENSE_CAST_SIMD_INL
#else
#define FACULA_MAP_DENSE_CAST_SIMD_INL
#endif

HWY_BEFORE_NAMESPACE();
namespace facula::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using Floats = hn::Rebind<float, Doubles>;
using Integers = hn::Rebind<std::int64_t, Doubles>;
using DoubleVector = hn::Vec<Doubles>;
using FloatVector = hn::Vec<Floats>;
using IntegerVector = hn::Vec<Integers>;
using DoubleMask = hn::Mask<Doubles>;

/// Three numbers per ray.
template <typename Vector>
struct Three {
  Vector x;
  Vector y;
  Vector z;
};

/// Length as OctoMap takes it: squares summed in float from left to right, root in double.
inline DoubleVector length_of(const Three<FloatVector>& v) {
  const FloatVector squared =
      hn::Add(hn::Add(hn::Mul(v.x, v.x), hn::Mul(v.y, v.y)), hn::Mul(v.z, v.z));
  return hn::Sqrt(hn::PromoteTo(Doubles(), squared));
}

inline Three<FloatVector> difference(const Three<FloatVector>& a, const Three<FloatVector>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

inline Three<FloatVector> divided(const Three<FloatVector>& v, FloatVector by) {
  return {hn::Div(v.x, by), hn::Div(v.y, by), hn::Div(v.z, by)};
}

inline FloatVector choose(DoubleMask mask, FloatVector yes, FloatVector no) {
  const Doubles d;
  return hn::DemoteTo(Floats(), hn::IfThenElse(mask, hn::PromoteTo(d, yes), hn::PromoteTo(d, no)));
}

/// Cells counted from 0 m.
inline DoubleVector cells_along(FloatVector x, DoubleVector cells_per_metre) {
  return hn::Floor(hn::Mul(cells_per_metre, hn::PromoteTo(Doubles(), x)));
}

inline DoubleMask on_axis(DoubleVector cells) {
  const Doubles d;
  return hn::And(hn::Ge(cells, hn::Set(d, -32768.0)), hn::Lt(cells, hn::Set(d, 32768.0)));
}

inline DoubleMask in_grid(const Three<DoubleVector>& cells) {
  return hn::And(hn::And(on_axis(cells.x), on_axis(cells.y)), on_axis(cells.z));
}

/// One axis of the walk.
struct Axis {
  DoubleVector next;
  DoubleVector delta;
  IntegerVector step;
};

inline Axis start_axis(double resolution,
                       DoubleVector cell,
                       FloatVector origin,
                       FloatVector direction,
                       std::int64_t stride) {
  const Doubles d;
  const Integers i;
  const DoubleVector along = hn::PromoteTo(d, direction);
  const DoubleMask up = hn::Gt(along, hn::Zero(d));
  const DoubleMask still = hn::Eq(along, hn::Zero(d));
  const auto half = static_cast<double>(static_cast<float>(resolution * 0.5));
  DoubleVector border = hn::Mul(hn::Add(cell, hn::Set(d, 0.5)), hn::Set(d, resolution));
  border = hn::Add(border, hn::IfThenElse(up, hn::Set(d, half), hn::Set(d, -half)));
  const DoubleVector never = hn::Set(d, std::numeric_limits<double>::max());
  const DoubleVector next = hn::Div(hn::Sub(border, hn::PromoteTo(d, origin)), along);
  const DoubleVector delta = hn::Div(hn::Set(d, resolution), hn::Abs(along));
  return {hn::IfThenElse(still, never, next),
          hn::IfThenElse(still, never, delta),
          hn::IfThenElse(hn::RebindMask(i, up), hn::Set(i, stride), hn::Set(i, -stride))};
}

/// A packet of rays as they were asked for.
struct Packet {
  Three<FloatVector> origin;
  Three<FloatVector> end;
  DoubleMask asked;  ///< lanes that hold a ray
};

class Walker {
 public:
  explicit Walker(DenseCast& cast) : cast_(cast) {}

  void walk(const Packet& packet) {
    const Doubles d;
    Three<FloatVector> end = packet.end;
    DoubleMask cut = hn::FirstN(d, 0);
    if (cast_.max_range > 0) cut = cut_at_range(packet.origin, end);
    const Three<DoubleVector> first = cells_of(packet.origin);
    const Three<DoubleVector> last = cells_of(end);
    const DoubleMask valid = hn::And(packet.asked, hn::And(in_grid(first), in_grid(last)));
    cast_.skipped += hn::CountTrue(d, packet.asked) - hn::CountTrue(d, valid);
    const IntegerVector from = place_of(first, valid);
    const IntegerVector to = place_of(last, valid);
    step_through(packet.origin, difference(end, packet.origin), first, {from, to}, valid);
    mark(cast_.ended, to, hn::AndNot(cut, valid));
  }

 private:
  struct FromTo {
    IntegerVector from;
    IntegerVector to;
  };

  Three<DoubleVector> cells_of(const Three<FloatVector>& x) const {
    const DoubleVector scale = hn::Set(Doubles(), 1.0 / cast_.resolution);
    return {cells_along(x.x, scale), cells_along(x.y, scale), cells_along(x.z, scale)};
  }

  /// Moves ends beyond the range onto it; the lanes where that was so.
  DoubleMask cut_at_range(const Three<FloatVector>& origin, Three<FloatVector>& end) const {
    const Doubles d;
    const Three<FloatVector> way = difference(end, origin);
    const DoubleVector range = length_of(way);
    const DoubleMask cut = hn::Not(hn::Le(range, hn::Set(d, cast_.max_range)));
    const FloatVector limit = hn::Set(Floats(), static_cast<float>(cast_.max_range));
    const Three<FloatVector> unit = divided(way, hn::DemoteTo(Floats(), range));
    end.x = choose(cut, hn::Add(origin.x, hn::Mul(unit.x, limit)), end.x);
    end.y = choose(cut, hn::Add(origin.y, hn::Mul(unit.y, limit)), end.y);
    end.z = choose(cut, hn::Add(origin.z, hn::Mul(unit.z, limit)), end.z);
    return cut;
  }

  /// Number of the cell's bit in the box; 0 in lanes that are not valid.
  IntegerVector place_of(const Three<DoubleVector>& cell, DoubleMask valid) const {
    const Doubles d;
    const DenseBits& box = cast_.passed;
    const auto part = [&](DoubleVector cells, std::size_t axis, std::int64_t stride) {
      const auto corner = static_cast<double>(box.corner[axis] - kCentreKey);
      return hn::Mul(hn::Sub(cells, hn::Set(d, corner)), hn::Set(d, static_cast<double>(stride)));
    };
    const DoubleVector place = hn::Add(hn::Add(part(cell.x, 0, 1), part(cell.y, 1, box.row())),
                                       part(cell.z, 2, box.layer()));
    return hn::ConvertTo(Integers(), hn::IfThenElseZero(valid, place));
  }

  void step_through(const Three<FloatVector>& origin,
                    const Three<FloatVector>& way,
                    const Three<DoubleVector>& first,
                    const FromTo& places,
                    DoubleMask valid) {
    const Doubles d;
    const Integers i;
    const FloatVector float_length = hn::DemoteTo(Floats(), length_of(way));
    const DoubleVector length = hn::PromoteTo(d, float_length);
    const Three<FloatVector> direction = divided(way, float_length);
    const DenseBits& box = cast_.passed;
    Axis x = start_axis(cast_.resolution, first.x, origin.x, direction.x, 1);
    Axis y = start_axis(cast_.resolution, first.y, origin.y, direction.y, box.row());
    Axis z = start_axis(cast_.resolution, first.z, origin.z, direction.z, box.layer());
    IntegerVector place = places.from;
    const auto arrived = [&] { return hn::RebindMask(d, hn::Eq(place, places.to)); };
    DoubleMask active = hn::And(hn::AndNot(arrived(), valid), hn::Gt(length, hn::Zero(d)));
    while (!hn::AllFalse(d, active)) {
      mark(cast_.passed, place, active);
      const DoubleMask x_before_y = hn::Lt(x.next, y.next);
      const DoubleMask take_z = hn::Le(z.next, hn::Min(x.next, y.next));
      const DoubleMask take_x = hn::AndNot(take_z, x_before_y);
      const DoubleMask take_y = hn::Not(hn::Or(take_z, x_before_y));
      const IntegerVector beside = hn::IfThenElse(hn::RebindMask(i, x_before_y), x.step, y.step);
      place = hn::Add(place, hn::IfThenElse(hn::RebindMask(i, take_z), z.step, beside));
      x.next = hn::IfThenElse(take_x, hn::Add(x.next, x.delta), x.next);
      y.next = hn::IfThenElse(take_y, hn::Add(y.next, y.delta), y.next);
      z.next = hn::IfThenElse(take_z, hn::Add(z.next, z.delta), z.next);
      const DoubleVector reached = hn::Min(hn::Min(x.next, y.next), z.next);
      active = hn::AndNot(arrived(), hn::And(active, hn::Le(reached, length)));
    }
  }

  /// A bit that is there already is not written again: rays next to each other share their first
  /// cells, and a store that the next load waits for costs more than a test.
  static void mark_one(DenseBits& bits, std::int64_t place) {
    std::uint64_t& word = bits.words[static_cast<std::size_t>(place >> 6)];
    const std::uint64_t bit = std::uint64_t{1} << (place & 63);
    if ((word & bit) == 0) word |= bit;
  }

  static void mark(DenseBits& bits, IntegerVector places, DoubleMask which) {
    const Doubles d;
    HWY_ALIGN std::array<std::int64_t, 8> lanes;
    hn::Store(places, Integers(), lanes.data());
    if (hn::AllTrue(d, which)) {
      for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) mark_one(bits, lanes[lane]);
      return;
    }
    std::array<std::uint8_t, 8> mask{};
    hn::StoreMaskBits(d, which, mask.data());
    for (unsigned left = mask[0]; left != 0; left &= left - 1) {
      mark_one(bits, lanes[static_cast<std::size_t>(std::countr_zero(left))]);
    }
  }

  DenseCast& cast_;
};

/// Coordinates of up to a packet of triples, one after the other.
inline Three<FloatVector> load_triples(const float* triples, std::size_t count) {
  HWY_ALIGN std::array<std::array<float, 8>, 3> lanes{};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) lanes[axis][i] = triples[3 * i + axis];
  }
  const Floats f;
  return {hn::Load(f, lanes[0].data()), hn::Load(f, lanes[1].data()), hn::Load(f, lanes[2].data())};
}

inline void walk_rays(DenseCast& cast, const RayBlock& rays) {
  const Doubles d;
  const std::size_t width = hn::Lanes(d);
  Walker walker(cast);
  for (std::size_t i = rays.begin; i < rays.end; i += width) {
    const std::size_t count = std::min(width, rays.end - i);
    walker.walk({load_triples(rays.origins + 3 * i, count),
                 load_triples(rays.points + 3 * i, count),
                 hn::FirstN(d, count)});
  }
}

}  // namespace facula::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
