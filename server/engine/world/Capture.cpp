#include "engine/world/Capture.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "engine/world/ActivityPage.h"
#include "engine/world/EventDispatch.h"
#include "engine/world/Views.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldState.h"
#include "engine/world/WorldStore.h"
#include "shared/replica/Look.h"

namespace df {

namespace {

bool isNear(FixedVector a, FixedVector b) {
  constexpr double kCells = 1e6;
  return std::fabs(toCells(a.x) - toCells(b.x)) <= kCells && std::fabs(toCells(a.y) - toCells(b.y)) <= kCells;
}

}  // namespace

Capture::Capture(WorldStore& store, Views& views, EventDispatch& events, const LazyExtras& extras,
                 const WorldState& state)
    : m_store(store), m_views(views), m_events(events), m_extras(extras), m_state(state) {}

void Capture::clearPicture() {
  m_view.drawn.clear();
  m_view.commands.clear();
  m_view.looks.clear();
  m_view.changed.clear();
  m_view.vanished.clear();
  m_view.players.clear();
  m_view.sounds.clear();
  m_view.sounds_lost = 0;
  m_view.playing.clear();
  m_view.notes.clear();
  m_view.shake_x = m_view.shake_y = 0;
}

bool Capture::mayDraw(std::uint32_t slot) {
  WorldStore& store = m_store;
  if (!store.has(slot, WorldStore::kActive) || !store.has(slot, WorldStore::kVisible)) return false;
  if (!store.has(slot, WorldStore::kClassified)) m_events.classifyObject(slot);
  constexpr std::uint32_t kShows = WorldStore::kFrames | WorldStore::kPainted;
  return !store.has(slot, WorldStore::kNeverDraws) || (store.flags(slot) & kShows) != 0;
}

void Capture::sortByAltitude() {
  const WorldStore& store = m_store;
  const ViewCover views = m_views.cover();
  m_view.corner = m_views.cornerOf(nullptr);
  for (auto& keys : m_by_altitude) keys.clear();
  const WorldStore::Walk walk(store);
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const WorldStore::Slot s = walk[i];
    if (s == WorldStore::kNoSlot || !mayDraw(s)) continue;
    const FixedBox box = store.worldBox(s, store.position(s));
    if (views.intersectsAny(box) || store.has(s, WorldStore::kOnView))
      m_by_altitude[store.altitude(s)].push_back(store.key(s));
  }
}

void Capture::drawAll() {
  sortByAltitude();
  for (const auto& keys : m_by_altitude) {
    for (const ObjectKey key : keys) {
      if (m_store.isCurrent(key) && mayDraw(key.slot)) drawOne(key);
    }
  }
}

void Capture::drawOne(ObjectKey key) {
  WorldStore& store = m_store;
  const FixedVector position = store.position(key.slot);
  const auto first = static_cast<std::uint32_t>(m_view.commands.size());
  const std::size_t entry = m_view.drawn.size();
  m_view.drawn.push_back({key, first, 0, store.has(key.slot, WorldStore::kOnView)});

  if (store.has(key.slot, WorldStore::kLookCached) && !store.has(key.slot, WorldStore::kFrames)) {
    const std::vector<DrawCommand>& look = m_looks[key.slot];
    for (const DrawCommand& c : look) m_view.commands.push_back({position + c.position, c.ch, c.color});
    m_view.drawn[entry].count = static_cast<std::uint32_t>(look.size());
    publishLook(entry);
    return;
  }

  m_drawing = key;
  try {
    Object& object = *store.object(key.slot);
    const ActivityScope running(m_events.activity(), classOf(object), Activity::kDraw);
    object.draw();
  } catch (const std::exception& e) {
    m_events.quarantine(key, e.what());
  } catch (...) {
    m_events.quarantine(key, "an exception in draw()");
  }
  m_drawing = {};
  const auto count = static_cast<std::uint32_t>(m_view.commands.size()) - first;
  m_view.drawn[entry].count = count;
  if (!store.isCurrent(key)) return;
  const bool frames = store.has(key.slot, WorldStore::kFrames);  // after draw(), which may set frames
  publishLook(entry);
  if (frames || !store.has(key.slot, WorldStore::kStaticLook)) return;
  if (m_looks.size() <= key.slot) m_looks.resize(std::size_t{key.slot} + 1);
  store.set(key.slot, WorldStore::kLookCached, true);
  std::vector<DrawCommand>& relative = m_looks[key.slot];
  relative.clear();
  for (std::uint32_t i = first; i < first + count; ++i) {
    const DrawCommand& c = m_view.commands[i];
    // Skips characters so far from the Object that their positions could overflow when it moves.
    if (!isNear(c.position, position)) continue;
    relative.push_back({c.position - position, c.ch, c.color});
  }
}

