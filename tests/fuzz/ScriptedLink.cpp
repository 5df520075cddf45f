#include "ScriptedLink.h"

#include <utility>

#include "Require.h"
#include "shared/replica/UpdateCodec.h"

namespace naiad::fuzz {
namespace {

constexpr ConnectionId kSession{0x1122334455667788};
constexpr Path kServerPath{};

DatagramKeys someKeys() {
  DatagramKeys keys;
  keys.client.key.fill(1);
  keys.server.key.fill(2);
  return keys;
}

Path clientPath() {
  Path path;
  path.remote.port = 40000;
  return path;
}

}  // namespace

ScriptedLink::ScriptedLink(Resend resend)
    : m_sender(resend),
      m_server_link({.role = SealedLink::Role::kServer,
                     .id = kSession,
                     .random = [this] { return ++m_challenge; },
                     .limits = {}}),
      m_client_link({.role = SealedLink::Role::kClient, .id = kSession, .random = {}, .limits = {}}) {
  m_server_link.startEpoch(0, someKeys(), m_now);
  m_client_link.startEpoch(0, someKeys(), m_now);
  m_client_link.setServerPath(kServerPath);
  settlePath();
}

void ScriptedLink::settlePath() {
  REQUIRE(m_server_link.open(clientPath(), m_client_link.seal("", m_now)->packet, m_now));
  REQUIRE(m_client_link.open(kServerPath, m_server_link.seal("", m_now)->packet, m_now));
  REQUIRE(m_server_link.open(clientPath(), m_client_link.seal("", m_now)->packet, m_now));
  REQUIRE(m_server_link.isValidated(clientPath()));
}

void ScriptedLink::run(Script& script, int ticks) {
  while (ticks > 0 && !script.atEnd()) {
    const std::uint8_t what = script.byte();
    switch (what % 8) {
      case 0:
      case 1:
      case 2:
        m_world.happen(script);
        break;
      case 3:
        deliverHeld((what & 8) != 0);
        break;
      case 4:
        if ((what & 0xF8) == 0xF8) reset();
        m_input += what >> 6;
        m_sender.setNewestInput(m_input, m_publisher.tick());
        break;
      default:
        --ticks;
        tick(static_cast<Fate>(what / 8 % 6), &script);
        if (what >= 0xF0) m_sender.setLookAhead(what & 7);
    }
  }
}

void ScriptedLink::heal(int ticks) {
  deliverHeld(false);
  for (int i = 0; i < ticks; ++i) {
    tick(Fate::kArrives, nullptr);
    if (i > 0 && m_sender.isSettled()) return;
  }
}

void ScriptedLink::tick(Fate fate, Script* p_script) {
  m_now += std::chrono::milliseconds(33);
  m_world.tick();
  m_publisher.update(m_world.view());
  m_sender.applyTick(m_publisher, m_world.view().players[0]);
  for (const SnapshotSender::Packet& packet : m_sender.build(m_publisher)) {
    REQUIRE(packet.bytes.size() <= (packet.large ? kMaxSnapshot : kMaxDatagramSnapshot));
    if (packet.large) {  // large packets are sent over the stream, which loses nothing
      hear(packet.bytes);
      answer(true);
      continue;
    }
    const auto sealed = m_server_link.seal(packet.bytes, m_now);
    REQUIRE(sealed.has_value());
    const Sent sent{std::string(sealed->packet), packet.bytes};
    if (fate == Fate::kHeld) {
      m_held.push_back(sent);
    } else if (fate == Fate::kDamaged) {
      damage(sent, *p_script);
    } else if (fate != Fate::kLost) {
      deliver(sent, fate != Fate::kUnanswered);
      if (fate == Fate::kDoubled) hear(packet.bytes);  // as if it arrived on both channels
    }
  }
}

void ScriptedLink::deliver(const Sent& sent, bool answered) {
  const Exactly packet(sent.sealed);
  const auto plain = m_client_link.open(kServerPath, packet.view(), m_now);
  if (!plain) return;  // rejected, because it is too old for the replay window
  REQUIRE(*plain == sent.plain);
  REQUIRE(!m_client_link.open(kServerPath, packet.view(), m_now));
  hear(std::string(*plain));
  answer(answered);
}

/// Damages a packet. The seal must reject it, and even without the seal it must not harm the replica.
void ScriptedLink::damage(const Sent& sent, Script& script) {
  const std::size_t where = script.number<std::uint16_t>();
  const auto flipped = [where](std::string bytes) {
    const std::size_t bit = where % (bytes.size() * 8);
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
    return bytes;
  };
  const Exactly packet(flipped(sent.sealed));
  REQUIRE(!m_client_link.open(kServerPath, packet.view(), m_now));

  const Exactly plain(flipped(sent.plain));
  Replica copy = m_replica;
  Snapshot snapshot;
  if (copy.read(plain.view(), snapshot) != ReadResult::kOk) return;
  copy.apply(snapshot);
  copy.render(copy.newest().tick);
}

void ScriptedLink::deliverHeld(bool backwards) {
  while (!m_held.empty()) {
    const Sent sent = backwards ? m_held.back() : m_held.front();
    backwards ? m_held.pop_back() : m_held.pop_front();
    deliver(sent, true);
  }
}

bool ScriptedLink::takeEpoch(const std::string& bytes) {
  const auto epoch = peekEpoch(bytes);
  REQUIRE(epoch.has_value());
  const int ahead = (*epoch - m_epoch) & 3;
  if (ahead == 1) {
    m_replica = Replica(m_replica.newest().tick);
    m_epoch = *epoch;
  }
  return ahead < 2;
}

void ScriptedLink::hear(const std::string& bytes) {
  if (!takeEpoch(bytes)) return;
  const Exactly exactly(bytes);
  Snapshot snapshot;
  const ReadResult result = m_replica.read(exactly.view(), snapshot);
  REQUIRE(result != ReadResult::kMalformed);
  if (result == ReadResult::kStale) return;
  m_replica.apply(snapshot);
  m_acks.addReceived(snapshot.header.number);
}

void ScriptedLink::answer(bool arrives) {
  ClientUpdate update;
  update.acks = m_acks;
  update.checksum = m_replica.checksum();
  const auto sealed = m_client_link.seal(writeUpdate(update), m_now);
  REQUIRE(sealed.has_value());
  if (!arrives) return;
  const auto plain = m_server_link.open(clientPath(), sealed->packet, m_now);
  REQUIRE(plain.has_value());
  const auto read = readUpdate(*plain, {m_sender.newestNumber(), m_publisher.tick(), 0});
  REQUIRE(read && read->acks.newest == m_acks.newest && read->acks.mask == m_acks.mask);
  if (read->acks.newest != 0) m_sender.acknowledge(read->acks);
  REQUIRE(m_sender.matchesChecksum(read->acks, *read->checksum) != std::optional(false));
}

// Resets like a client that cannot recover, but only after the client has seen the last reset.
void ScriptedLink::reset() {
  if (m_server_epoch != m_epoch) return;
  m_sender.reset();
  m_server_epoch = (m_server_epoch + 1) & 3;
  m_held.clear();
}

void ScriptedLink::requireSame() const {
  REQUIRE(m_sender.isSettled());
  std::size_t alive = 0;
  const std::uint32_t tick = m_publisher.tick();
  m_sender.known().forEachAlive([&](std::uint32_t id, const KnownObjects::Known& known) {
    ++alive;
    const Publisher::Model* model = m_publisher.find(known.slot);
    const Replica::ReplicaObject* entry = m_replica.find(id);
    REQUIRE(model != nullptr && entry != nullptr);
    REQUIRE(known.generation == model->generation);
    REQUIRE(entry->state.order == model->state.order);
    REQUIRE(rebase(entry->state.look, tick) == rebase(model->state.look, tick));
    REQUIRE(entry->state.body == model->state.body);
    REQUIRE(rebase(entry->state.motion, tick) == rebase(model->state.motion, tick));
  });
  REQUIRE(m_replica.aliveCount() == alive);
  REQUIRE(m_sender.matchesChecksum(m_acks, m_replica.checksum()) != std::optional(false));
  REQUIRE(countDifferences(m_world.picture(), m_replica.render(tick)) == 0);
}

}  // namespace naiad::fuzz
