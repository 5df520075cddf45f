#include "host/snapshot/Publisher.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include "host/snapshot/MotionFit.h"
#include "shared/replica/Acks.h"

namespace naiad {

namespace {

/// Cells from the object's own that its look reaches, rounded up.
std::int32_t reachOf(const Look& look) {
  const std::int32_t most = look.sequence.reach();
  return (most >> kGlyphUnitBits) + (most == 0 ? 0 : 1);
}

/// Does it move by more than a cell in a tick, or may it soon?
bool isFast(const Motion& motion) {
  const auto above = [](df::Fixed v) { return v > df::kFixedOne || v < -df::kFixedOne; };
  return motion.acceleration != df::FixedVector{} || above(motion.velocity.x) || above(motion.velocity.y);
}

/// Paths are fitted for at least so many ticks, and after a turn for at most so many.
constexpr std::uint32_t kShortestHorizon = 64;
constexpr std::uint32_t kHorizonAfterTurn = 512;
/// A path that outlives its model's horizon gets one for so many times its age.
constexpr std::uint32_t kPatience = 8;
/// Cells that a view object reaches, so that it is of interest to everybody wherever his view is.
constexpr std::int32_t kOnEveryView = 1 << 20;
/// More distinct offsets than this make a fit slow and coarse numbers unlikely.
constexpr std::size_t kMaxOffsets = 6;

}  // namespace

const Publisher::Model* Publisher::find(std::uint32_t slot) const {
  if (slot == kLooseSlot) return m_loose.model.alive ? &m_loose.model : nullptr;
  return slot < m_models.size() && m_models[slot].model.alive ? &m_models[slot].model : nullptr;
}

Publisher::Tracked* Publisher::track(std::uint32_t slot) {
  if (slot >= kLooseSlot) {
    ++m_refused;
    return nullptr;
  }
  if (slot >= m_models.size()) {
    m_models.resize(std::size_t{slot} + 1);
    m_look_at.resize(m_models.size(), m_tick);
  }
  return &m_models[slot];
}

// What moves is reported every tick, so what was not reported stands still.
Motion Publisher::truthNow(const Tracked& tracked) const {
  if (tracked.truth.tick == m_tick) return tracked.truth;
  return {m_tick, tracked.truth.position, {}, {}};
}

void Publisher::mark(std::uint32_t slot, Tracked& tracked, std::uint8_t groups) {
  tracked.changed |= groups;
  if (tracked.touched) return;
  tracked.touched = true;
  m_changes.push_back({slot, 0, {}});
}

void Publisher::update(const df::WorldView& view) {
  m_tick = view.tick;
  ++m_update;
  const bool is_color = view.background >= df::BLACK && view.background <= df::WHITE;
  m_world = {view.boundary, view.view_width, view.view_height, is_color ? view.background : df::BLACK};
  m_changes.clear();
  m_exact.clear();
  bool controls = false;
  for (const df::PlayerFacts& player : view.players) {
    if (player.followed.generation != 0) m_exact.push_back(player.followed);
    if (player.steering.object.generation != 0) m_exact.push_back(player.steering.object);
    controls = controls || player.steering.p_table != nullptr;
  }
  std::sort(m_exact.begin(), m_exact.end(), [](auto a, auto b) { return a.slot < b.slot; });

  for (const df::ObjectKey key : view.vanished) bury(key);
  for (const df::ObjectFacts& facts : view.changed) takeFacts(facts);
  auto told = view.looks.begin();
  for (const df::DrawnObject& drawn : view.drawn) {
    const bool tells = told != view.looks.end() && &view.drawn[told->drawn] == &drawn;
    takeDrawing(view, drawn, tells ? (told++)->p_look.get() : nullptr);
  }
  takeLoose(view);
  correctUndrawn(view);
  if (controls) setExactSolids(true);
  if (std::exchange(m_solids_are_coarse, false)) keepSolidsExact();
  for (const df::ObjectKey key : m_exact) keepExact(key);

  m_change_index.clear();
  for (Change& change : m_changes) {
    finish(change);
    m_change_index.add(change.slot, change.groups != 0 ? change.sweep : CompactRect::nowhere());
  }
}

void Publisher::finish(Change& change) {
  Tracked& tracked = change.slot == kLooseSlot ? m_loose : m_models[change.slot];
  change.groups = tracked.model.alive ? tracked.changed : 0;
  if ((change.groups & (kMotion | kLook)) != 0) file(change.slot, tracked);
  if ((change.groups & kMotion) != 0) fit(tracked);
  if ((change.groups & kLook) != 0) meet(tracked.model);
  if (change.groups == 0 || (change.groups & kMotion) != 0) {
    list(m_fast, change.slot, tracked.fast, tracked.model.alive && isFast(tracked.model.state.motion));
  }
  if (!tracked.fast) {
    const df::FixedVector v = tracked.model.state.motion.velocity;
    m_speed = {std::max(m_speed.x, std::abs(v.x)), std::max(m_speed.y, std::abs(v.y))};
  }
  change.sweep = CompactRect(sweepOf(tracked.model, m_tick, kSweep));
  tracked.changed = 0;
  tracked.touched = false;
}

CellRect Publisher::sweepOf(const Model& model, std::uint32_t tick, std::uint32_t ticks) {
  constexpr std::int64_t kEverywhere = INT32_MAX;
  if (model.reach > kWide) return {-kEverywhere, -kEverywhere, kEverywhere, kEverywhere};
  const Motion& motion = model.state.motion;
  const bool straight = motion.acceleration == df::FixedVector{};
  const df::FixedVector velocity = straight ? motion.velocity : rebase(motion, tick).velocity;
  const df::FixedVector at = positionAt(motion, tick);
  constexpr std::int64_t kFar = 1 << 30;
  constexpr std::int64_t kFine = df::kFixedOne >> 8;
  // Cells that it gets away, at most.
  const auto way = [ticks](df::Fixed v, df::Fixed a) {
    const std::int64_t n = ticks;
    const std::int64_t speed = (std::abs(v) + n * std::abs(a) + kFine - 1) / kFine;
    return v == 0 && a == 0 ? 0 : std::min(std::int64_t{kFar}, (speed * n >> 8) + 1);
  };
  const std::int64_t x = df::cellOf(at.x);
  const std::int64_t y = df::cellOf(at.y);
  const std::int64_t dx = way(velocity.x, motion.acceleration.x);
  const std::int64_t dy = way(velocity.y, motion.acceleration.y);
  return CellRect{x - (straight && velocity.x > 0 ? 0 : dx), y - (straight && velocity.y > 0 ? 0 : dy),
                  x + 1 + (straight && velocity.x < 0 ? 0 : dx),
                  y + 1 + (straight && velocity.y < 0 ? 0 : dy)}
      .grownBy(model.reach);
}

const SharedMotion& Publisher::share(std::uint32_t slot) const {
  m_shared.resize(m_models.size() + 1);
  Shared& shared = m_shared[std::min<std::size_t>(slot, m_models.size())];
  shared = {m_update, shareMotion(rebase(find(slot)->state.motion, m_tick))};
  return shared.motion;
}

const Publisher::Outlook& Publisher::workOut(std::uint32_t slot, std::uint32_t soon,
                                             std::uint32_t later) const {
  if (soon != m_soon || later != m_later) {
    ++m_update;
    m_soon = soon;
    m_later = later;
  }
  m_outlooks.resize(m_models.size() + 1);
  Remembered& known = m_outlooks[std::min<std::size_t>(slot, m_models.size())];
  known.update = m_update;
  known.outlook = {};
  const Model* model = find(slot);
  if (model == nullptr) return known.outlook;
  known.outlook.generation = model->generation;
  known.outlook.later = CompactRect(sweepOf(*model, m_tick, later));
  if (model->reach > kWide) {
    known.outlook.soon = known.outlook.later;
    return known.outlook;
  }
  const Motion& motion = model->state.motion;
  const df::FixedVector now = positionAt(motion, m_tick);
  const df::FixedVector then = isMoving(motion) ? positionAt(motion, m_tick + soon) : now;
  const std::int64_t left = std::min(df::cellOf(now.x), df::cellOf(then.x));
  const std::int64_t top = std::min(df::cellOf(now.y), df::cellOf(then.y));
  const std::int64_t right = std::max(df::cellOf(now.x), df::cellOf(then.x));
  const std::int64_t bottom = std::max(df::cellOf(now.y), df::cellOf(then.y));
  known.outlook.soon = CompactRect(CellRect{left, top, right + 1, bottom + 1}.grownBy(model->reach));
  return known.outlook;
}

// Put the slot into the list, or take it out.
void Publisher::list(std::vector<std::uint32_t>& slots, std::uint32_t slot, bool& is_in, bool should_be) {
  if (is_in == should_be) return;
  is_in = should_be;
  if (should_be) return slots.push_back(slot);
  *std::find(slots.begin(), slots.end(), slot) = slots.back();
  slots.pop_back();
}

void Publisher::bury(df::ObjectKey key) {
  if (key.slot >= m_models.size()) return;
  Tracked& tracked = m_models[key.slot];
  if (!tracked.model.alive || tracked.model.generation != key.generation) return;
  tracked.model.alive = false;
  file(key.slot, tracked);
  mark(key.slot, tracked, 0);
}

void Publisher::takePath(Tracked& tracked, const Motion& truth) {
  if (rebase(tracked.path, m_tick) == truth) return;
  tracked.run = m_tick - tracked.path.tick;
  tracked.path = truth;
}

bool Publisher::isExact(const Tracked& tracked) const {
  const Model& model = tracked.model;
  if (m_exact_solids && model.state.body.solidness != df::SPECTRAL && !isMoving(tracked.truth)) return true;
  const auto slot = static_cast<std::uint32_t>(&tracked - m_models.data());
  auto found = std::lower_bound(m_exact.begin(), m_exact.end(), slot,
                                [](df::ObjectKey key, std::uint32_t s) { return key.slot < s; });
  for (; found != m_exact.end() && found->slot == slot; ++found) {
    if (found->generation == model.generation) return true;
  }
  return false;
}

// Whom a player follows may have had a coarse model until now.
void Publisher::keepExact(df::ObjectKey key) {
  if (key.slot >= m_models.size()) return;
  Tracked& tracked = m_models[key.slot];
  if (!tracked.model.alive || tracked.model.generation != key.generation) return;
  const Motion truth = truthNow(tracked);
  if (rebase(tracked.model.state.motion, m_tick) == truth) return;
  tracked.model.state.motion = truth;
  // Sooner than planned, not later: in this tick it may still turn out not to be drawn.
  if (isNewer(m_look_at[key.slot], m_tick + 1)) m_look_at[key.slot] = m_tick + 1;
  tracked.off_views = m_tick;
  mark(key.slot, tracked, kMotion);
}

// Those published before anybody predicted.
void Publisher::keepSolidsExact() {
  for (std::uint32_t slot = 0; slot < m_models.size(); ++slot) {
    const Tracked& tracked = m_models[slot];
    if (tracked.model.alive && isExact(tracked)) keepExact({slot, tracked.model.generation});
  }
}

// Coarser numbers for a motion that was just taken over from the world.
void Publisher::fit(Tracked& tracked) {
  if (&tracked == &m_loose || isExact(tracked)) return;
  const Sequence& sequence = tracked.model.state.look.sequence;
  std::array<df::FixedVector, kMaxOffsets> offsets{};  // the position's own cell, first of all
  std::size_t count = 1;
  const auto add = [&](std::int32_t dx, std::int32_t dy) {
    constexpr int kShift = df::kFixedBits - kGlyphUnitBits;
    constexpr df::Fixed kMask = df::kFixedOne - 1;
    const df::FixedVector offset{(df::Fixed{dx} * (df::Fixed{1} << kShift)) & kMask,
                                 (df::Fixed{dy} * (df::Fixed{1} << kShift)) & kMask};
    const auto end = offsets.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::find(offsets.begin(), end, offset) != end) return true;
    if (count == kMaxOffsets) return false;
    offsets[count++] = offset;
    return true;
  };
  if (sequence.isWhole()) {
    add(sequence.fraction().x, sequence.fraction().y);
  } else {
    for (const Appearance& appearance : sequence) {
      for (const Glyph& glyph : appearance) {
        if (!add(glyph.dx, glyph.dy)) return;
      }
    }
  }
  const std::uint32_t age = m_tick - tracked.path.tick;
  const std::uint32_t horizon = age == 0 ? std::clamp(2 * tracked.run, kShortestHorizon, kHorizonAfterTurn)
                                         : std::max(kPatience * age, kShortestHorizon);
  tracked.model.state.motion =
      fitMotion(tracked.model.state.motion, std::span(offsets).first(count), horizon);
}

