#include "host/snapshot/Interest.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace naiad {

namespace {

/// Maximum number of ticks until a known object is examined again.
constexpr std::uint32_t kMaxTicks = 1u << 20;

bool isDue(std::uint32_t due, std::uint32_t tick) {
  return static_cast<std::int32_t>(due - tick) <= 0;
}

bool meets(const CellRect& a, const CellRect& b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

bool isInside(const CellRect& inner, const CellRect& outer) {
  return inner.left >= outer.left && inner.right <= outer.right && inner.top >= outer.top &&
         inner.bottom <= outer.bottom;
}

bool isSame(const CellRect& a, const CellRect& b) {
  return isInside(a, b) && isInside(b, a);
}

CellRect shared(const CellRect& a, const CellRect& b) {
  return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right),
          std::min(a.bottom, b.bottom)};
}

CellPosition cellAt(const Motion& motion, std::uint32_t tick) {
  const df::FixedVector at = positionAt(motion, tick);
  return {df::cellOf(at.x), df::cellOf(at.y)};
}

/// Returns a lower bound of the ticks that a coordinate stays in the cells low … high − 1; 0 if outside.
std::uint32_t staysFor(df::Fixed position, df::Fixed velocity, std::int64_t low, std::int64_t high) {
  const std::int64_t cell = df::cellOf(position);
  if (cell < low || cell >= high) return 0;
  if (velocity == 0) return kMaxTicks;
  const std::int64_t cells = velocity > 0 ? high - 1 - cell : cell - low;
  // One cell less, as a safety margin.
  if (cells <= 1 || velocity < -df::fromCells(1 << 20) || velocity > df::fromCells(1 << 20)) return 0;
  const std::uint64_t ticks = (static_cast<std::uint64_t>(cells - 1) << df::kFixedBits) /
                              static_cast<std::uint64_t>(std::abs(velocity));
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(ticks, kMaxTicks));
}

}  // namespace

bool Interest::isVisible(const Publisher::Model& model, std::uint32_t tick, std::uint32_t look_ahead,
                         const CellRect& window) {
  if (model.reach > Publisher::Model::kWide) return true;
  const CellRect rect = window.grownBy(model.reach);
  const CellPosition now = cellAt(model.state.motion, tick);
  if (rect.contains(now)) return true;
  if (!isMoving(model.state.motion)) return false;
  const CellPosition then = cellAt(model.state.motion, tick + look_ahead);
  return meets(rect, {std::min(now.x, then.x), std::min(now.y, then.y),
                      std::int64_t{std::max(now.x, then.x)} + 1, std::int64_t{std::max(now.y, then.y)} + 1});
}

void Interest::update(const Publisher& publisher, const Focus& focus, KnownObjects& known) {
  m_p_publisher = &publisher;
  m_p_known = &known;
  m_tick = publisher.tick();
  m_focus = focus;
  m_window = CompactRect(focus.window);
  processChanges();
  checkCandidates();
  if (isSearchDue()) searchView();
  for (const df::ObjectKey own : focus.own) {
    const Publisher::Model* model = own.generation != 0 ? publisher.find(own.slot) : nullptr;
    if (model == nullptr || model->generation != own.generation) continue;
    if (!isKnown(own.slot)) addObject(own.slot, own.generation);
  }
  m_last_window = focus.window;
}

void Interest::addObject(std::uint32_t slot, std::uint32_t generation) {
  const std::uint32_t id = m_p_known->addObject(slot, generation, m_tick);
  if (id == KnownObjects::kNone) return;
  if (id >= m_stays.size()) m_stays.resize(std::size_t{id} + 1);
  m_stays[id] = {m_tick, slot};
  m_known_bits.set(slot);
}

void Interest::removeObject(std::uint32_t id, std::uint32_t slot) {
  m_p_known->removeObject(id, m_tick);
  m_stays[id].slot = KnownObjects::kNone;
  if (bitsAreExact()) m_known_bits.clear(slot);
}

void Interest::processChanges() {
  thread_local ChangeIndex::Marks marks;
  markChanges(marks);
  Changes changes;
  std::size_t count = 0;
  ChangeIndex::forEachMarked(marks, [&](std::size_t i) {
    const Publisher::Change& change = m_p_publisher->changes()[i];
    m_p_known->prefetchSlot(change.slot);
    changes[count++] = &change;
    if (count == changes.size()) processChanges(changes, std::exchange(count, 0));
  });
  processChanges(changes, count);
}

// Prefetches for many changes at once, because this client's data about their objects is no longer cached.
// With 1,500 clients, waiting for each cache miss took 3.5 % of the server's time.
void Interest::processChanges(const Changes& changes, std::size_t count) {
  std::array<std::uint32_t, std::tuple_size_v<Changes>> ids;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t slot = changes[i]->slot;
    ids[i] = mayBeKnown(slot) ? m_p_known->find(slot) : KnownObjects::kNone;
    if (ids[i] != KnownObjects::kNone) m_p_known->prefetch(ids[i]);
  }
  for (std::size_t i = 0; i < count; ++i) processChange(*changes[i], ids[i]);
}

