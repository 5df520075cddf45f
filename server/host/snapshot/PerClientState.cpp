#include "host/snapshot/PerClientState.h"

#include <utility>

#include "shared/replica/Acks.h"
#include "shared/replica/ViewFollow.h"

namespace naiad {

namespace {

bool sameCell(df::FixedVector a, df::FixedVector b) {
  return df::cellOf(a.x) == df::cellOf(b.x) && df::cellOf(a.y) == df::cellOf(b.y);
}

/// The id under which the client was told of the object, or is about to be; kNobody if it is not.
std::uint32_t idOf(df::ObjectKey object, const KnownObjects& known) {
  const std::uint32_t id = object.generation != 0 ? known.find(object.slot) : KnownObjects::kNobody;
  const bool same = id != KnownObjects::kNobody && known.at(id).generation == object.generation;
  return same ? id : KnownObjects::kNobody;
}

}  // namespace

// ---- what there is to tell --------------------------------------------------------------------------------

void PerClientState::note(const Publisher& publisher, const df::PlayerFacts& player) {
  notePlayer(player);
  if (m_world != publisher.world() || (m_states[kWorld].sent == 0 && !isOwed(kWorld))) {
    m_world = publisher.world();
    owe(kWorld);
  }
  noteOrigin(publisher);
}

// Strings and tables are copied only when they change.
void PerClientState::notePlayer(const df::PlayerFacts& player) {
  m_player.id = player.id;
  m_player.followed = player.followed;
  m_player.view_corner = player.view_corner;
  const df::SteeringFacts& steering = player.steering;
  m_player.steering.object = steering.object;
  m_player.steering.state = steering.state;
  m_player.steering.position = steering.position;
  m_player.steering.velocity = steering.velocity;
  m_player.steering.acceleration = steering.acceleration;
  if (steering.p_table != m_player.steering.p_table) {
    m_player.steering.p_table = steering.p_table;
    noteTable();
  }
  if (player.texts != m_player.texts) {
    m_player.texts = player.texts;
    noteTexts(player.texts);
  }
}

void PerClientState::noteTexts(const std::vector<df::PlayerText>& now) {
  std::array<df::PlayerText, kMaxTexts> texts;
  for (const df::PlayerText& text : now) {
    if (text.id < kMaxTexts) texts[text.id] = text;
  }
  for (std::uint32_t i = 0; i < kMaxTexts; ++i) {
    texts[i].id = i;
    const bool silent = texts[i].text.empty() && m_texts[i].text.empty();
    if (silent || texts[i] == m_texts[i]) continue;
    m_texts[i] = texts[i];
    owe(kTexts + i);
  }
}

// One who never had controls need not be told of none.
void PerClientState::noteTable() {
  const df::ControlTable* p_table = m_player.steering.p_table.get();
  std::string bytes;
  writeControlTable(bytes, p_table != nullptr ? *p_table : df::ControlTable{});
  if (bytes == m_table) return;
  m_table = bytes;
  owe(kTable);
  owe(kControl);
}

void PerClientState::noteOrigin(const Publisher& publisher) {
  const CellPosition corner{df::cellOf(m_player.view_corner.x), df::cellOf(m_player.view_corner.y)};
  const std::uint32_t slot = m_origins.note(corner, publisher.world(), publisher.newestOrder());
  if (slot == 0) return;
  m_states[kOrigins + slot - 1] = {};
  owe(kOrigins + slot - 1);
}

void PerClientState::noteInput(std::uint32_t id, std::uint32_t tick) {
  if (id == m_input) return;
  m_input = id;
  m_input_tick = tick;
  m_states[kInput] = {};
  owe(kInput);
}

void PerClientState::check(const Publisher& publisher, const KnownObjects& known) {
  checkView(publisher, known);
  checkControl(publisher.tick(), known);
}

// The followed object's model, if the client was told of the object.
const Motion* PerClientState::followedMotion(const Publisher& publisher, const KnownObjects& known) const {
  if (idOf(m_player.followed, known) == KnownObjects::kNobody) return nullptr;
  return &publisher.find(m_player.followed.slot)->state.motion;
}

// The view is a model too: it is sent where following the published object would show the wrong cells.
void PerClientState::checkView(const Publisher& publisher, const KnownObjects& known) {
  const Motion* motion = followedMotion(publisher, known);
  ViewRecord truth{m_player.view_corner, motion != nullptr, 0, 0};
  const std::uint32_t id = truth.follows ? known.find(m_player.followed.slot) : 0;
  if (truth.follows) {
    truth.id = id;
    truth.generation = KnownObjects::generationOf(known.at(id));
  }
  bool right = m_states[kView].sent != 0 && truth.follows == m_view.follows && truth.id == m_view.id &&
               truth.generation == m_view.generation;
  if (right && motion != nullptr && motion->tick != publisher.tick()) {
    // A motion that is sent late gets a new base, and following it from there may lead elsewhere.
    right = (known.at(id).owed & kMotion) == 0;
  }
  if (right) {
    const ViewFrame frame{m_view.corner,
                          {df::fromCells(m_world.view_width), df::fromCells(m_world.view_height)},
                          m_world.boundary};
    right = sameCell(viewCornerAt(frame, m_view_tick, motion, publisher.tick()), truth.corner);
  }
  if (right && !isOwed(kView)) return;
  m_view = truth;
  m_view_tick = publisher.tick();
  owe(kView);
}

ControlRecord PerClientState::controlNow(std::uint32_t tick, const KnownObjects& known) const {
  const df::SteeringFacts& facts = m_player.steering;
  ControlRecord now;
  now.tick = tick;
  now.newest_input = m_input;
  now.state = facts.state;
  const std::uint32_t id = idOf(facts.object, known);
  if (id == KnownObjects::kNobody) return now;
  now.slot = id;
  now.generation = KnownObjects::generationOf(known.at(id));
  now.position = facts.position;
  now.velocity = facts.velocity;
  now.acceleration = facts.acceleration;
  return now;
}

// What is steered is sent where the client could not have worked it out.
void PerClientState::checkControl(std::uint32_t tick, const KnownObjects& known) {
  const df::ControlTable* p_table = m_player.steering.p_table.get();
  if (p_table == nullptr) {
    m_owed &= ~(1u << kControl);
    return;
  }
  m_control = controlNow(tick, known);
  if (!m_acked_control.implies(m_control, *p_table)) owe(kControl);
}

// ---- telling it -------------------------------------------------------------------------------------------

void PerClientState::tellInput(SnapshotHeader& header) const {
  const State& input = m_states[kInput];
  if (!isOwed(kInput) && (input.sent == 0 || input.arrived)) return;
  header.tells_input = true;
  header.input = m_input;
  header.input_tick = m_input_tick;
}

bool PerClientState::write(SnapshotWriter& writer, std::uint32_t number, std::size_t limit, bool repeats) {
  const std::uint32_t before = m_owed;
  if (isOwed(kInput)) pay(kInput, number, repeats);  // the header names it
  for (std::uint32_t left = m_owed; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(left));
    const std::size_t most = i == kTable ? 8 * m_table.size() + 16 : kMaxBits;
    if (!writer.hasRoom(most, 0, limit)) continue;
    write(i, writer);
    pay(i, number, repeats);
  }
  return m_owed != before;
}

