#include "shared/replica/Replica.h"

#include <algorithm>
#include <tuple>

#include "shared/replica/Checksum.h"

namespace naiad {

namespace {

constexpr int kLifeIndex = 0;

// The first record of a group is always applied; 0 is never a snapshot number.
bool supersedes(std::uint32_t number, std::uint32_t newest) {
  return newest == 0 || isNewer(number, newest);
}

ViewFrame frameOf(const WorldRecord& world, df::FixedVector corner) {
  return {corner, {df::fromCells(world.view_width), df::fromCells(world.view_height)}, world.boundary};
}

df::FixedVector placed(const ObjectState& object, std::uint32_t tick, const Placement* p_placement) {
  return p_placement != nullptr ? p_placement->positionOf(object, tick) : positionAt(object.motion, tick);
}

/// An object in the view.
struct Shown {
  df::FixedVector at;
  CellPosition from;  ///< corner of the view in world cells; (0, 0) for objects on the view
  const Appearance* p_glyphs;
};

struct DrawingOrder {
  std::int32_t altitude;
  std::uint64_t order;
  std::uint32_t index;  ///< index of its Shown
  friend bool operator<(const DrawingOrder& a, const DrawingOrder& b) {
    return std::tie(a.altitude, a.order, a.index) < std::tie(b.altitude, b.order, b.index);
  }
};

/// True if a glyph of an object at `at` may be within the canvas.
bool reaches(const Sequence& sequence, df::FixedVector at, CellPosition from, const df::Canvas& canvas) {
  // The fractions of the glyph's offset and the object's position add at most a cell each.
  const std::int64_t cells = (sequence.reach() >> kGlyphUnitBits) + 2;
  const std::int64_t x = std::int64_t{df::cellOf(at.x)} - from.x;
  const std::int64_t y = std::int64_t{df::cellOf(at.y)} - from.y;
  return x >= -cells && y >= -cells && x < canvas.width() + cells && y < canvas.height() + cells;
}

/// Keeps the objects that are drawn last, in any order.
void keepTopmost(std::vector<DrawingOrder>& order) {
  const auto kept = order.end() - static_cast<std::ptrdiff_t>(kMaxDrawnObjects);
  std::nth_element(order.begin(), kept, order.end());
  order.erase(order.begin(), kept);
}

void draw(df::Canvas& canvas, const Shown& object) {
  for (const Glyph& glyph : *object.p_glyphs) {
    const CellPosition cell = glyphCell(object.at, glyph);
    const std::int64_t x = std::int64_t{cell.x} - object.from.x;
    const std::int64_t y = std::int64_t{cell.y} - object.from.y;
    if (x >= 0 && y >= 0 && x < canvas.width() && y < canvas.height()) {
      canvas.put(static_cast<int>(x), static_cast<int>(y), {glyph.ch, glyph.color});
    }
  }
}

}  // namespace

void Replica::apply(const Snapshot& snapshot) {
  const std::uint32_t number = snapshot.header.number;
  const std::uint32_t tick = snapshot.header.tick;
  const Records& records = snapshot.records;
  if (supersedes(number, m_context.number)) {
    m_context.number = number;
    advanceTick(tick);
  }
  if (snapshot.header.has_input && isNewer(snapshot.header.input, m_context.input)) {
    m_context.input = snapshot.header.input;
  }
  for (const WorldRecord& world : records.worlds) {
    if (!supersedes(number, m_world_newest)) continue;
    m_world_newest = number;
    m_world = world;
  }
  for (const ViewRecord& view : records.views) {
    if (!supersedes(number, m_view_newest)) continue;
    m_view_newest = number;
    m_view = view;
    m_view_tick = tick;
  }
  for (const df::ControlTable& table : records.tables) {
    if (!supersedes(number, m_table_newest)) continue;
    m_table_newest = number;
    m_table = table;
  }
  for (const ControlRecord& control : records.controls) {
    if (!supersedes(number, m_control_newest)) continue;
    m_control_newest = number;
    m_control = control;
  }
  for (const OriginRecord& origin : records.origins) m_dictionary.define(number, origin);
  for (const TextRecord& text : records.texts) {
    std::uint32_t& newest = m_text_newest[text.id];
    if (!supersedes(number, newest)) continue;
    newest = number;
    m_texts[text.id] = text;
  }
  for (const SequenceRecord& sequence : records.sequences) {
    if (!m_dictionary.define(number, sequence)) ++m_overflows;
  }
  for (const ObjectRecord& object : records.objects) applyObject(number, object);
}

void Replica::applyObject(std::uint32_t number, const ObjectRecord& record) {
  auto found = m_entries.find(record.id);
  if (found == m_entries.end()) {
    if (m_entries.size() >= kMaxReplicaObjects) {
      ++m_overflows;
      return;
    }
    found = m_entries.emplace(record.id, ReplicaObject{}).first;
  }
  ReplicaObject& entry = found->second;
  const bool fresh = supersedes(number, entry.newest[kLifeIndex]);
  if (record.groups == kDeath) {
    if (fresh) end(entry, number);
    return;
  }
  if ((record.groups & kLife) != 0 && fresh && !(entry.alive && entry.generation == record.generation)) {
    end(entry, entry.newest[kLifeIndex]);
    entry.alive = true;
    entry.generation = record.generation;
    entry.state.order = record.state.order;
    ++m_alive;
  }
  if (!entry.alive) return;  // an object that is not born yet, or dead

  for (int i = 0; i < kGroupCount; ++i) {
    const int group = 1 << i;
    if ((record.groups & group) == 0 || !supersedes(number, entry.newest[i])) continue;
    entry.newest[i] = number;
    if (group == kMotion) entry.state.motion = record.state.motion;
    if (group == kLook) setLook(entry, record.state.look);
    if (group == kBody) entry.state.body = record.state.body;
  }
}

// Marks the object as dead since snapshot `number`.
void Replica::end(ReplicaObject& entry, std::uint32_t number) {
  m_alive -= entry.alive ? 1 : 0;
  release(entry.state.look.sequence);
  entry.alive = false;
  entry.state = {};
  entry.newest.fill(number);
}

void Replica::setLook(ReplicaObject& entry, const Look& look) {
  if (!look.sequence.isSharedWith(entry.state.look.sequence)) {
    const Sequence before = entry.state.look.sequence;
    if (!look.sequence.empty() && ++m_uses[look.sequence.identity()] == 1) m_glyphs += look.sequence.weight();
    release(before);
    if (m_glyphs > kMaxReplicaGlyphs) {
      release(look.sequence);
      if (!before.empty() && ++m_uses[before.identity()] == 1) m_glyphs += before.weight();
      ++m_overflows;
      return;
    }
  }
  entry.state.look = look;
}

void Replica::release(const Sequence& sequence) {
  const auto found = m_uses.find(sequence.identity());
  if (found == m_uses.end() || --found->second > 0) return;
  m_glyphs -= sequence.weight();
  m_uses.erase(found);
}

const Replica::ReplicaObject* Replica::find(std::uint32_t id) const {
  const auto found = m_entries.find(id);
  return found != m_entries.end() && found->second.alive ? &found->second : nullptr;
}

const ObjectState* Replica::followed() const {
  const ReplicaObject* entry = m_view.follows ? find(m_view.id) : nullptr;
  return entry != nullptr && entry->generation == m_view.generation ? &entry->state : nullptr;
}

ViewFrame Replica::viewFrame(std::uint32_t tick) const {
  const ObjectState* object = followed();
  ViewFrame frame = frameOf(m_world, m_view.corner);
  frame.corner = viewCornerAt(frame, m_view_tick, object != nullptr ? &object->motion : nullptr, tick);
  return frame;
}

CellPosition Replica::viewCorner(std::uint32_t tick, const Placement* p_placement) const {
  df::FixedVector corner = viewFrame(tick).corner;
  if (p_placement != nullptr) corner = p_placement->viewCorner(corner);
  return {df::cellOf(corner.x), df::cellOf(corner.y)};
}

CellPosition Replica::focus(std::uint32_t tick, const Placement* p_placement) const {
  const ObjectState* object = followed();
  if (object == nullptr) return {viewWidth() / 2, viewHeight() / 2};
  const CellPosition corner = viewCorner(tick, p_placement);
  const df::FixedVector at = placed(*object, tick, p_placement);
  const auto inView = [](std::int32_t cell, std::int32_t low, int extent) {
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(std::int64_t{cell} - low, 0, extent - 1));
  };
  return {inView(df::cellOf(at.x), corner.x, viewWidth()), inView(df::cellOf(at.y), corner.y, viewHeight())};
}

