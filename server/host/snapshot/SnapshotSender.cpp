#include "host/snapshot/SnapshotSender.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace naiad {

namespace {

/// With less loss than this nothing is repeated ahead.
constexpr double kAheadLoss = 0.003;
/// A cell per tick counts as much as being so many cells nearer.
constexpr double kAheadPerSpeed = 20;
/// What a snapshot of one record takes beside it, at most.
constexpr std::size_t kMaxOverheadBits = 256;

}  // namespace

/// What is needed only while a snapshot is written: one for all senders of a thread, which write one after
/// the other, so that it stays in the cache.
struct SnapshotSender::Desk {
  SnapshotWriter writer;
  std::vector<std::uint32_t> queue;  ///< ids to be written, the most urgent last
  std::vector<std::uint32_t> later;  ///< those of them that are for the stream
  std::vector<std::pair<double, std::uint32_t>> ranked;
};

SnapshotSender::Desk& SnapshotSender::desk() {
  thread_local Desk desk;
  return desk;
}

// ---- whom the client knows --------------------------------------------------------------------------------

void SnapshotSender::note(const Publisher& publisher, const df::PlayerFacts& player) {
  m_tick = publisher.tick();
  m_per_client.note(publisher, player);
  if (!m_began) m_last_tick = m_tick - kKeepAlive;
  m_began = true;
  m_interest.update(publisher,
                    {m_shown.update(publisher, player, m_look_ahead),
                     {player.followed, player.steering.object},
                     m_look_ahead,
                     player.id},
                    m_known);
}

// Whom the view follows and whom the player steers are of interest wherever they are.
bool SnapshotSender::isOwn(const KnownObjects::Known& known) const {
  const df::ObjectKey key{known.slot, known.generation};
  return m_per_client.player().followed == key || m_per_client.player().steering.object == key;
}

// ---- building ---------------------------------------------------------------------------------------------

// Deaths first, for they are short and hide ghosts; then what the player looks at, what is near and what has
// waited long.
double SnapshotSender::urgency(std::uint32_t id, const Publisher& publisher) const {
  const KnownObjects::Known& known = m_known.at(id);
  if (known.life == KnownObjects::Life::kDying) return 1e6;
  if (isOwn(known)) return 1e5;
  if (publisher.find(known.slot)->state.body.on_view) return 8.0 * (m_tick - known.since);
  const df::FixedVector at = positionAt(publisher.find(known.slot)->state.motion, m_tick);
  const WorldRecord& world = m_per_client.world();
  const df::FixedVector corner = m_per_client.player().view_corner;
  const df::FixedVector focus{corner.x + df::fromCells(world.view_width) / 2,
                              corner.y + df::fromCells(world.view_height) / 2};
  const double dx = df::toCells(at.x) - df::toCells(focus.x);
  const double dy = 2 * (df::toCells(at.y) - df::toCells(focus.y));  // cells are twice as high as wide
  return 8.0 * (m_tick - known.since) - std::sqrt(dx * dx + dy * dy);
}

/// More than any record of the groups takes.
std::size_t SnapshotSender::mostBits(std::uint32_t id, const Publisher& publisher) const {
  constexpr std::size_t kLifeBits = 112;
  constexpr std::size_t kMotionBits = 448;
  constexpr std::size_t kBodyBits = 384;
  constexpr std::size_t kLookBits = 192;
  constexpr std::size_t kFrameBits = 32;
  constexpr std::size_t kGlyphBits = 128;
  const std::uint8_t groups = m_known.due(id);
  std::size_t bits = kLifeBits;
  if ((groups & kMotion) != 0) bits += kMotionBits;
  if ((groups & kBody) != 0) bits += kBodyBits;
  if ((groups & kLook) == 0) return bits;
  const Look& look = publisher.find(m_known.at(id).slot)->state.look;
  return bits + kLookBits + kFrameBits * look.sequence.size() + kGlyphBits * look.sequence.glyphCount();
}