void Capture::publishLook(std::size_t entry) {
  const WorldStore& store = m_store;
  const std::uint32_t slot = m_view.drawn[entry].key.slot;
  constexpr std::uint32_t kShows = WorldStore::kFrames | WorldStore::kPainted;
  if (!store.isWatched() || (store.flags(slot) & kShows) == 0) return;
  const auto tick = static_cast<std::uint32_t>(m_state.step_count);
  auto p_look = store.object(slot)->publishedLook(tick);
  if (p_look != nullptr) m_view.looks.push_back({static_cast<std::uint32_t>(entry), std::move(p_look)});
}

void Capture::add(FixedVector position, char32_t ch, Color color) {
  if (m_drawing == ObjectKey{}) {
    const auto first = static_cast<std::uint32_t>(m_view.commands.size());
    if (m_view.drawn.empty() || m_view.drawn.back().key != ObjectKey{})
      m_view.drawn.push_back({{}, first, 0, false});
    ++m_view.drawn.back().count;
  }
  m_view.commands.push_back({position, isDrawable(ch) ? ch : U'?', color});
}

void Capture::addFrame(std::uint32_t slot) {
  constexpr int kShift = kFixedBits - naiad::kGlyphUnitBits;
  const WorldStore& store = m_store;
  const std::shared_ptr<const naiad::Look> p_look = store.frames(slot);
  if (p_look == nullptr) return;
  const FixedVector position = store.position(slot);
  const naiad::Appearance* appearance = p_look->select(static_cast<std::uint32_t>(m_state.step_count));
  for (const naiad::Glyph& glyph : *appearance) {
    const FixedVector offset{Fixed{glyph.dx} * (Fixed{1} << kShift), Fixed{glyph.dy} * (Fixed{1} << kShift)};
    add(position + offset, glyph.ch, glyph.color);
  }
}

void Capture::finishView() {
  WorldStore& store = m_store;
  if (!store.isWatched()) return;
  m_view.tick = static_cast<std::uint32_t>(m_state.step_count);
  m_view.boundary = m_views.boundary();
  m_view.view_width = m_views.width();
  m_view.view_height = m_views.height();
  store.report(m_view);
  for (const auto& [id, p_player] : m_views.players()) m_view.players.push_back(p_player->facts());
  if (const WorldExtras* p_extras = m_extras.find()) {
    m_view.sounds = p_extras->sounds;
    m_view.sounds_lost = p_extras->sounds_lost;
    m_view.playing = p_extras->playing;
    m_view.notes = p_extras->notes;
    m_view.background = p_extras->background;
    m_view.shake_x = p_extras->shake.x;
    m_view.shake_y = p_extras->shake.y;
    shake();
  }
}

// Shifts every view. In this tick they follow nothing, because a client would undo the shift by following.
void Capture::shake() {
  if (m_view.shake_x == 0 && m_view.shake_y == 0) return;
  const FixedVector off{fromCells(m_view.shake_x), fromCells(m_view.shake_y)};
  for (PlayerFacts& player : m_view.players) {
    player.view_corner = player.view_corner + off;
    player.followed = {};
  }
}

Canvas Capture::render(FixedVector corner) const {
  Canvas canvas(m_views.width(), m_views.height());
  for (const DrawnObject& drawn : m_view.drawn) {
    const std::int64_t left = drawn.on_view ? 0 : cellOf(corner.x) + m_view.shake_x;
    const std::int64_t top = drawn.on_view ? 0 : cellOf(corner.y) + m_view.shake_y;
    for (std::uint32_t i = drawn.first; i < drawn.first + drawn.count; ++i) {
      const DrawCommand& c = m_view.commands[i];
      const FixedVector at = drawn.on_view ? c.position - m_view.corner : c.position;
      const std::int64_t x = cellOf(at.x) - left;
      const std::int64_t y = cellOf(at.y) - top;
      if (x < 0 || y < 0 || x >= canvas.width() || y >= canvas.height()) continue;
      canvas.put(static_cast<int>(x), static_cast<int>(y), {c.ch, c.color});
    }
  }
  return canvas;
}

Canvas Capture::renderPlayer(std::uint32_t player) const {
  const Player* p_player = m_views.player(player);
  Canvas canvas = render(m_views.cornerOf(p_player));
  if (p_player == nullptr) return canvas;
  for (const PlayerText& text : p_player->facts().texts) {
    int x = text.x;
    for (const char32_t ch : decodeUtf8(text.text)) canvas.put(x++, text.y, {ch, text.color});
  }
  return canvas;
}

}  // namespace df
