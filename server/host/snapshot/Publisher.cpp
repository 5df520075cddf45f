#include "host/snapshot/Publisher.h"

#include <algorithm>
#include <array>

#include "host/snapshot/MotionFit.h"
#include "shared/replica/Acks.h"
#include "shared/replica/LookCodec.h"

namespace naiad {

namespace {

/// Above this many looks, those not entered for kForgetAfter ticks are dropped, or all if that is not enough.
constexpr std::size_t kMaxRemembered = 16'384;
constexpr std::uint32_t kForgetAfter = 9'000;
/// Number of shared sequences, including sequences that no object has any more, at which all are dropped.
constexpr std::size_t kMaxShared = 2'048;

/// Ticks for which a path is fitted: at least kMinHorizon, and after a turn at most kHorizonAfterTurn.
constexpr std::uint32_t kMinHorizon = 64;
constexpr std::uint32_t kHorizonAfterTurn = 512;
/// A path that outlives its model's horizon is fitted again, for a horizon of its age times this factor.
constexpr std::uint32_t kHorizonFactor = 8;
/// Models with more distinct glyph offsets (modulo a cell, and including 0) are not fitted: this would be
/// slow and rarely find coarse numbers.
constexpr std::size_t kMaxOffsets = 6;

}  // namespace

// A look recurs if it was entered before or is animated. So a text that changes all the time never recurs.
void LookCatalogue::enterLook(PublishedModel& model, std::uint32_t tick) {
  Look& look = model.state.look;
  model.look_sum = 0;
  model.recurs = false;
  share(look.sequence);
  if (look.sequence.empty() || isSingleCharacter(look.sequence)) return;
  model.look_sum = look.sequence.sum();
  const auto [known, fresh] = m_last_used.try_emplace(model.look_sum, tick);
  model.recurs = !fresh || look.sequence.size() > 1;
  known->second = tick;
  if (m_last_used.size() <= kMaxRemembered) return;
  std::erase_if(m_last_used, [tick](const auto& used) { return tick - used.second > kForgetAfter; });
  if (m_last_used.size() > kMaxRemembered) m_last_used.clear();
}

// Objects with equal looks share one copy, so that the comparison in every tick reads less memory.
void LookCatalogue::share(Sequence& sequence) {
  if (sequence.empty()) return;
  if (m_sequences.size() >= kMaxShared) m_sequences.clear();
  const auto [known, fresh] = m_sequences.try_emplace(sequence.sum(), sequence);
  if (!fresh && known->second == sequence) sequence = known->second;
}

const Publisher::Model* Publisher::find(std::uint32_t slot) const {
  if (slot == kFreeDrawSlot) return m_free_draw.model.alive ? &m_free_draw.model : nullptr;
  return slot < m_models.size() && m_models[slot].model.alive ? &m_models[slot].model : nullptr;
}

Publisher::Tracked* Publisher::track(std::uint32_t slot) {
  if (slot >= kFreeDrawSlot) {
    ++m_refused;
    return nullptr;
  }
  if (slot >= m_models.size()) {
    m_models.resize(std::size_t{slot} + 1);
    m_examine_at.resize(m_models.size(), m_tick);
  }
  return &m_models[slot];
}

// Moving objects are reported every tick, so an object that was not reported stands still.
Motion Publisher::truthNow(const Tracked& tracked) const {
  if (tracked.truth.tick == m_tick) return tracked.truth;
  return {m_tick, tracked.truth.position, {}, {}};
}

void Publisher::markChanged(std::uint32_t slot, Tracked& tracked, std::uint8_t groups) {
  tracked.changed |= groups;
  if (tracked.touched) return;
  tracked.touched = true;
  m_changes.push_back({slot, 0, {}});
}

void Publisher::update(const df::WorldView& view) {
  m_tick = view.tick;
  m_forecasts.clear();
  m_motions.clear();
  const bool is_color = view.background >= df::BLACK && view.background <= df::WHITE;
  m_world = {view.boundary, view.view_width, view.view_height, is_color ? view.background : df::BLACK};
  m_changes.clear();
  const bool controls = m_exact.updatePlayers(view.players);

  for (const df::ObjectKey key : view.vanished) removeObject(key);
  for (const df::ObjectFacts& facts : view.changed) applyFacts(facts);
  auto declared = view.looks.begin();
  for (const df::DrawnObject& drawn : view.drawn) {
    const bool declares = declared != view.looks.end() && &view.drawn[declared->drawn] == &drawn;
    applyDrawing(view, drawn, declares ? (declared++)->p_look.get() : nullptr);
  }
  applyFreeDraw(view);
  correctUndrawnObjects(view);
  if (controls) setExactSolids(true);
  if (m_exact.popNewSolids()) keepSolidsExact();
  for (const df::ObjectKey key : m_exact.keys()) keepExact(key);

  m_change_index.clear();
  for (Change& change : m_changes) {
    finishChange(change);
    m_change_index.add(change.slot, change.groups != 0 ? change.sweep : CompactRect::nowhere());
  }
}

void Publisher::finishChange(Change& change) {
  Tracked& tracked = change.slot == kFreeDrawSlot ? m_free_draw : m_models[change.slot];
  change.groups = tracked.model.alive ? tracked.changed : 0;
  if ((change.groups & (kMotion | kLook)) != 0) indexModel(change.slot, tracked);
  if ((change.groups & kMotion) != 0) fitModel(tracked);
  if ((change.groups & kLook) != 0) m_looks.enterLook(tracked.model, m_tick);
  if (change.groups == 0 || (change.groups & kMotion) != 0) {
    m_index.indexMotion(change.slot, tracked.model, tracked.membership);
  }
  m_index.updateMaxSpeed(tracked.model, tracked.membership);
  change.sweep = CompactRect(sweepOf(tracked.model, m_tick, kSweep));
  tracked.changed = 0;
  tracked.touched = false;
}

const SharedMotion& Publisher::shareMotionOf(std::uint32_t slot) const {
  return m_motions.put(cacheIndex(slot), m_models.size() + 1,
                       shareMotion(rebase(find(slot)->state.motion, m_tick)));
}

const Publisher::Forecast& Publisher::computeForecast(std::uint32_t slot, std::uint32_t soon,
                                                      std::uint32_t later) const {
  if (soon != m_soon || later != m_later) {
    m_forecasts.clear();
    m_soon = soon;
    m_later = later;
  }
  const Model* model = find(slot);
  return m_forecasts.put(cacheIndex(slot), m_models.size() + 1,
                         model != nullptr ? forecastOf(*model, m_tick, soon, later) : Forecast{});
}

void Publisher::removeObject(df::ObjectKey key) {
  if (key.slot >= m_models.size()) return;
  Tracked& tracked = m_models[key.slot];
  if (!tracked.model.alive || tracked.model.generation != key.generation) return;
  tracked.model.alive = false;
  --m_live;
  indexModel(key.slot, tracked);
  markChanged(key.slot, tracked, 0);
}

void Publisher::applyPath(Tracked& tracked, const Motion& truth) {
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

// Replaces a coarse motion by the true one, for example of an object that a player has just begun to follow.
void Publisher::keepExact(df::ObjectKey key) {
  if (key.slot >= m_models.size()) return;
  Tracked& tracked = m_models[key.slot];
  if (!tracked.model.alive || tracked.model.generation != key.generation) return;
  const Motion truth = truthNow(tracked);
  if (rebase(tracked.model.state.motion, m_tick) == truth) return;
  tracked.model.state.motion = truth;
  // Examine the object by the next tick, because its draw() may not run. If it is due now, it stays due.
  if (isNewer(m_examine_at[key.slot], m_tick + 1)) m_examine_at[key.slot] = m_tick + 1;
  tracked.off_views = m_tick;
  markChanged(key.slot, tracked, kMotion);
}

// Corrects the solid objects that were published before any client predicted.
void Publisher::keepSolidsExact() {
  for (std::uint32_t slot = 0; slot < m_models.size(); ++slot) {
    const Tracked& tracked = m_models[slot];
    if (tracked.model.alive && isExact(tracked)) keepExact({slot, tracked.model.generation});
  }
}

// Finds coarser numbers for a motion that was just copied from the world.
void Publisher::fitModel(Tracked& tracked) {
  if (&tracked == &m_free_draw || isExact(tracked)) return;
  const Sequence& sequence = tracked.model.state.look.sequence;
  std::array<df::FixedVector, kMaxOffsets> offsets{};  // the first offset, 0, stands for the position itself
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
  const std::uint32_t horizon = age == 0 ? std::clamp(2 * tracked.run, kMinHorizon, kHorizonAfterTurn)
                                         : std::max(kHorizonFactor * age, kMinHorizon);
  tracked.model.state.motion =
      fitMotion(tracked.model.state.motion, std::span(offsets).first(count), horizon);
}

// Call when the object's reach or its entry in the index may have changed.
void Publisher::indexModel(std::uint32_t slot, Tracked& tracked) {
  tracked.model.reach = reachOf(tracked.model);
  m_index.indexModel(slot, tracked.model, tracked.truth.position, tracked.membership);
}

void Publisher::applyFacts(const df::ObjectFacts& facts) {
  Tracked* tracked = track(facts.key.slot);
  if (tracked == nullptr) return;
  Model& model = tracked->model;
  const Motion truth{m_tick, facts.position, facts.velocity, facts.acceleration};
  const df::Solidness solidness = facts.on_view ? df::SPECTRAL : facts.solidness;
  const Body body{facts.box, solidness, facts.no_soft, facts.on_view};
  m_examine_at[facts.key.slot] = m_tick;
  if (tracked->truth.velocity != facts.velocity || tracked->shown != facts.shown) tracked->off_views = m_tick;
  tracked->truth = truth;
  tracked->shown = facts.shown;
  applyPath(*tracked, truth);

  if (!model.alive || model.generation != facts.key.generation) {
    m_live += model.alive ? 0 : 1;
    model = {facts.key.generation, true, {facts.order, truth, {{}, facts.altitude}, body}};
    m_newest_order = std::max(m_newest_order, facts.order);
    tracked->path = truth;
    tracked->run = 0;
    indexModel(facts.key.slot, *tracked);
    markChanged(facts.key.slot, *tracked, kAllGroups);
    return;
  }
  m_index.indexMove(facts.key.slot, truth.position, tracked->membership);
  if (model.state.body != body) {
    model.state.body = body;
    indexModel(facts.key.slot, *tracked);  // it may have become a view object
    markChanged(facts.key.slot, *tracked, kBody);
  }
  if (model.state.look.altitude != facts.altitude) {
    model.state.look.altitude = facts.altitude;
    markChanged(facts.key.slot, *tracked, kLook);
  }
  if (m_exact.hasSolids() && isExact(*tracked)) keepExact(facts.key);
}

}  // namespace naiad
