// The Publisher's looks: publishes the looks that objects drew, and removes looks that are no longer drawn.
#include <algorithm>
#include <cstdlib>

#include "host/snapshot/LookCapture.h"
#include "host/snapshot/Publisher.h"
#include "shared/replica/Acks.h"
#include "shared/replica/Motion.h"

namespace naiad {

namespace {

/// True if any glyph of the appearance falls into any player's view.
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

/// Returns ticks for which the model, now outside all views, stays so if they move at most a cell per tick.
std::uint32_t ticksOffViews(const Publisher::Model& model, std::uint32_t tick, const df::WorldView& view) {
  constexpr std::int64_t kFar = 1 << 20;
  const Motion motion = rebase(model.state.motion, tick);
  if (motion.acceleration != df::FixedVector{}) return 0;
  const std::int64_t x = df::cellOf(motion.position.x);
  const std::int64_t y = df::cellOf(motion.position.y);
  std::int64_t nearest = kFar;
  for (const df::PlayerFacts& player : view.players) {
    const std::int64_t left = df::cellOf(player.view_corner.x);
    const std::int64_t top = df::cellOf(player.view_corner.y);
    nearest = std::min(nearest, std::max({left - x, x - (left + view.view_width - 1), top - y,
                                          y - (top + view.view_height - 1)}));
  }
  const double speed =
      std::max(std::abs(df::toCells(motion.velocity.x)), std::abs(df::toCells(motion.velocity.y)));
  const double free = static_cast<double>(nearest - model.reach - 1);
  return free <= 0 ? 0 : static_cast<std::uint32_t>(free / (speed + 1));
}

/// An object that stands still and shows nothing is examined again only after this many ticks.
constexpr std::uint32_t kNeverExamine = 1u << 20;
}  // namespace

void Publisher::applyDrawing(const df::WorldView& view, const df::DrawnObject& drawn, const Look* declared) {
  if (drawn.key.generation == 0 || drawn.key.slot >= m_models.size()) return;
  Tracked& tracked = m_models[drawn.key.slot];
  if (!tracked.model.alive || tracked.model.generation != drawn.key.generation) return;
  tracked.drawn = tracked.off_views = m_tick;
  m_examine_at[drawn.key.slot] =
      m_tick + 1;  // correctUndrawnObjects() examines the object then, unless it is drawn again
  std::span<const df::DrawCommand> commands{view.commands.data() + drawn.first, drawn.count};
  if (drawn.on_view) commands = relativeToView(commands, view.corner);
  correctLook(drawn.key.slot, tracked, commands, declared);
}

// Converts commands drawn in the world's own view to positions relative to its corner, as in every view.
std::span<const df::DrawCommand> Publisher::relativeToView(std::span<const df::DrawCommand> drawn,
                                                           df::FixedVector corner) {
  m_off_view.assign(drawn.begin(), drawn.end());
  for (df::DrawCommand& command : m_off_view) command.position = command.position - corner;
  return m_off_view;
}

void Publisher::correctLook(std::uint32_t slot, Tracked& tracked, std::span<const df::DrawCommand> drawn,
                            const Look* declared) {
  ObjectState& state = tracked.model.state;
  const df::FixedVector truth = tracked.truth.position;
  const df::FixedVector modelled = positionAt(state.motion, m_tick);
  if (isSameCell(modelled, truth) && drawsTheSame(state.look, m_tick, modelled, drawn)) return;

  // Usually a path turned: try the known look at the true position before making a new one.
  if (!isSameCell(modelled, truth) || drawsTheSame(state.look, m_tick, truth, drawn)) {
    state.motion = truthNow(tracked);
    markChanged(slot, tracked, kMotion);
    ++m_corrections;
    if (drawsTheSame(state.look, m_tick, truth, drawn)) return;
  }
  const Look before = state.look;
  // A declared look is used if it matches what was drawn: the object's own draw() may have drawn more.
  if (declared != nullptr && drawsTheSame(*declared, m_tick, truth, drawn)) {
    state.look.sequence = declared->sequence;
    state.look.selector = declared->selector;
    if (!drawsTheSame(state.look, m_tick, positionAt(state.motion, m_tick), drawn)) {
      state.motion = truthNow(tracked);  // finishChange() fits it again
      markChanged(slot, tracked, kMotion);
    }
  } else {
    captureLook(slot, tracked, drawn);
  }
  // A drawing too large for a record is always truncated in the same way, so its look does not change.
  if (state.look != before) markChanged(slot, tracked, kLook);
}

void Publisher::captureLook(std::uint32_t slot, Tracked& tracked, std::span<const df::DrawCommand> drawn) {
  ObjectState& state = tracked.model.state;
  const df::FixedVector truth = tracked.truth.position;
  state.look.selector = {};
  state.look.sequence = {};
  if (drawn.empty()) return;
  df::FixedVector modelled = positionAt(state.motion, m_tick);
  Appearance appearance = captureAppearance(truth, drawn);
  state.look.sequence = {appearance};
  if (modelled != truth && !drawsTheSame(state.look, m_tick, modelled, drawn)) {
    state.motion = truthNow(tracked);  // finishChange() fits it again
    modelled = truth;
    markChanged(slot, tracked, kMotion);
  }
  if (!drawsTheSame(state.look, m_tick, modelled, drawn)) appearance = captureCells(modelled, drawn);
  state.look.sequence = fitToRecord(std::move(appearance));
}

void Publisher::applyFreeDraw(const df::WorldView& view) {
  std::vector<df::DrawCommand> loose;
  for (const df::DrawnObject& drawn : view.drawn) {
    if (drawn.key.generation != 0) continue;
    loose.insert(loose.end(), view.commands.begin() + drawn.first,
                 view.commands.begin() + drawn.first + drawn.count);
  }
  if (loose.empty() && !m_free_draw.model.alive) return;
  if (!m_free_draw.model.alive) {
    // The model lies below all objects and does not move, so a glyph's offset determines where it is drawn.
    m_free_draw.model = {1, true, {0, {m_tick, loose.front().position, {}, {}}, {{}, 0}, {}}};
    m_free_draw.model.state.body.solidness = df::SPECTRAL;
    m_free_draw.truth = m_free_draw.model.state.motion;
    markChanged(kFreeDrawSlot, m_free_draw, kAllGroups);
  }
  correctLook(kFreeDrawSlot, m_free_draw, loose, nullptr);
}

void Publisher::correctUndrawnObjects(const df::WorldView& view) {
  const bool jumped = m_views.updateViews(view);
  for (std::uint32_t slot = 0; slot < m_examine_at.size(); ++slot) {
    if (isNewer(m_examine_at[slot], m_tick) && !(jumped && m_models[slot].drawn != m_tick)) continue;
    Tracked& tracked = m_models[slot];
    m_examine_at[slot] = m_tick + kNeverExamine;
    if (!tracked.model.alive) continue;
    if (jumped) tracked.off_views = m_tick;
    correctUndrawnObject(slot, tracked, view);
    const bool standing = !isMoving(tracked.model.state.motion);
    const bool blank = tracked.model.state.look.sequence.empty();
    m_examine_at[slot] = !standing ? m_tick + 1 : blank ? m_tick + kNeverExamine : tracked.off_views;
    if (m_examine_at[slot] == m_tick) ++m_examine_at[slot];
  }
}

void Publisher::correctUndrawnObject(std::uint32_t slot, Tracked& tracked, const df::WorldView& view) {
  ObjectState& state = tracked.model.state;
  if (!isSameCell(positionAt(state.motion, m_tick), tracked.truth.position)) {
    state.motion = truthNow(tracked);
    markChanged(slot, tracked, kMotion);
    ++m_corrections;
  }
  // draw() did not run, so the object must not be seen. A look outside all views is not seen, so it may stay.
  const Appearance* appearance = state.look.select(m_tick);
  if (appearance == nullptr) return;
  if (tracked.shown && tracked.changed == 0 && isNewer(tracked.off_views, m_tick)) return;
  if (tracked.shown && !state.body.on_view &&
      !landsInAView(*appearance, positionAt(state.motion, m_tick), view)) {
    tracked.off_views = m_tick + ticksOffViews(tracked.model, m_tick, view);
    return;
  }
  state.look.sequence = {};
  state.look.selector = {};
  markChanged(slot, tracked, kLook);
}

}  // namespace naiad
