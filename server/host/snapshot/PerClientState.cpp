#include "host/snapshot/PerClientState.h"

#include <bit>
#include <utility>

#include "shared/replica/Acks.h"
#include "shared/replica/Motion.h"
#include "shared/replica/PredictedObject.h"
#include "shared/replica/ViewFollow.h"

namespace naiad {

namespace {

/// Minimum number of cells by which a window exceeds the view.
constexpr std::int64_t kMargin = 8;
/// A new window is sent when creation orders are this far from its order, because they take too many bits.
constexpr std::uint64_t kFarOrder = 1 << 14;

bool covers(std::int32_t from, std::int32_t bits, std::int32_t low, std::int32_t extent) {
  return low >= from && std::int64_t{low} + extent <= std::int64_t{from} + (std::int64_t{1} << bits);
}

std::int32_t bitsFor(std::int32_t extent) {
  return static_cast<std::int32_t>(std::bit_width(static_cast<std::uint32_t>(extent + kMargin - 1)));
}

/// Returns the client's id of the object if its state is kBorn or kAlive; otherwise kNone.
std::uint32_t idOf(df::ObjectKey object, const KnownObjects& known) {
  const std::uint32_t id = object.generation != 0 ? known.find(object.slot) : KnownObjects::kNone;
  const bool same = id != KnownObjects::kNone && known.at(id).generation == object.generation;
  return same ? id : KnownObjects::kNone;
}

}  // namespace

std::uint32_t OriginChoice::updateWindow(CellPosition view_corner, const WorldRecord& world,
                                         std::uint64_t newest_order) {
  const Origin& newest = m_origins[m_newest];
  if (m_newest != 0 && covers(newest.corner.x, newest.x_bits, view_corner.x, world.view_width) &&
      covers(newest.corner.y, newest.y_bits, view_corner.y, world.view_height) &&
      newest_order - newest.order < kFarOrder) {
    return 0;
  }
  // An unconfirmed slot may be set again, because no snapshot uses it yet.
  const bool pending = m_newest != m_slot;
  if (!pending) m_newest = m_newest % kOriginSlots + 1;
  Origin& origin = m_origins[m_newest];
  origin.x_bits = bitsFor(world.view_width);
  origin.y_bits = bitsFor(world.view_height);
  origin.corner.x = view_corner.x - ((1 << origin.x_bits) - world.view_width) / 2;
  origin.corner.y = view_corner.y - ((1 << origin.y_bits) - world.view_height) / 2;
  origin.order = newest_order;
  return m_newest;
}

void OriginChoice::confirmArrival(std::uint32_t slot) {
  if (slot == m_newest) m_slot = m_newest;
}

void ControlExtrapolator::setSent(const ControlRecord& record) {
  m_has_record = true;
  m_at_rest = false;
  m_coasted = 0;
  m_model = record;
}

bool ControlExtrapolator::implies(const ControlRecord& actual, const df::ControlTable& table) {
  if (!m_has_record) return false;
  for (; m_coasted < kMaxDeadReckoning && !m_at_rest && m_model.tick != actual.tick; ++m_coasted) {
    PredictedObject copy(m_model, table);
    copy.beginTick();
    copy.finishTick();
    ControlRecord next = copy.now();
    m_model.tick = next.tick;
    m_at_rest = next == m_model;
    m_model = next;
  }
  m_model.tick = actual.tick;
  return m_model == actual;
}

// ---- pending parts ----------------------------------------------------------------------------------------

void PerClientState::applyTick(const Publisher& publisher, const df::PlayerFacts& player) {
  applyPlayer(player);
  if (m_world != publisher.world() || (m_states[kWorld].sent == 0 && !isPending(kWorld))) {
    m_world = publisher.world();
    markPending(kWorld);
  }
  applyOrigin(publisher);
}

// Copies strings and tables only when they change.
void PerClientState::applyPlayer(const df::PlayerFacts& player) {
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
    applyTable();
  }
  if (player.texts != m_player.texts) {
    m_player.texts = player.texts;
    applyTexts(player.texts);
  }
}