// Keep track of how far the object's characters reach and where it is.
void Publisher::file(std::uint32_t slot, Tracked& tracked) {
  Model& model = tracked.model;
  model.reach = !model.alive ? 0 : model.state.body.on_view ? kOnEveryView : reachOf(model.state.look);
  const bool wide = model.alive && (slot == kLooseSlot || model.reach > kWide);
  list(m_wide, slot, tracked.wide, wide);
  if (slot == kLooseSlot) return;
  if (wide || !model.alive) return m_grid.remove(slot);
  m_reach = std::max(m_reach, model.reach);
  m_grid.put(slot, {df::cellOf(tracked.truth.position.x), df::cellOf(tracked.truth.position.y)});
}

void Publisher::takeFacts(const df::ObjectFacts& facts) {
  Tracked* tracked = track(facts.key.slot);
  if (tracked == nullptr) return;
  Model& model = tracked->model;
  const Motion truth{m_tick, facts.position, facts.velocity, facts.acceleration};
  const df::Solidness solidness = facts.on_view ? df::SPECTRAL : facts.solidness;
  const Body body{facts.box, solidness, facts.no_soft, facts.on_view};
  m_look_at[facts.key.slot] = m_tick;
  if (tracked->truth.velocity != facts.velocity || tracked->shown != facts.shown) tracked->off_views = m_tick;
  tracked->truth = truth;
  tracked->shown = facts.shown;
  takePath(*tracked, truth);

  if (!model.alive || model.generation != facts.key.generation) {
    model = {facts.key.generation, true, {facts.order, truth, {{}, facts.altitude}, body}};
    m_newest_order = std::max(m_newest_order, facts.order);
    tracked->path = truth;
    tracked->run = 0;
    file(facts.key.slot, *tracked);
    mark(facts.key.slot, *tracked, kAllGroups);
    return;
  }
  if (!tracked->wide)
    m_grid.put(facts.key.slot, {df::cellOf(truth.position.x), df::cellOf(truth.position.y)});
  if (model.state.body != body) {
    model.state.body = body;
    file(facts.key.slot, *tracked);  // it may be a view object from now on
    mark(facts.key.slot, *tracked, kBody);
  }
  if (model.state.look.altitude != facts.altitude) {
    model.state.look.altitude = facts.altitude;
    mark(facts.key.slot, *tracked, kLook);
  }
  if (m_exact_solids && isExact(*tracked)) keepExact(facts.key);
}

}  // namespace naiad