// Marks the changes of objects that may be known or may enter the view.
void Interest::markChanges(ChangeIndex::Marks& marks) const {
  const ChangeIndex& index = m_p_publisher->changeIndex();
  // The sweeps in the index, computed once for all clients, cover only kSweep ticks.
  const bool sweeps_suffice = kSearchInterval + m_focus.look_ahead <= Publisher::kSweep;
  index.markMeeting(sweeps_suffice ? CompactRect(m_covered) : CompactRect::everywhere(), marks);
  if (bitsAreExact()) return index.markShared(m_known_bits, marks);
  const std::vector<Publisher::Change>& changes = m_p_publisher->changes();
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (mayBeKnown(changes[i].slot)) marks[i] = 1;
  }
}

void Interest::processChange(const Publisher::Change& change, std::uint32_t id) {
  if (id == KnownObjects::kNone) {
    if (change.groups != 0) considerObject(change.slot);
    return;
  }
  const Publisher::Model* model = m_p_publisher->find(change.slot);
  if (model != nullptr && model->generation == m_p_known->at(id).generation) {
    m_p_known->addPending(id, change.groups, m_tick);
    if ((change.groups & (kMotion | kLook)) != 0) m_stays[id].until = m_tick;
    return;
  }
  removeObject(id, change.slot);
  if (model != nullptr) considerObject(change.slot);
}

// Adds an object unknown to the client if it is visible, or as a candidate if it may become visible.
void Interest::considerObject(std::uint32_t slot) {
  const Publisher::Forecast& forecast = this->forecast(slot);
  if (!forecast.later.meets(CompactRect(m_covered))) return;
  if (!forecast.soon.meets(m_window)) return m_candidates.push_back(slot);
  addObject(slot, forecast.generation);
}

void Interest::checkCandidates() {
  std::erase_if(m_candidates, [this](std::uint32_t slot) {
    const Publisher::Forecast& forecast = this->forecast(slot);
    if (!forecast.soon.meets(m_window)) return forecast.generation == 0;  // usual: not visible yet
    if (forecast.generation != 0 && !isKnown(slot)) addObject(slot, forecast.generation);
    return true;
  });
}

bool Interest::isSearchDue() const {
  return !m_has_searched || (m_tick + m_focus.stagger) % kSearchInterval == 0 ||
         !isInside(m_focus.window, m_covered);
}

void Interest::searchView() {
  const bool moved = m_has_searched && !isSame(m_focus.window, m_searched);
  const CellRect outer = m_focus.window.grownBy(kHysteresis);
  if (moved || !m_has_searched) {
    for (Stay& stay : m_stays) stay.until = m_tick;
  }
  m_has_searched = true;
  m_searched = m_focus.window;
  m_covered = m_focus.window.grownBy(moved ? kSearchMargin : 0);
  removeOutside(outer, moved);
  m_candidates.clear();
  const CompactRect covered(m_covered);
  m_p_publisher->forEachNear(m_covered, kSearchInterval + m_focus.look_ahead,
                             shared(m_last_window, m_focus.window), [this, &covered](std::uint32_t slot) {
                               if (isKnown(slot) || !forecast(slot).later.meets(covered)) return;
                               considerObject(slot);
                             });
}

// A view moved since the last search probably moves again, so the next search examines all known objects.
void Interest::removeOutside(const CellRect& outer, bool moves) {
  m_known_bits.clear();
  const CompactRect around(outer);
  for (std::uint32_t id = 0; id < m_stays.size(); ++id) {
    Stay& stay = m_stays[id];
    if (stay.slot == KnownObjects::kNone) continue;
    m_known_bits.set(stay.slot);
    if (!isDue(stay.until, m_tick)) continue;
    const bool own = isOwn(id, stay.slot);
    if (own || forecast(stay.slot).soon.meets(around)) {
      const bool again = own || moves;
      stay.until = m_tick + (again ? 0 : leavesAfter(*m_p_publisher->find(stay.slot), outer));
    } else {
      removeObject(id, stay.slot);
    }
  }
}

bool Interest::isOwn(std::uint32_t id, std::uint32_t slot) const {
  return std::any_of(m_focus.own.begin(), m_focus.own.end(), [&](const df::ObjectKey& own) {
    return own.slot == slot && own.generation == m_p_known->at(id).generation;
  });
}

std::uint32_t Interest::leavesAfter(const Publisher::Model& model, const CellRect& outer) const {
  if (model.reach > Publisher::Model::kWide) return kMaxTicks;
  const Motion& motion = model.state.motion;
  if (motion.acceleration != df::FixedVector{}) return 0;
  const CellRect rect = outer.grownBy(model.reach);
  const df::FixedVector at = positionAt(motion, m_tick);
  return std::min(staysFor(at.x, motion.velocity.x, rect.left, rect.right),
                  staysFor(at.y, motion.velocity.y, rect.top, rect.bottom));
}

}  // namespace naiad