void PerClientState::applyTexts(const std::vector<df::PlayerText>& now) {
  std::array<df::PlayerText, kMaxTexts> texts;
  for (const df::PlayerText& text : now) {
    if (text.id < kMaxTexts) texts[text.id] = text;
  }
  for (std::uint32_t i = 0; i < kMaxTexts; ++i) {
    texts[i].id = i;
    const bool silent = texts[i].text.empty() && m_texts[i].text.empty();
    if (silent || texts[i] == m_texts[i]) continue;
    m_texts[i] = texts[i];
    markPending(kTexts + i);
  }
}

// A client that never had controls needs no empty table.
void PerClientState::applyTable() {
  const df::ControlTable* p_table = m_player.steering.p_table.get();
  std::string bytes;
  writeControlTable(bytes, p_table != nullptr ? *p_table : df::ControlTable{});
  if (bytes == m_table) return;
  m_table = bytes;
  markPending(kTable);
  markPending(kControl);
}

void PerClientState::applyOrigin(const Publisher& publisher) {
  const CellPosition corner{df::cellOf(m_player.view_corner.x), df::cellOf(m_player.view_corner.y)};
  const std::uint32_t slot = m_origins.updateWindow(corner, publisher.world(), publisher.newestOrder());
  if (slot == 0) return;
  m_states[kOrigins + slot - 1] = {};
  markPending(kOrigins + slot - 1);
}

void PerClientState::setNewestInput(std::uint32_t id, std::uint32_t tick) {
  if (id == m_input) return;
  m_input = id;
  m_input_tick = tick;
  m_states[kInput] = {};
  markPending(kInput);
}

void PerClientState::queueCorrections(const Publisher& publisher, const KnownObjects& known) {
  queueView(publisher, known);
  queueControl(publisher.tick(), known);
}

// Returns null if the client does not know the followed object.
const Motion* PerClientState::followedMotion(const Publisher& publisher, const KnownObjects& known) const {
  if (idOf(m_player.followed, known) == KnownObjects::kNone) return nullptr;
  return &publisher.find(m_player.followed.slot)->state.motion;
}

// Clients compute the view from the object that it follows. A view is sent when this would show wrong cells.
void PerClientState::queueView(const Publisher& publisher, const KnownObjects& known) {
  const Motion* motion = followedMotion(publisher, known);
  ViewRecord actual{m_player.view_corner, motion != nullptr, 0, 0};
  const std::uint32_t id = actual.follows ? known.find(m_player.followed.slot) : 0;
  if (actual.follows) {
    actual.id = id;
    actual.generation = KnownObjects::generationOf(known.at(id));
  }
  bool correct = m_states[kView].sent != 0 && actual.follows == m_view.follows && actual.id == m_view.id &&
                 actual.generation == m_view.generation;
  if (correct && motion != nullptr && motion->tick != publisher.tick()) {
    // A pending motion is sent with a new base tick; a view that follows it from there may show other cells.
    correct = (known.at(id).pending & kMotion) == 0;
  }
  if (correct) {
    const ViewFrame frame{m_view.corner,
                          {df::fromCells(m_world.view_width), df::fromCells(m_world.view_height)},
                          m_world.boundary};
    correct = isSameCell(viewCornerAt(frame, m_view_tick, motion, publisher.tick()), actual.corner);
  }
  if (correct && !isPending(kView)) return;
  m_view = actual;
  m_view_tick = publisher.tick();
  markPending(kView);
}

ControlRecord PerClientState::currentControl(std::uint32_t tick, const KnownObjects& known) const {
  const df::SteeringFacts& facts = m_player.steering;
  ControlRecord now;
  now.tick = tick;
  now.newest_input = m_input;
  now.state = facts.state;
  const std::uint32_t id = idOf(facts.object, known);
  if (id == KnownObjects::kNone) return now;
  now.slot = id;
  now.generation = KnownObjects::generationOf(known.at(id));
  now.position = facts.position;
  now.velocity = facts.velocity;
  now.acceleration = facts.acceleration;
  return now;
}