// The order matters only where not all fit.
void SnapshotSender::makeQueue(const Publisher& publisher, const Room& room) {
  m_p_desk->queue.clear();
  std::size_t most = kMaxOverheadBits + m_per_client.mostBits();
  for (const std::uint32_t id : m_known.owing()) {
    m_p_desk->queue.push_back(id);
    if (most <= 8 * room.bytes) most += mostBits(id, publisher);
  }
  if (most <= 8 * room.bytes)
    return std::sort(m_p_desk->queue.begin(), m_p_desk->queue.end(), std::greater<>());
  m_p_desk->ranked.clear();
  for (const std::uint32_t id : m_p_desk->queue) m_p_desk->ranked.emplace_back(urgency(id, publisher), id);
  // Equal urgency: by id, so that a run is the same everywhere. The most urgent comes last, to be popped.
  std::sort(m_p_desk->ranked.begin(), m_p_desk->ranked.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : a.second > b.second;
  });
  std::transform(m_p_desk->ranked.begin(), m_p_desk->ranked.end(), m_p_desk->queue.begin(),
                 [](const auto& r) { return r.second; });
}

void SnapshotSender::build(const Publisher& publisher, Room room, Packets& packets) {
  packets.clear();
  m_p_desk = &desk();
  if (m_resend == Resend::kEveryTick) m_known.oweUnconfirmed(m_tick);
  m_per_client.repeatAhead();
  m_ahead.owe(m_known, m_tick);
  m_known.sweepOwing();
  m_per_client.check(publisher, m_known);
  const bool due = static_cast<std::int32_t>(m_tick - m_last_tick) >= static_cast<std::int32_t>(kKeepAlive);
  m_throttled = isOwing();
  if (!m_throttled && !due) return;
  // With the window full only the keep-alive goes out, lest what is still under way be taken for lost.
  const std::size_t window = m_flight.size() < kMaxInFlight ? kMaxInFlight - m_flight.size() : due ? 1 : 0;
  room.packets = std::min(room.packets, window);
  if (room.packets > 0) makeQueue(publisher, room);

  bool more = true;
  while (packets.size() < room.packets && more && (isOwing() || (due && packets.empty()))) {
    more = write(publisher, room, packets.add());
    room.large = room.large && !packets.back().large;
    if (more || (due && packets.size() == 1)) continue;
    takeBack();
    packets.removeLast();
  }
  m_throttled = isOwing();
  if (!packets.empty()) m_last_tick = m_tick;
}

// Fill one snapshot. False if it took nothing that was owed, so that another one would not either.
bool SnapshotSender::write(const Publisher& publisher, const Room& room, Packet& packet) {
  Flight::Snapshot& flight = m_flight.add(m_next_number);
  SnapshotHeader header{m_next_number, m_tick, m_epoch, false, false, 0, 0};
  m_per_client.tellInput(header);
  m_p_desk->writer.begin(header, m_per_client.origins().slot(), m_per_client.origins().window());
  flight.empty = !m_per_client.write(m_p_desk->writer, m_next_number, room.bytes, repeatsAhead());
  writeObjects(publisher, room, packet);
  const bool complete = !isOwing();
  if (complete && m_repairing) {
    m_clean_from = m_next_number;
    m_repairing = false;
  }
  m_p_desk->writer.setComplete(complete);
  finish(packet);
  const bool took = !m_flight.newest().empty;
  forgetOldest();
  return took;
}

void SnapshotSender::writeObjects(const Publisher& publisher, const Room& room, Packet& packet) {
  const auto last_id = static_cast<std::uint32_t>(m_known.idCount());
  m_p_desk->later.clear();
  while (!m_p_desk->queue.empty() && !packet.large) {
    const std::uint32_t id = m_p_desk->queue.back();
    const KnownObjects::Known& known = m_known.at(id);
    if (known.owed == 0) {  // paid by a packet before
      m_p_desk->queue.pop_back();
      continue;
    }
    const bool dying = known.life == KnownObjects::Life::kDying;
    const Publisher::Model* model = dying ? nullptr : publisher.find(known.slot);
    LookForm form;
    const std::size_t bits = encode(id, publisher, model, form);
    if (!m_p_desk->writer.hasRoom(bits, last_id, room.bytes)) {
      const bool alone = isTooLarge(bits, room.bytes) && room.large && m_p_desk->writer.isEmpty();
      if (!alone) m_p_desk->writer.drop();
      if (!isTooLarge(bits, room.bytes)) break;
      m_p_desk->queue.pop_back();
      if (!alone) {  // in a snapshot of its own, on the stream
        m_p_desk->later.push_back(id);
        if (room.large) break;
        continue;
      }
      packet.large = m_flight.newest().large = true;
    } else {
      m_p_desk->queue.pop_back();
    }
    pay(id, model, form);
    considerAhead(id, bits, publisher);
  }
  m_p_desk->queue.insert(m_p_desk->queue.end(), m_p_desk->later.rbegin(), m_p_desk->later.rend());
  m_known.sweepOwing();
}

