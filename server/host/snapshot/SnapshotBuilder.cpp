#include "host/snapshot/SnapshotBuilder.h"

#include "host/snapshot/Urgency.h"

namespace naiad {

namespace {

/// Of a record without its state or its motion.
const ObjectState kNoState;
const SharedMotion kNoMotion;

/// Does a record of so many bits exceed a snapshot of `bytes` even alone?
bool isTooLarge(std::size_t bits, std::size_t bytes) {
  return bits + PacketLimits::kMaxOverheadBits > 8 * bytes;
}

}  // namespace

SnapshotBuilder& SnapshotBuilder::ofThread() {
  thread_local SnapshotBuilder builder;
  return builder;
}

void SnapshotBuilder::beginSnapshot(const SnapshotHeader& header, ClientReplica& replica,
                                    Flight::Snapshot& flight, RedundantResend* redundancy) {
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
    if (objects.at(id).pending == 0) {  // an earlier snapshot of the tick carries it
      m_queue.pop();
      continue;
    }
    const Record record = stageRecord(id, publisher);
    if (!m_writer.hasRoom(record.bits, last_id, limits.bytes)) {
      const bool too_large = isTooLarge(record.bits, limits.bytes);
      m_p_flight->large = too_large && limits.large && m_writer.isEmpty();
      if (!m_p_flight->large) {
        m_writer.drop();
        if (!too_large) break;
        m_queue.defer();  // to a snapshot of its own, on the stream
        if (limits.large) break;
        continue;
      }
    }
    m_queue.pop();
    keepRecord(record, publisher);
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

void SnapshotBuilder::keepRecord(const Record& record, const Publisher& publisher) {
  m_p_flight->empty = false;
  if (record.form.kind != LookForm::kSpelled) {
    m_p_replica->names.markUsed(record.p_model->look_sum, m_header.number);
    if (record.form.kind == LookForm::kDefined) {
      m_p_flight->names.emplace_back(record.form.id, record.p_model->look_sum);
    }
  }
  const ObjectState& state = record.p_model != nullptr ? record.p_model->state : kNoState;
  const Motion& motion = record.p_motion != nullptr ? record.p_motion->motion : kNoMotion.motion;
  m_p_flight->objects.push_back(
      m_p_replica->objects.markSent(record.id, m_header.number, state, motion, m_header.tick));
  m_writer.keep(record.id);
  if (m_p_redundancy == nullptr) return;
  m_p_redundancy->addRecord(m_p_flight->objects.back(), record.bits,
                            Urgency(*m_p_replica, publisher).ofRepeating(record.id));
}

void SnapshotBuilder::finish(bool complete, std::string& bytes) {
  m_writer.setComplete(complete);
  m_writer.finish(bytes);
}

}  // namespace naiad
