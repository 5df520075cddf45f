#include "host/net/DatagramService.h"

#include <algorithm>
#include <utility>

namespace naiad {

DatagramService::DatagramService(std::unique_ptr<DatagramSocket> socket, Now now, Random random)
    : m_socket(std::move(socket)), m_now(std::move(now)), m_random(std::move(random)) {
  m_socket->start([this](const Path& path, std::string_view packet) {
    m_received = m_now();
    m_bytes_received += packet.size();
    m_gate.receive(path, packet, m_received);
  });
}

DatagramService::~DatagramService() = default;

std::unique_ptr<DatagramService::Channel> DatagramService::open(const KeyExporter& exporter, AeadId aead) {
  for (;;) {
    const ConnectionId id{m_random()};
    if (m_gate.has(id)) continue;  // another session has this id: probability 2^-64
    return open(exporter, aead, id);
  }
}

std::unique_ptr<DatagramService::Channel> DatagramService::open(const KeyExporter& exporter, AeadId aead,
                                                                ConnectionId id) {
  constexpr Epoch kFirstEpoch{1};
  std::unique_ptr<Channel> channel(new Channel(*this, id, aead));
  if (!channel->renew(exporter, kFirstEpoch)) return nullptr;
  const auto deliver = [p_channel = channel.get()](std::string_view payload) {
    p_channel->markUnvalidated();
    p_channel->answerChallenges(p_channel->m_service.m_received);
    if (!payload.empty() && p_channel->m_on_packet) p_channel->m_on_packet(payload);
  };
  channel->m_registered = m_gate.add(channel->m_link, deliver);
  return channel->m_registered ? std::move(channel) : nullptr;
}

void DatagramService::flush() {
  std::erase_if(m_unvalidated, [this](Channel* channel) {
    channel->answerChallenges(m_now());
    channel->m_unvalidated = !channel->m_link.isValidated(*channel->m_link.path());
    return !channel->m_unvalidated;
  });
  m_socket->flush();
}

DatagramService::Channel::Channel(DatagramService& service, ConnectionId id, AeadId aead)
    : m_service(service),
      m_aead(aead),
      m_link({SealedLink::Role::kServer, id, service.m_random, {}, service.m_scratch}) {}

DatagramService::Channel::~Channel() {
  if (m_unvalidated) std::erase(m_service.m_unvalidated, this);
  // An unregistered channel must not remove the session that already has its id.
  if (m_registered) m_service.m_gate.remove(m_link.id());
}

bool DatagramService::Channel::renew(const KeyExporter& exporter, Epoch epoch) {
  try {
    return m_link.startEpoch(epoch, deriveDatagramKeys(exporter, m_aead, m_link.id(), epoch),
                             m_service.m_now());
  } catch (const KeyExportError&) {
    return false;  // a stream without encryption, or one that has just ended
  }
}

bool DatagramService::Channel::renew(const ReliableChannel& stream, Epoch epoch) {
  return renew([&stream](std::string_view label, std::string_view context,
                         std::size_t bytes) { return stream.exportSecret(label, context, bytes); },
               epoch);
}

void DatagramService::Channel::start(std::function<void(std::string_view)> on_packet) {
  m_on_packet = std::move(on_packet);
}

void DatagramService::Channel::send(std::string_view packet) {
  DatagramSocket& socket = *m_service.m_socket;
  if (const auto outgoing = m_link.seal(packet, m_service.m_now(), socket.nextPacket())) {
    m_service.m_bytes_sent += outgoing->packet.size();
    socket.send(outgoing->path, outgoing->packet);
  }
}

// Sends an answer or a challenge if due: an address must be validated before much is sent to it.
void DatagramService::Channel::answerChallenges(Time now) {
  if (m_link.needsToSend(now)) send({});
}

// Makes flush() send challenges to a new address until the address is validated.
void DatagramService::Channel::markUnvalidated() {
  if (m_unvalidated || m_link.isValidated(*m_link.path())) return;
  m_unvalidated = true;
  m_service.m_unvalidated.push_back(this);
}

std::string DatagramService::Channel::peerAddress() const {
  return m_link.path() ? toString(m_link.path()->remote) : "nowhere";
}

std::uint64_t DatagramService::Channel::id() const {
  return m_link.id().value;
}

}  // namespace naiad