void SnapshotSender::finish(Packet& packet) {
  packet.number = m_next_number;
  packet.tick = m_tick;
  m_p_desk->writer.finish(packet.bytes);
  momentOf(m_next_number) = {m_next_number, m_known.checksum(), Moment::kUnknown};
  if (++m_next_number == 0) m_next_number = 1;
}

void SnapshotSender::forgetOldest() {
  if (m_flight.size() <= kMaxInFlight) return;
  bool oldest = true;
  m_flight.removeIf([&](const Flight::Snapshot& snapshot) {
    if (!std::exchange(oldest, false)) return false;
    lost(snapshot);
    return true;
  });
}

SnapshotSender::Packet SnapshotSender::probe(const Publisher& publisher) {
  m_p_desk = &desk();
  m_tick = publisher.tick();
  m_flight.add(m_next_number).probe = true;
  m_p_desk->writer.begin({m_next_number, m_tick, m_epoch, !isOwing(), false, 0, 0},
                         m_per_client.origins().slot(), m_per_client.origins().window());
  Packet packet;
  finish(packet);
  forgetOldest();
  return packet;
}

// The snapshot just written says nothing: it never was.
void SnapshotSender::takeBack() {
  m_next_number = m_flight.newest().number;
  m_flight.removeNewest();
  momentOf(m_next_number) = {};
}

// Would it exceed the limit even alone?
bool SnapshotSender::isTooLarge(std::size_t bits, std::size_t bytes) {
  return bits + kMaxOverheadBits > 8 * bytes;
}

// Stage the record of what is due; no model: a death. Its length in bits.
std::size_t SnapshotSender::encode(std::uint32_t id, const Publisher& publisher,
                                   const Publisher::Model* model, LookForm& form) {
  static const ObjectState kNothing;
  static const SharedMotion kNoMotion;
  if (model == nullptr) return m_p_desk->writer.stage(kDeath, 0, kNothing, kNoMotion);
  const std::uint8_t groups = m_known.due(id);
  if ((groups & kLook) != 0 && model->recurs) {
    form = m_names.formOf(model->look_sum, model->state.look.sequence.weight(), m_next_number);
  }
  const KnownObjects::Known& known = m_known.at(id);
  const SharedMotion& motion = (groups & kMotion) != 0 ? publisher.sharedMotion(known.slot) : kNoMotion;
  return m_p_desk->writer.stage(groups, KnownObjects::generationOf(known), model->state, motion, form);
}

// What is staged goes into the snapshot.
void SnapshotSender::pay(std::uint32_t id, const Publisher::Model* model, LookForm form) {
  static const ObjectState kNothing;
  Flight::Snapshot& flight = m_flight.newest();
  flight.empty = false;
  if (form.kind != LookForm::kSpelled) {
    m_names.wrote(model->look_sum, m_next_number);
    if (form.kind == LookForm::kDefined) flight.names.emplace_back(form.id, model->look_sum);
  }
  flight.objects.push_back(
      m_known.paid(id, m_next_number, model == nullptr ? kNothing : model->state, m_tick));
  m_p_desk->writer.keep(id);
}

bool SnapshotSender::repeatsAhead() const {
  return m_resend == Resend::kAhead && m_line.usualLoss() > kAheadLoss;
}

void SnapshotSender::considerAhead(std::uint32_t id, std::size_t bits, const Publisher& publisher) {
  if (!repeatsAhead()) return;
  const KnownObjects::Known& known = m_known.at(id);
  double rank = urgency(id, publisher);
  if (known.life != KnownObjects::Life::kDying) {
    const df::FixedVector v = publisher.find(known.slot)->state.motion.velocity;
    rank += kAheadPerSpeed * (std::abs(df::toCells(v.x)) + std::abs(df::toCells(v.y)));
  }
  m_ahead.consider(m_flight.newest().objects.back(), bits, rank);
}

// ---- what arrived -----------------------------------------------------------------------------------------