void PerClientState::write(std::size_t single, SnapshotWriter& writer) {
  if (single == kWorld) writer.write(m_world);
  if (single == kView) writer.write(m_view);
  if (single == kTable) writer.writeTable(m_table);
  if (single == kControl) {
    writer.write(m_control);
    m_acked_control.tell(m_control);
  }
  if (single >= kOrigins && single < kTexts) {
    const auto slot = static_cast<std::uint32_t>(single - kOrigins + 1);
    writer.write(OriginRecord{slot, m_origins.at(slot)});
  }
  if (single >= kTexts) {
    const df::PlayerText& text = m_texts[single - kTexts];
    writer.write(TextRecord{text.id, text.x, text.y, text.color, text.text});
  }
}

void PerClientState::pay(std::size_t single, std::uint32_t number, bool repeats) {
  m_owed &= ~(1u << single);
  m_states[single] = {number, false};
  const bool small = single == kView || single == kControl || single >= kTexts;
  const bool again = (m_repeated & (1u << single)) != 0;
  if (repeats && small && !again) m_ahead |= 1u << single;
}

void PerClientState::repeatAhead() {
  m_repeated = 0;
  for (std::uint32_t left = std::exchange(m_ahead, 0) & ~m_owed; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(left));
    if (m_states[i].arrived) continue;
    m_repeated |= 1u << i;
    owe(i);
  }
}

void PerClientState::arrived(std::uint32_t number, bool probe) {
  // All snapshots since it was paid tell the input, until one is known to have arrived.
  State& input = m_states[kInput];
  if (!probe && input.sent != 0 && !isNewer(input.sent, number)) input.arrived = true;
  for (std::size_t i = 0; i < kCount; ++i) {
    if (m_states[i].sent != number || isOwed(i)) continue;
    m_states[i].arrived = true;
    if (i >= kOrigins && i < kTexts) m_origins.arrived(static_cast<std::uint32_t>(i - kOrigins + 1));
  }
}

bool PerClientState::lost(std::uint32_t number) {
  bool missing = false;
  for (std::size_t i = 0; i < kCount; ++i) {
    if (m_states[i].sent != number || isOwed(i)) continue;
    owe(i);
    missing = true;
  }
  return missing;
}

}  // namespace naiad
