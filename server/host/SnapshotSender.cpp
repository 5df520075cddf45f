#include "SnapshotSender.h"

#include <algorithm>

#include "ViewFollow.h"

namespace naiad {

namespace {

constexpr int kLifeIndex = 0;
constexpr std::uint8_t kDeath = 0;

bool sameCell(df::FixedVector a, df::FixedVector b) {
  return df::cellOf(a.x) == df::cellOf(b.x) && df::cellOf(a.y) == df::cellOf(b.y);
}

}  // namespace

SnapshotSender::Slot& SnapshotSender::slotAt(std::uint32_t slot) {
  if (slot == kLooseSlot) return m_loose;
  if (slot >= m_slots.size()) m_slots.resize(std::size_t{slot} + 1);
  return m_slots[slot];
}

// The debts that are not objects, by number: the world, the view, then the texts.
constexpr std::size_t kSingles = 2 + kMaxTexts;

SnapshotSender::Single& SnapshotSender::single(std::size_t i) {
  return i == 0 ? m_world_debt : i == 1 ? m_view_debt : m_text_debt[i - 2];
}

bool SnapshotSender::carriesSingle(std::uint32_t number) const {
  return m_world_debt.sent == number || m_view_debt.sent == number ||
         std::any_of(m_text_debt.begin(), m_text_debt.end(),
                     [number](const Single& text) { return text.sent == number; });
}

void SnapshotSender::owe(std::uint32_t index, std::uint8_t groups) {
  Slot& slot = slotAt(index);
  slot.owed |= groups;
  if (slot.queued || slot.owed == 0) return;
  slot.queued = true;
  m_queue.push_back(index);
}

// Bring a slot's life in line with the published one: what is owed follows from what the client knows.
void SnapshotSender::follow(std::uint32_t index, const Publisher::Model* model, std::uint8_t groups) {
  Slot& slot = slotAt(index);
  const bool same = model != nullptr && model->generation == slot.generation;
  switch (slot.life) {
    case Life::kUnknown:
      if (model == nullptr) break;
      slot = {model->generation, Life::kBorn, 0, slot.queued, {}};
      owe(index, kAllGroups);
      break;
    case Life::kBorn:
    case Life::kAlive:
      if (same) {
        owe(index, groups);
      } else if (slot.life == Life::kBorn && slot.sent[kLifeIndex] == 0) {
        slot.life = Life::kUnknown;  // the client never heard of it
        slot.owed = 0;
        follow(index, model, groups);
      } else {
        slot.life = Life::kDying;
        slot.owed = kLife;
        owe(index, kLife);
      }
      break;
    case Life::kDying:
      break;  // the next object waits until the death is acknowledged
  }
}

void SnapshotSender::note(const Publisher& publisher) {
  if (!m_began) {
    m_began = true;
    m_last_tick = publisher.tick() - kKeepAlive;
    publisher.forEach(
        [this](std::uint32_t slot, const Publisher::Model& model) { follow(slot, &model, kAllGroups); });
  } else {
    for (const Publisher::Change& change : publisher.changes()) {
      follow(change.slot, publisher.find(change.slot), change.groups);
    }
  }
  if (m_world != publisher.world() || (m_world_debt.sent == 0 && !m_world_debt.owed)) {
    m_world = publisher.world();
    m_world_debt.owed = true;
  }
}

void SnapshotSender::setPlayer(const df::PlayerFacts& player) {
  std::array<df::PlayerText, kMaxTexts> texts;
  for (const df::PlayerText& text : player.texts) {
    if (text.id < kMaxTexts) texts[text.id] = text;
  }
  for (std::uint32_t i = 0; i < kMaxTexts; ++i) {
    texts[i].id = i;
    const bool silent = texts[i].text.empty() && m_texts[i].text.empty();
    if (silent || texts[i] == m_texts[i]) continue;
    m_texts[i] = texts[i];
    m_text_debt[i].owed = true;
  }
  m_player = player;
}

// The followed object's model, if the client was told of the object.
const Motion* SnapshotSender::followedMotion(const Publisher& publisher) {
  const df::ObjectKey followed = m_player.followed;
  if (followed.generation == 0 || slotAt(followed.slot).generation != followed.generation) return nullptr;
  const Publisher::Model* model = publisher.find(followed.slot);
  return model != nullptr && model->generation == followed.generation ? &model->state.motion : nullptr;
}

// The view is a model too: it is sent where following the published object would show the wrong cells.
void SnapshotSender::checkView(const Publisher& publisher) {
  const df::ObjectKey followed = m_player.followed;
  const ViewRecord truth{m_player.view_corner, followed.generation != 0 ? followed.slot : 0,
                         followed.generation};
  bool right = m_view_debt.sent != 0 && truth.slot == m_view.slot && truth.generation == m_view.generation;
  const Motion* motion = followedMotion(publisher);
  if (right && motion != nullptr && motion->tick != publisher.tick()) {
    // A motion that is sent late gets a new base, and following it from there may lead elsewhere.
    const Slot& slot = slotAt(truth.slot);
    right = slot.life == Life::kBorn ? slot.owed == 0 : (slot.owed & kMotion) == 0;
  }
  if (right) {
    const ViewFrame frame{m_view.corner,
                          {df::fromCells(m_world.view_width), df::fromCells(m_world.view_height)},
                          m_world.boundary};
    right = sameCell(viewCornerAt(frame, m_view_tick, motion, publisher.tick()), truth.corner);
  }
  if (right && !m_view_debt.owed) return;
  m_view = truth;
  m_view_tick = publisher.tick();
  m_view_debt.owed = true;
}

bool SnapshotSender::isOwing() const {
  return !m_queue.empty() || m_world_debt.owed || m_view_debt.owed ||
         std::any_of(m_text_debt.begin(), m_text_debt.end(), [](const Single& text) { return text.owed; });
}

std::vector<SnapshotSender::Snapshot> SnapshotSender::build(const Publisher& publisher, std::size_t most) {
  for (const std::uint32_t slot : m_freed) follow(slot, publisher.find(slot), kAllGroups);
  m_freed.clear();
  checkView(publisher);
  const bool due =
      static_cast<std::int32_t>(publisher.tick() - m_last_tick) >= static_cast<std::int32_t>(kKeepAlive);
  // With the window full only the keep-alive goes out, lest what is still under way be taken for lost.
  const std::size_t window = m_flight.size() < kMaxInFlight ? kMaxInFlight - m_flight.size() : due ? 1 : 0;
  most = std::min(most, window);

  std::vector<Snapshot> snapshots;
  RecordWriter out;
  while (snapshots.size() < most && (isOwing() || (due && snapshots.empty()))) {
    m_flight.push_back({m_next_number, {}});
    out.clear();
    bool room = paySingles(publisher, out);
    while (room && !m_queue.empty()) {
      room = payObject(m_queue.front(), publisher, out);
      if (room) m_queue.pop_front();
    }
    snapshots.push_back({m_next_number, publisher.tick(), out.bytes()});
    if (++m_next_number == 0) m_next_number = 1;
    if (m_flight.size() > kMaxInFlight) {
      const InFlight oldest = std::move(m_flight.front());
      m_flight.pop_front();
      lost(oldest);
    }
  }
  m_throttled = isOwing();
  if (!snapshots.empty()) m_last_tick = publisher.tick();
  return snapshots;
}

// A snapshot takes at least one record, whatever its size: looks are bounded so that any birth fits.
bool SnapshotSender::hasRoom(const RecordWriter& out, const RecordWriter& more) const {
  return out.size() == 0 || out.size() + more.size() <= m_record_limit;
}

// Write the owed records that are no objects. False if the snapshot has no room left.
bool SnapshotSender::paySingles(const Publisher& publisher, RecordWriter& out) {
  for (std::size_t i = 0; i < kSingles; ++i) {
    if (!single(i).owed) continue;
    RecordWriter record;
    if (i == 0) record.write(publisher.world());
    if (i == 1) record.write(m_view);
    if (i >= 2) {
      const df::PlayerText& text = m_texts[i - 2];
      record.write(TextRecord{text.id, text.x, text.y, text.color, text.text});
    }
    if (!hasRoom(out, record)) return false;
    out.append(record);
    single(i) = {false, m_next_number};
  }
  return true;
}

// Write the records that an object owes. False if the snapshot has no room left for them.
bool SnapshotSender::payObject(std::uint32_t index, const Publisher& publisher, RecordWriter& out) {
  Slot& slot = slotAt(index);
  if (slot.owed != 0) {
    ObjectRecord record{index, slot.generation, kDeath, {}};
    if (slot.life != Life::kDying) {
      record.groups = slot.life == Life::kBorn ? kAllGroups : slot.owed;
      record.state = publisher.find(index)->state;
      record.state.motion = rebase(record.state.motion, publisher.tick());
    }
    RecordWriter bytes;
    bytes.write(record);
    if (!hasRoom(out, bytes)) return false;
    out.append(bytes);
    m_flight.back().objects.push_back({index, slot.generation, record.groups});
    const int carried = record.groups == kDeath ? +kLife : +record.groups;
    for (int i = 0; i < kGroupCount; ++i) {
      if ((carried & (1 << i)) != 0) slot.sent[i] = m_next_number;
    }
  }
  slot.owed = 0;
  slot.queued = false;
  return true;
}

void SnapshotSender::acknowledge(const AckWindow& acks) {
  // A number that was never sent is a lie; believing it would drop debts that are still open.
  if (isNewer(acks.newest, m_next_number - 1)) return;
  while (!m_flight.empty()) {
    const std::int32_t behind = static_cast<std::int32_t>(acks.newest - m_flight.front().number);
    const bool has = acks.has(m_flight.front().number);
    if (!has && behind < kReorder) break;
    const InFlight snapshot = std::move(m_flight.front());
    m_flight.pop_front();
    has ? arrived(snapshot) : lost(snapshot);
  }
  // Later ones may have arrived although an earlier one is still in doubt.
  for (auto it = m_flight.begin(); it != m_flight.end();) {
    if (!acks.has(it->number)) {
      ++it;
      continue;
    }
    const InFlight snapshot = std::move(*it);
    it = m_flight.erase(it);
    arrived(snapshot);
  }
}

void SnapshotSender::arrived(const InFlight& snapshot) {
  for (const SentObject& object : snapshot.objects) {
    Slot& slot = slotAt(object.slot);
    if (slot.generation != object.generation) continue;
    if (object.groups == kDeath) {
      if (slot.life != Life::kDying) continue;
      slot = {0, Life::kUnknown, 0, slot.queued, {}};
      m_freed.push_back(object.slot);
    } else if ((object.groups & kLife) != 0 && slot.life == Life::kBorn) {
      slot.life = Life::kAlive;
    }
  }
}

void SnapshotSender::lost(const InFlight& snapshot) {
  for (std::size_t i = 0; i < kSingles; ++i) {
    if (single(i).sent != snapshot.number) continue;
    single(i).owed = true;
    ++m_resent;
  }
  for (const SentObject& object : snapshot.objects) {
    Slot& slot = slotAt(object.slot);
    if (slot.generation != object.generation) continue;
    std::uint8_t missing = 0;
    if (object.groups == kDeath) {
      if (slot.life == Life::kDying && slot.sent[kLifeIndex] == snapshot.number) missing = kLife;
    } else if (slot.life != Life::kDying) {
      for (int i = 0; i < kGroupCount; ++i) {
        const bool carried = (object.groups & (1 << i)) != 0;
        if (carried && slot.sent[i] == snapshot.number) missing |= 1 << i;
      }
      missing &= slot.life == Life::kAlive ? ~kLife : 0xFF;
    }
    if (missing == 0) continue;
    ++m_resent;
    owe(object.slot, missing);
  }
}

bool SnapshotSender::isSettled() const {
  return m_freed.empty() && !isOwing() &&
         std::all_of(m_flight.begin(), m_flight.end(), [this](const InFlight& snapshot) {
           return snapshot.objects.empty() && !carriesSingle(snapshot.number);
         });
}

}  // namespace naiad
