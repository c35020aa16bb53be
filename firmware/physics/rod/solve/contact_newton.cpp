#include "firmware/physics/rod/solve/contact_newton.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "firmware/physics/rod/contact/contact_set.hpp"
#include "firmware/physics/rod/tuning.hpp"

namespace ligature::physics::rod {

void ContactNewton::reserve() {
  constexpr auto kRows = static_cast<std::size_t>(kMostRows), kWide = static_cast<std::size_t>(kWidest);
  constexpr auto kUnknowns = static_cast<std::size_t>(kMostUnknowns);
  z_.reserve();
  spread_.resize(BandColumns::kBlock * (kWide + 1));
  slot_.reserve(static_cast<std::size_t>(kMaxContacts));
  rows_.reserve(kRows);
  slots_.reserve(kRows);
  w_.reserve(kRows);
  unknowns_.reserve(kUnknowns);
  on_.resize(3 * kRows);
  rest_.resize(kRows);
  stuck_.reserve(kRows);
  with_.resize(6 * kRows);
  at_.reserve(kWide);
  dense_.reserve(kUnknowns);
}

void ContactNewton::measure(const BandSolver& solver, int first, int last) noexcept {
  z_.take(solver, first, last);
  slots_.clear();
  coupled_ = 0;
  put_off_ = false;
}

bool ContactNewton::has_moved(const Slot& slot, const Contact& c, std::int32_t first) noexcept {
  if (slot.count != c.count) return true;
  double sum = 0.0;
  bool same = true;
  for (int k = 0; k < c.count; ++k) {
    sum += std::abs(c.w[k] - slot.w[k]);
    same &= slot.node[k] + first == c.node[k];
  }
  return !same || sum > tuning.moved;
}

void ContactNewton::start(const Contact* rows, int count) noexcept {
  slot_.assign(static_cast<std::size_t>(count), -1);
  rows_.clear();
  index_slots();
  for (int k = 0; k < count; ++k) {
    const std::int32_t s = find(rows[k].node[0] - z_.first(), rows[k].node[2] - z_.first());
    if (s < 0) continue;
    Slot& slot = slots_[s];
    slot.dead = has_moved(slot, rows[k], z_.first());
    if (slot.dead) continue;
    slot_[k] = s;
    slot.row = k;
    rows_.push_back(k);
  }
  for (std::size_t s = coupled_ == slots_.size() ? slots_.size() : 0; s-- > 0;) {
    if (!slots_[s].dead) continue;
    if (s + 1 != slots_.size()) exchange(s, slots_.size() - 1);
    slots_.pop_back();
    --coupled_;
  }
}

// Builds the table of slots by their first node, for find(). No slot has a row after that.
void ContactNewton::index_slots() noexcept {
  at_.assign(static_cast<std::size_t>(z_.width()), -1);
  for (std::size_t s = slots_.size(); s-- > 0;) {
    slots_[s].row = -1;
    slots_[s].next = std::exchange(at_[slots_[s].node[0]], static_cast<std::int32_t>(s));
  }
}

// Index of the slot of the contact between segments a and b, or -1.
std::int32_t ContactNewton::find(std::int32_t a, std::int32_t b) const noexcept {
  std::int32_t s = at_[a];
  while (s >= 0 && (slots_[s].node[2] != b || slots_[s].dead)) s = slots_[s].next;
  return s;
}

void ContactNewton::put_off(const Vec* p) noexcept {
  for (const auto k : rows_) slots_[slot_of(k)].guess.v = p[k].v;
  put_off_ = true;
}

bool ContactNewton::resume(Vec* p) noexcept {
  if (put_off_) {
    for (const auto k : rows_) p[k].v = slots_[slot_of(k)].guess.v;
  }
  return std::exchange(put_off_, false);
}

// Adds row k to the contacts in Newton's system (slots_). @return false if there is no room.
bool ContactNewton::take(const Contact* rows, int k) noexcept {
  const std::size_t slot = slots_.size();
  if (slot == static_cast<std::size_t>(kMostRows)) return false;
  const Contact& c = rows[k];
  for (int j = 0; j < c.count; ++j) {
    if (!z_.want(c.node[j] - z_.first())) return false;
  }
  slot_[k] = static_cast<std::int32_t>(slot);
  rows_.push_back(k);
  Slot& made = slots_.emplace_back();
  made.guess.v = c.p.v;
  made.row = k;
  made.count = c.count;
  made.n.v = c.n.v, made.soft = c.soft;
  for (int j = 0; j < c.count; ++j) made.node[j] = c.node[j] - z_.first(), made.w[j] = c.w[j];
  return true;
}

// Computes spread_ = Z J^T of a slot: velocities of the nodes first to last per unit impulse at the slot's contact.
void ContactNewton::spread(const Slot& slot, std::int32_t first, std::int32_t last) noexcept {
  const auto begin = (BandColumns::kBlock * static_cast<std::size_t>(first)) & ~std::size_t{7},
             end = BandColumns::kBlock * static_cast<std::size_t>(last + 1);
  float* const out = spread_.data();
  const float* column[kMostNodes];
  Eight w[kMostNodes];
  for (int k = 0; k < slot.count; ++k) {
    column[k] = z_.column(slot.node[k]);
    w[k] = all_eight(static_cast<float>(slot.w[k]));
  }
  for (std::size_t j = begin; j < end; j += 8) {
    // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): a contact has at least one node
    Eight sum = w[0] * load_as<Eight>(column[0] + j);
    for (int k = 1; k < slot.count; ++k) sum += w[k] * load_as<Eight>(column[k] + j);
    store_as(out + j, sum);
  }
}

// A 3 x 3 block of W: relative velocity at this slot's contact per unit impulse at the slot last given to spread(). The
// columns are for impulses along x, y, z.
std::array<Four, 3> ContactNewton::answer_at(const Slot& slot) const noexcept {
  std::array<Four, 3> sum{};
  for (int j = 0; j < slot.count; ++j) {
    const float* const at = spread_.data() + BandColumns::kBlock * static_cast<std::size_t>(slot.node[j]);
    const auto w = static_cast<float>(slot.w[j]);
    for (std::size_t i = 0; i < 3; ++i) sum[i] += w * load_as<Four>(at + 4 * i);
  }
  return sum;
}

// Sets the step lengths r_n and r_t of a contact's natural map (see the class ContactNewton): the inverse of the
// contact's own velocity per unit impulse, along the normal and across it.
void ContactNewton::set_steps(Slot& slot, const std::array<Four, 3>& w) noexcept {
  const Mat own{{__builtin_convertvector(w[0], Lanes)},
                {__builtin_convertvector(w[1], Lanes)},
                {__builtin_convertvector(w[2], Lanes)}};
  const Vec on_n = own * slot.n;
  const double normal = dot(on_n, slot.n);
  // The 3 x 3 block, projected onto the plane across n, has trace t and squared Frobenius norm s. `across` is its
  // larger eigenvalue
  const double t = own.x[0] + own.y[1] + own.z[2] - normal;
  const double s = dot(own.x, own.x) + dot(own.y, own.y) + dot(own.z, own.z) - 2.0 * dot(on_n, on_n) + normal * normal;
  const double across = 0.5 * (t + std::sqrt(std::max(0.0, 2.0 * s - t * t)));
  slot.per_r_n = normal + slot.soft, slot.per_r_t = across;
  slot.r_n = 1.0 / slot.per_r_n;
  slot.r_t = 1.0 / slot.per_r_t;
}

// Computes the missing blocks of the coupling matrix W. A slot is a contact in the system. Each slot that was added
// since the last call gets its blocks with itself and with all earlier slots; W is symmetric. @return true if all slots
// have their blocks. false: the time was over first; the next call continues with the slot where this one ended.
bool ContactNewton::couple(TickTime& time) noexcept {
  if (coupled_ == slots_.size()) return true;
  if (!z_.make_missing(time) || !time.allows()) return false;
  Pieces pieces(time);
  std::int32_t first = z_.width(), last = 0;
  for (const auto& slot : slots_) {
    for (int j = 0; j < slot.count; ++j) first = std::min(first, slot.node[j]), last = std::max(last, slot.node[j]);
  }
  std::size_t a = coupled_;
  for (; a < slots_.size() && pieces.allow(price::couple(1, static_cast<long>(a), z_.width())); ++a) {
    Slot& slot = slots_[a];
    spread(slot, first, last);
    for (std::size_t b = 0; b < a; ++b) w_.put(a, b, answer_at(slots_[b]));
    const auto own = answer_at(slot);
    w_.put(a, a, own);
    set_steps(slot, own);
  }
  w_.mirror(coupled_, a);
  coupled_ = a;
  return coupled_ == slots_.size();
}

bool ContactNewton::look(const Contact* rows, int count, const Vec* p, const Vec* u) noexcept {
  last2_ = std::numeric_limits<double>::infinity();
  rises_ = 0;
  for (int k = 0; k < count; ++k) {
    if (slot_[k] >= 0) continue;
    const Contact& c = rows[k];
    if (dot(u[k], c.n) >= c.target && dot(p[k], p[k]) == 0.0) continue;
    if (!take(rows, k)) return false;
  }
  return true;
}

}  // namespace ligature::physics::rod