// The state of the steered object is sent when the client could not have computed it.
void PerClientState::queueControl(std::uint32_t tick, const KnownObjects& known) {
  const df::ControlTable* p_table = m_player.steering.p_table.get();
  if (p_table == nullptr) {
    m_pending &= ~(1u << kControl);
    return;
  }
  m_control = currentControl(tick, known);
  if (!m_control_extrapolator.implies(m_control, *p_table)) markPending(kControl);
}

// ---- sending ----------------------------------------------------------------------------------------------

void PerClientState::writeInput(SnapshotHeader& header) const {
  const State& input = m_states[kInput];
  if (!isPending(kInput) && (input.sent == 0 || input.arrived)) return;
  header.has_input = true;
  header.input = m_input;
  header.input_tick = m_input_tick;
}

bool PerClientState::write(SnapshotWriter& writer, std::uint32_t number, std::size_t limit, bool repeats) {
  const std::uint32_t before = m_pending;
  if (isPending(kInput)) markSent(kInput, number, repeats);  // writeInput() has put it into the header
  for (std::uint32_t left = m_pending; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(left));
    const std::size_t max_bits = i == kTable ? 8 * m_table.size() + 16 : kMaxBits;
    if (!writer.hasSpace(max_bits, 0, limit)) continue;
    write(i, writer);
    markSent(i, number, repeats);
  }
  return m_pending != before;
}

void PerClientState::write(std::size_t part, SnapshotWriter& writer) {
  if (part == kWorld) writer.write(m_world);
  if (part == kView) writer.write(m_view);
  if (part == kTable) writer.writeTable(m_table);
  if (part == kControl) {
    writer.write(m_control);
    m_control_extrapolator.setSent(m_control);
  }
  if (part >= kOrigins && part < kTexts) {
    const auto slot = static_cast<std::uint32_t>(part - kOrigins + 1);
    writer.write(OriginRecord{slot, m_origins.at(slot)});
  }
  if (part >= kTexts) {
    const df::PlayerText& text = m_texts[part - kTexts];
    writer.write(TextRecord{text.id, text.x, text.y, text.color, text.text});
  }
}

void PerClientState::markSent(std::size_t part, std::uint32_t number, bool repeats) {
  m_pending &= ~(1u << part);
  m_states[part] = {number, false};
  const bool small = part == kView || part == kControl || part >= kTexts;
  const bool again = (m_repeated & (1u << part)) != 0;
  if (repeats && small && !again) m_to_repeat |= 1u << part;
}

void PerClientState::queueRepeats() {
  m_repeated = 0;
  for (std::uint32_t left = std::exchange(m_to_repeat, 0) & ~m_pending; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(left));
    if (m_states[i].arrived) continue;
    m_repeated |= 1u << i;
    markPending(i);
  }
}

void PerClientState::confirmArrival(std::uint32_t number, bool probe) {
  // Every snapshot since the input was first sent has it in its header, until one is known to have arrived.
  State& input = m_states[kInput];
  if (!probe && input.sent != 0 && !isNewer(input.sent, number)) input.arrived = true;
  for (std::size_t i = 0; i < kCount; ++i) {
    if (m_states[i].sent != number || isPending(i)) continue;
    m_states[i].arrived = true;
    if (i >= kOrigins && i < kTexts) m_origins.confirmArrival(static_cast<std::uint32_t>(i - kOrigins + 1));
  }
}

bool PerClientState::requeueLost(std::uint32_t number) {
  bool missing = false;
  for (std::size_t i = 0; i < kCount; ++i) {
    if (m_states[i].sent != number || isPending(i)) continue;
    markPending(i);
    missing = true;
  }
  return missing;
}

}  // namespace naiad
