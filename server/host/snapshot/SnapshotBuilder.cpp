#include "host/snapshot/SnapshotBuilder.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include "host/snapshot/ClientReplica.h"
#include "host/snapshot/Publisher.h"
#include "host/snapshot/SnapshotPackets.h"

namespace naiad {

namespace {

/// A tick of waiting counts like being this many cells nearer.
constexpr double kCellsPerTick = 8;
/// For repeats, a cell per tick of speed counts like being this many cells nearer.
constexpr double kCellsPerSpeed = 20;
/// Deaths are the most urgent: they are short, and each removes an object that is shown but no longer exists.
constexpr double kDeathUrgency = 1e6;
constexpr double kOwnUrgency = 1e5;

/// True for the object that the view follows and the one that the player steers.
bool isOwn(const KnownObjects::Known& known, const df::PlayerFacts& player) {
  const df::ObjectKey key{known.slot, known.generation};
  return player.followed == key || player.steering.object == key;
}

/// Urgency of an object's record for one client, in cells: minus the distance from the middle of its view,
/// plus kCellsPerTick for each tick waited.
class Urgency {
 public:
  Urgency(const ClientReplica& replica, const Publisher& publisher)
      : m_replica(replica), m_publisher(publisher) {}
  double of(std::uint32_t id) const {
    // View objects, objects near the middle of the view, and objects that have waited for long come first.
    const KnownObjects::Known& known = m_replica.objects.at(id);
    const df::PlayerFacts& player = m_replica.state.player();
    if (known.life == KnownObjects::Life::kDying) return kDeathUrgency;
    if (isOwn(known, player)) return kOwnUrgency;
    const std::uint32_t tick = m_publisher.tick();
    const double waited = kCellsPerTick * (tick - known.pending_since);
    const ObjectState& state = m_publisher.find(known.slot)->state;
    if (state.body.on_view) return waited;
    const df::FixedVector at = positionAt(state.motion, tick);
    const WorldRecord& world = m_replica.state.world();
    const df::FixedVector corner = player.view_corner;
    const df::FixedVector focus{corner.x + df::fromCells(world.view_width) / 2,
                                corner.y + df::fromCells(world.view_height) / 2};
    const double dx = df::toCells(at.x) - df::toCells(focus.x);
    const double dy = 2 * (df::toCells(at.y) - df::toCells(focus.y));  // cells are twice as high as wide
    return waited - std::sqrt(dx * dx + dy * dy);
  }
  /// Urgency of repeating the record before a loss is known. A fast object is more urgent, because it is soon
  /// drawn in the wrong cell.
  double ofResend(std::uint32_t id) const {
    const KnownObjects::Known& known = m_replica.objects.at(id);
    if (known.life == KnownObjects::Life::kDying) return of(id);
    const df::FixedVector v = m_publisher.find(known.slot)->state.motion.velocity;
    return of(id) + kCellsPerSpeed * (std::abs(df::toCells(v.x)) + std::abs(df::toCells(v.y)));
  }

 private:
  const ClientReplica& m_replica;
  const Publisher& m_publisher;
};

/// Returns an upper bound of the bits of an object's record in its present state.
std::size_t maxBits(std::uint32_t id, const ClientReplica& replica, const Publisher& publisher) {
  constexpr std::size_t kLifeBits = 112;
  constexpr std::size_t kMotionBits = 448;
  constexpr std::size_t kBodyBits = 384;
  constexpr std::size_t kLookBits = 192;
  constexpr std::size_t kFrameBits = 32;
  constexpr std::size_t kGlyphBits = 128;
  const std::uint8_t groups = replica.objects.groupsToSend(id);
  std::size_t bits = kLifeBits;
  if ((groups & kMotion) != 0) bits += kMotionBits;
  if ((groups & kBody) != 0) bits += kBodyBits;
  if ((groups & kLook) == 0) return bits;
  const Sequence& sequence = publisher.find(replica.objects.at(id).slot)->state.look.sequence;
  return bits + kLookBits + kFrameBits * sequence.size() + kGlyphBits * sequence.glyphCount();
}

/// Placeholders in a record without state or motion.
const ObjectState kNoState;
const SharedMotion kNoMotion;

/// True if a record of `bits` does not fit into a snapshot of `bytes`, even alone.
bool isTooLarge(std::size_t bits, std::size_t bytes) {
  return bits + PacketLimits::kMaxOverheadBits > 8 * bytes;
}

}  // namespace

void RedundantResend::addRecord(const KnownObjects::Sent& sent, std::size_t bits, double urgency) {
  const auto repeated = std::find_if(m_current.begin(), m_current.end(),
                                     [&sent](const Record& record) { return record.sent.id == sent.id; });
  const int repeats = repeated != m_current.end() ? repeated->repeats + 1 : 0;
  if (repeats > 1 || (repeats == 1 && bits > kShortBits)) return;
  m_next.push_back({urgency, bits, sent, repeats});
}

void RedundantResend::requeueRecords(KnownObjects& known, std::uint32_t tick) {
  std::sort(m_next.begin(), m_next.end(), [](const Record& a, const Record& b) {
    return a.urgency != b.urgency ? a.urgency > b.urgency : a.sent.id < b.sent.id;
  });
  m_current.clear();
  std::size_t used = 0;
  for (const Record& record : m_next) {
    const KnownObjects::Sent& sent = record.sent;
    const KnownObjects::Known& now = known.at(sent.id);
    if (now.birth != sent.birth || now.unconfirmed == 0) continue;
    if (used > 0 && used + record.bits > kBits) continue;
    used += record.bits;
    known.addPending(sent.id, now.unconfirmed & (sent.groups == kDeath ? +kLife : +sent.groups), tick);
    m_current.push_back(record);
  }
  m_next.clear();
}

void PendingQueue::fill(const ClientReplica& replica, const Publisher& publisher, std::size_t limit) {
  m_ids.clear();
  std::size_t bits = PacketLimits::kMaxOverheadBits + replica.state.maxPendingBits();
  for (const std::uint32_t id : replica.objects.pendingIds()) {
    m_ids.push_back(id);
    if (bits <= 8 * limit) bits += maxBits(id, replica, publisher);
  }
  if (bits <= 8 * limit) return std::sort(m_ids.begin(), m_ids.end(), std::greater<>());
  m_ranked.clear();
  const Urgency urgency(replica, publisher);
  for (const std::uint32_t id : m_ids) m_ranked.emplace_back(urgency.of(id), id);
  // Ties are ordered by id, so that runs are deterministic.
  std::sort(m_ranked.begin(), m_ranked.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : a.second > b.second;
  });
  std::transform(m_ranked.begin(), m_ranked.end(), m_ids.begin(), [](const auto& r) { return r.second; });
}

