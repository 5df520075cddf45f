#include "LinkedClient.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "shared/replica/UpdateCodec.h"

namespace bench {

using namespace naiad;

LinkedClient::LinkedClient(VirtualClock& clock, const LinkConditions& conditions, std::uint64_t seed,
                           Resend resend)
    : m_clock(clock),
      m_sender(resend),
      m_display(kTickLength),
      m_link(clock, conditions, seed),
      m_server(m_link.takeEnd(LinkEnd::kServer)),
      m_client(m_link.takeEnd(LinkEnd::kClient)) {
  m_server->start([this](std::string_view bytes) { serverHears(bytes); });
  m_client->start([this](std::string_view bytes) { clientHears(bytes); });
}

void LinkedClient::tick(const Publisher& publisher, const df::PlayerFacts& player) {
  m_tick = publisher.tick();
  const auto begin = std::chrono::steady_clock::now();
  m_sender.applyTick(publisher, player);
  const std::vector<SnapshotSender::Packet> packets = m_sender.build(publisher);
  encode += std::chrono::steady_clock::now() - begin;
  for (const SnapshotSender::Packet& packet : packets) {
    bytes_down += packet.bytes.size() + kDownOverhead;
    ++packets_down;
    m_server->send(packet.bytes);
  }
}

void LinkedClient::resetFigures() {
  bytes_down = bytes_up = packets_down = 0;
  encode = {};
}

void LinkedClient::serverHears(std::string_view bytes) {
  const auto update = readUpdate(bytes, {m_sender.newestNumber(), m_tick, 0});
  if (!update) throw std::logic_error("an update that cannot be read");
  m_sender.acknowledge(update->acks);
}

void LinkedClient::clientHears(std::string_view bytes) {
  Snapshot snapshot;
  if (m_replica.read(bytes, snapshot) != ReadResult::kOk) return;
  if (on_snapshot) on_snapshot(snapshot);
  m_replica.apply(snapshot);
  m_acks.addReceived(snapshot.header.number);
  m_display.onSnapshot(snapshot.header.tick, now());
  ClientUpdate update;
  update.acks = m_acks;
  const std::string answer = writeUpdate(update);
  bytes_up += answer.size() + kUpOverhead;
  m_client->send(answer);
}

}  // namespace bench