std::optional<CellPosition> Replica::ownCell(std::uint32_t tick, const Placement* p_placement) const {
  const ReplicaObject* p_entry = m_control.generation != 0 ? find(m_control.slot) : nullptr;
  if (p_entry == nullptr || p_entry->generation != m_control.generation) return std::nullopt;
  const CellPosition corner = viewCorner(tick, p_placement);
  const df::FixedVector at = placed(p_entry->state, tick, p_placement);
  const std::int64_t x = std::int64_t{df::cellOf(at.x)} - corner.x;
  const std::int64_t y = std::int64_t{df::cellOf(at.y)} - corner.y;
  if (x < 0 || y < 0 || x >= viewWidth() || y >= viewHeight()) return std::nullopt;
  return CellPosition{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
}

df::Canvas Replica::render(std::uint32_t tick, const Placement* p_placement) const {
  df::Canvas canvas(viewWidth(), viewHeight());
  const CellPosition corner = viewCorner(tick, p_placement);
  std::vector<Shown> shown;
  std::vector<DrawingOrder> order;
  for (const auto& [id, entry] : m_entries) {
    const Look& look = entry.state.look;
    const Appearance* p_glyphs = entry.alive ? look.select(tick) : nullptr;
    if (p_glyphs == nullptr) continue;
    const df::FixedVector at = placed(entry.state, tick, p_placement);
    const CellPosition from = entry.state.body.on_view ? CellPosition{} : corner;
    if (!reaches(look.sequence, at, from, canvas)) continue;
    order.push_back({look.altitude, entry.state.order, static_cast<std::uint32_t>(shown.size())});
    shown.push_back({at, from, p_glyphs});
  }
  if (order.size() > kMaxDrawnObjects) keepTopmost(order);
  std::sort(order.begin(), order.end());
  std::size_t first = order.size();
  for (std::size_t glyphs = 0; first > 0; --first) {
    glyphs += shown[order[first - 1].index].p_glyphs->size();
    if (glyphs > kMaxDrawnGlyphs) break;
  }
  for (std::size_t i = first; i < order.size(); ++i) draw(canvas, shown[order[i].index]);
  for (const auto& [id, text] : m_texts) {
    int x = text.x;
    for (const char32_t ch : df::decodeUtf8(text.text)) canvas.put(x++, text.y, {ch, text.color});
  }
  return canvas;
}

std::uint64_t Replica::checksum() const {
  std::uint64_t sum = 0;
  for (const auto& [id, entry] : m_entries) {
    if (!entry.alive) continue;
    sum += lifeSum(id, entry.generation, entry.state.order) + motionSum(id, entry.state.motion) +
           lookSum(id, entry.state.look) + bodySum(id, entry.state.body);
  }
  return sum;
}

}  // namespace naiad
