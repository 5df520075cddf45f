#include "Publisher.h"

#include <algorithm>
#include <utility>

#include "LookCapture.h"

namespace naiad {

namespace {

bool sameCell(df::FixedVector a, df::FixedVector b) {
  return df::cellOf(a.x) == df::cellOf(b.x) && df::cellOf(a.y) == df::cellOf(b.y);
}

/// Would any glyph of the appearance fall into any player's view?
bool landsInAView(const Appearance& appearance, df::FixedVector position, const df::WorldView& view) {
  return std::any_of(view.players.begin(), view.players.end(), [&](const df::PlayerFacts& player) {
    const std::int64_t left = df::cellOf(player.view_corner.x);
    const std::int64_t top = df::cellOf(player.view_corner.y);
    return std::any_of(appearance.begin(), appearance.end(), [&](const Glyph& glyph) {
      const CellPosition cell = glyphCell(position, glyph);
      return cell.x >= left && cell.x < left + view.view_width && cell.y >= top &&
             cell.y < top + view.view_height;
    });
  });
}

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
  if (slot >= m_models.size()) m_models.resize(std::size_t{slot} + 1);
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
  m_changes.push_back({slot, 0});
}

void Publisher::update(const df::WorldView& view) {
  m_tick = view.tick;
  m_world = {view.boundary, view.view_width, view.view_height};
  m_changes.clear();

  for (const df::ObjectKey key : view.vanished) bury(key);
  for (const df::ObjectFacts& facts : view.changed) takeFacts(facts);
  for (const df::DrawnObject& drawn : view.drawn) takeDrawing(view, drawn);
  takeLoose(view);
  correctUndrawn(view);

  for (Change& change : m_changes) {
    Tracked& tracked = change.slot == kLooseSlot ? m_loose : m_models[change.slot];
    change.groups = tracked.model.alive ? tracked.changed : 0;
    tracked.changed = 0;
    tracked.touched = false;
  }
}

void Publisher::bury(df::ObjectKey key) {
  if (key.slot >= m_models.size()) return;
  Tracked& tracked = m_models[key.slot];
  if (!tracked.model.alive || tracked.model.generation != key.generation) return;
  tracked.model.alive = false;
  mark(key.slot, tracked, 0);
}

void Publisher::takeFacts(const df::ObjectFacts& facts) {
  Tracked* tracked = track(facts.key.slot);
  if (tracked == nullptr) return;
  Model& model = tracked->model;
  const Motion truth{m_tick, facts.position, facts.velocity, facts.acceleration};
  const Body body{facts.box, facts.solidness, facts.no_soft};
  tracked->truth = truth;
  tracked->shown = facts.shown;

  if (!model.alive || model.generation != facts.key.generation) {
    model = {facts.key.generation, true, {facts.order, truth, {{}, facts.altitude}, body}};
    mark(facts.key.slot, *tracked, kAllGroups);
    return;
  }
  if (model.state.body != body) {
    model.state.body = body;
    mark(facts.key.slot, *tracked, kBody);
  }
  if (model.state.look.altitude != facts.altitude) {
    model.state.look.altitude = facts.altitude;
    mark(facts.key.slot, *tracked, kLook);
  }
}

void Publisher::takeDrawing(const df::WorldView& view, const df::DrawnObject& drawn) {
  if (drawn.key.generation == 0 || drawn.key.slot >= m_models.size()) return;
  Tracked& tracked = m_models[drawn.key.slot];
  if (!tracked.model.alive || tracked.model.generation != drawn.key.generation) return;
  tracked.drawn = m_tick;
  correctLook(drawn.key.slot, tracked, view.commands.data() + drawn.first, drawn.count);
}

void Publisher::correctLook(std::uint32_t slot, Tracked& tracked, const df::DrawCommand* commands,
                            std::size_t count) {
  const std::span<const df::DrawCommand> drawn(commands, count);
  ObjectState& state = tracked.model.state;
  const df::FixedVector truth = tracked.truth.position;
  df::FixedVector modelled = positionAt(state.motion, m_tick);
  if (sameCell(modelled, truth) && drawsTheSame(state.look, modelled, drawn)) return;

  // A path that turned is the usual cause: try the known look at the true place before making a new one.
  if (!sameCell(modelled, truth) || drawsTheSame(state.look, truth, drawn)) {
    state.motion = truthNow(tracked);
    modelled = truth;
    mark(slot, tracked, kMotion);
    ++m_corrections;
    if (drawsTheSame(state.look, modelled, drawn)) return;
  }
  // A drawing too large to be described whole is cut the same way each time, and not news each time.
  const std::vector<Appearance> before = std::exchange(state.look.sequence, {});
  if (count > 0) {
    state.look.sequence.push_back(captureAppearance(truth, drawn));
    if (!drawsTheSame(state.look, modelled, drawn))
      state.look.sequence.front() = captureCells(modelled, drawn);
    fitToRecord(state.look);
  }
  if (state.look.sequence != before) mark(slot, tracked, kLook);
}

void Publisher::takeLoose(const df::WorldView& view) {
  std::vector<df::DrawCommand> loose;
  for (const df::DrawnObject& drawn : view.drawn) {
    if (drawn.key.generation != 0) continue;
    loose.insert(loose.end(), view.commands.begin() + drawn.first,
                 view.commands.begin() + drawn.first + drawn.count);
  }
  if (loose.empty() && !m_loose.model.alive) return;
  if (!m_loose.model.alive) {
    // Far below everything, and never moving: each glyph's offset says where it is.
    m_loose.model = {1, true, {0, {m_tick, loose.front().position, {}, {}}, {{}, 0}, {}}};
    m_loose.model.state.body.solidness = df::SPECTRAL;
    m_loose.truth = m_loose.model.state.motion;
    mark(kLooseSlot, m_loose, kAllGroups);
  }
  correctLook(kLooseSlot, m_loose, loose.data(), loose.size());
}

void Publisher::correctUndrawn(const df::WorldView& view) {
  for (std::uint32_t slot = 0; slot < m_models.size(); ++slot) {
    Tracked& tracked = m_models[slot];
    if (!tracked.model.alive || tracked.drawn == m_tick) continue;
    ObjectState& state = tracked.model.state;
    if (!sameCell(positionAt(state.motion, m_tick), tracked.truth.position)) {
      state.motion = truthNow(tracked);
      mark(slot, tracked, kMotion);
      ++m_corrections;
    }
    // draw() did not run, so nothing of it may show; off every view its look can wait there unseen.
    if (const Appearance* appearance = state.look.select(m_tick)) {
      if (tracked.shown && !landsInAView(*appearance, positionAt(state.motion, m_tick), view)) continue;
      state.look.sequence.clear();
      mark(slot, tracked, kLook);
    }
  }
}

}  // namespace naiad
