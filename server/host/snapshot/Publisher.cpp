#include "host/snapshot/Publisher.h"

#include <algorithm>
#include <array>

#include "host/snapshot/MotionFit.h"
#include "shared/replica/Acks.h"

namespace naiad {

namespace {

/// Paths are fitted for at least so many ticks, and after a turn for at most so many.
constexpr std::uint32_t kShortestHorizon = 64;
constexpr std::uint32_t kHorizonAfterTurn = 512;
/// A path that outlives its model's horizon gets one for so many times its age.
constexpr std::uint32_t kPatience = 8;
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
  m_outlooks.clear();
  m_motions.clear();
  const bool is_color = view.background >= df::BLACK && view.background <= df::WHITE;
  m_world = {view.boundary, view.view_width, view.view_height, is_color ? view.background : df::BLACK};
  m_changes.clear();
  const bool controls = m_exact.notePlayers(view.players);

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
  if (m_exact.takeNewSolids()) keepSolidsExact();
  for (const df::ObjectKey key : m_exact.keys()) keepExact(key);

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
  if ((change.groups & kLook) != 0) m_looks.enter(tracked.model, m_tick);
  if (change.groups == 0 || (change.groups & kMotion) != 0) {
    m_index.fileMotion(change.slot, tracked.model, tracked.membership);
  }
  m_index.noteSpeed(tracked.model, tracked.membership);
  change.sweep = CompactRect(sweepOf(tracked.model, m_tick, kSweep));
  tracked.changed = 0;
  tracked.touched = false;
}

const SharedMotion& Publisher::share(std::uint32_t slot) const {
  return m_motions.put(cacheIndex(slot), m_models.size() + 1,
                       shareMotion(rebase(find(slot)->state.motion, m_tick)));
}

const Publisher::Outlook& Publisher::workOut(std::uint32_t slot, std::uint32_t soon,
                                             std::uint32_t later) const {
  if (soon != m_soon || later != m_later) {
    m_outlooks.clear();
    m_soon = soon;
    m_later = later;
  }
  const Model* model = find(slot);
  return m_outlooks.put(cacheIndex(slot), m_models.size() + 1,
                        model != nullptr ? outlookOf(*model, m_tick, soon, later) : Outlook{});
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
  if (m_exact.hasSolids() && model.state.body.solidness != df::SPECTRAL && !isMoving(tracked.truth)) {
    return true;
  }
  return m_exact.contains({static_cast<std::uint32_t>(&tracked - m_models.data()), model.generation});
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

// The object's reach or place in the index may have changed.
void Publisher::file(std::uint32_t slot, Tracked& tracked) {
  tracked.model.reach = reachOf(tracked.model);
  m_index.file(slot, tracked.model, tracked.truth.position, tracked.membership);
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
  m_index.move(facts.key.slot, truth.position, tracked->membership);
  if (model.state.body != body) {
    model.state.body = body;
    file(facts.key.slot, *tracked);  // it may be a view object from now on
    mark(facts.key.slot, *tracked, kBody);
  }
  if (model.state.look.altitude != facts.altitude) {
    model.state.look.altitude = facts.altitude;
    mark(facts.key.slot, *tracked, kLook);
  }
  if (m_exact.hasSolids() && isExact(*tracked)) keepExact(facts.key);
}

}  // namespace naiad