SnapshotBuilder& SnapshotBuilder::ofThread() {
  thread_local SnapshotBuilder builder;
  return builder;
}

void SnapshotBuilder::beginSnapshot(const SnapshotHeader& header, ClientReplica& replica,
                                    InFlightSnapshots::Snapshot& flight, RedundantResend* redundancy) {
  m_header = header;
  m_p_replica = &replica;
  m_p_flight = &flight;
  m_p_redundancy = redundancy;
  m_writer.beginSnapshot(header, replica.state.origins().slot(), replica.state.origins().window());
}

void SnapshotBuilder::writeState(std::size_t limit) {
  m_p_flight->empty = !m_p_replica->state.write(m_writer, m_header.number, limit, m_p_redundancy != nullptr);
}

void SnapshotBuilder::writeObjects(const Publisher& publisher, const PacketLimits& limits) {
  KnownObjects& objects = m_p_replica->objects;
  const auto last_id = static_cast<std::uint32_t>(objects.idCount());
  while (!m_queue.empty() && !m_p_flight->large) {
    const std::uint32_t id = m_queue.front();
    if (objects.at(id).pending == 0) {  // an earlier snapshot of this tick carries it
      m_queue.pop();
      continue;
    }
    const Record record = stageRecord(id, publisher);
    if (!m_writer.hasSpace(record.bits, last_id, limits.bytes)) {
      const bool too_large = isTooLarge(record.bits, limits.bytes);
      m_p_flight->large = too_large && limits.large && m_writer.isEmpty();
      if (!m_p_flight->large) {
        m_writer.drop();
        if (!too_large) break;
        m_queue.defer();  // the record needs a snapshot of its own, on the stream
        if (limits.large) break;
        continue;
      }
    }
    m_queue.pop();
    commitRecord(record, publisher);
  }
  m_queue.restoreDeferred();
  objects.trimPending();
}

SnapshotBuilder::Record SnapshotBuilder::stageRecord(std::uint32_t id, const Publisher& publisher) {
  const KnownObjects::Known& known = m_p_replica->objects.at(id);
  Record record;
  record.id = id;
  record.p_model = known.life == KnownObjects::Life::kDying ? nullptr : publisher.find(known.slot);
  if (record.p_model == nullptr) {
    record.bits = m_writer.stage(kDeath, 0, kNoState, kNoMotion);
    return record;
  }
  const std::uint8_t groups = m_p_replica->objects.groupsToSend(id);
  const Publisher::Model& model = *record.p_model;
  if ((groups & kLook) != 0 && model.recurs) {
    record.form =
        m_p_replica->names.formOf(model.look_sum, model.state.look.sequence.weight(), m_header.number);
  }
  if ((groups & kMotion) != 0) record.p_motion = &publisher.sharedMotion(known.slot);
  record.bits = m_writer.stage(groups, KnownObjects::generationOf(known), model.state,
                               record.p_motion != nullptr ? *record.p_motion : kNoMotion, record.form);
  return record;
}

void SnapshotBuilder::commitRecord(const Record& record, const Publisher& publisher) {
  m_p_flight->empty = false;
  if (record.form.kind != LookForm::kInline) {
    m_p_replica->names.markUsed(record.p_model->look_sum, m_header.number);
    if (record.form.kind == LookForm::kDefined) {
      m_p_flight->names.emplace_back(record.form.id, record.p_model->look_sum);
    }
  }
  const ObjectState& state = record.p_model != nullptr ? record.p_model->state : kNoState;
  const Motion& motion = record.p_motion != nullptr ? record.p_motion->motion : kNoMotion.motion;
  m_p_flight->objects.push_back(
      m_p_replica->objects.markSent(record.id, m_header.number, state, motion, m_header.tick));
  m_writer.commit(record.id);
  if (m_p_redundancy == nullptr) return;
  m_p_redundancy->addRecord(m_p_flight->objects.back(), record.bits,
                            Urgency(*m_p_replica, publisher).ofResend(record.id));
}

void SnapshotBuilder::finish(bool complete, std::string& bytes) {
  m_writer.setComplete(complete);
  m_writer.finish(bytes);
}

}  // namespace naiad