void SnapshotSender::acknowledge(const AckWindow& acks) {
  // A number that was never sent is a lie; believing it would drop debts that are still open.
  if (isNewer(acks.newest, m_next_number - 1)) return;
  m_flight.removeIf([&](const Flight::Snapshot& snapshot) {
    const std::int32_t behind = static_cast<std::int32_t>(acks.newest - snapshot.number);
    const bool has = acks.has(snapshot.number);
    // The stream loses nothing, but it may be late.
    if (!has && (behind < m_line.patience() ||
                 (snapshot.large && behind < static_cast<std::int32_t>(kMaxInFlight)))) {
      return false;
    }
    has ? arrived(snapshot) : lost(snapshot);
    if (!has) m_missing[snapshot.number % m_missing.size()] = snapshot.number;
    if (!snapshot.probe) m_line.note(!has);
    return true;
  });
  for (std::uint32_t& number : m_missing) {
    if (number == 0 || !acks.has(number)) continue;
    m_line.noteLate();
    number = 0;
  }
}

void SnapshotSender::arrived(const Flight::Snapshot& snapshot) {
  m_per_client.arrived(snapshot.number, snapshot.probe);
  for (const KnownObjects::Sent& sent : snapshot.objects) m_known.arrived(sent, snapshot.number);
  for (const auto& [id, sum] : snapshot.names) m_names.arrived(id, sum, snapshot.number);
}

void SnapshotSender::lost(const Flight::Snapshot& snapshot) {
  bool missing = m_per_client.lost(snapshot.number);
  for (const KnownObjects::Sent& sent : snapshot.objects) {
    if (!m_known.lost(sent, snapshot.number, m_tick)) continue;
    ++m_resent;
    missing = true;
  }
  // What has changed or died since is owed already; until that is sent, the client lacks what was lost.
  m_repairing = m_repairing || missing || (!snapshot.empty && isOwing());
  // Where nothing is missing, newer snapshots have said what this one said.
  if (!snapshot.empty && isNewer(newestNumber(), m_clean_from)) m_clean_from = newestNumber();
  Moment& moment = momentOf(snapshot.number);
  if (moment.number == snapshot.number) moment.fate = snapshot.empty ? Moment::kNotMissed : Moment::kRepaired;
}

void SnapshotSender::wentByStream(std::uint32_t number) {
  if (Flight::Snapshot* snapshot = m_flight.find(number)) snapshot->large = true;
}

bool SnapshotSender::awaitsLarge() const {
  for (std::size_t i = 0; i < m_flight.size(); ++i) {
    if (m_flight.at(i).large) return true;
  }
  return false;
}

void SnapshotSender::loseLarge() {
  m_flight.removeIf([this](const Flight::Snapshot& snapshot) {
    if (snapshot.large) lost(snapshot);
    return snapshot.large;
  });
}

bool SnapshotSender::isSettled() const {
  for (std::size_t i = 0; i < m_flight.size(); ++i) {
    if (!m_flight.at(i).empty) return false;
  }
  return !isOwing();
}

std::optional<bool> SnapshotSender::isRight(const AckWindow& acks, std::uint64_t checksum) const {
  const std::uint32_t number = acks.newest;
  if (m_repairing || isNewer(m_clean_from, number)) return std::nullopt;
  // What is missing must have been found lost, and sent again since. (What is older than the window has
  // been.)
  const Moment* then = nullptr;
  for (const Moment& moment : m_moments) {
    const std::uint32_t behind = number - moment.number;
    if (behind == 0 && moment.number != 0) then = &moment;
    if (moment.number == 0 || behind == 0 || behind > kMaxInFlight || acks.has(moment.number)) continue;
    if (moment.fate == Moment::kNotMissed) continue;
    if (moment.fate != Moment::kRepaired || !isNewer(m_clean_from, moment.number)) return std::nullopt;
  }
  if (then == nullptr) return std::nullopt;
  return then->checksum == checksum;
}

void SnapshotSender::reset() {
  const std::uint32_t number = m_next_number;
  const std::uint32_t input = m_per_client.input();
  const std::uint32_t input_tick = m_per_client.inputTick();
  const ClientViewport shown = m_shown;
  *this = SnapshotSender(m_resend, m_look_ahead, static_cast<std::uint8_t>((m_epoch + 1) & 3));
  m_shown = shown;
  m_next_number = number;
  m_clean_from = number;
  noteInput(input, input_tick);  // a client that has not heard of it waits for that with further ones
}

}  // namespace naiad
