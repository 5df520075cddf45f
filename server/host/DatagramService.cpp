#include "DatagramService.h"

#include <algorithm>
#include <utility>

namespace naiad {

DatagramService::DatagramService(std::unique_ptr<DatagramSocket> socket, Now now, Random random)
    : m_socket(std::move(socket)), m_now(std::move(now)), m_random(std::move(random)), m_gate(m_random()) {
  m_socket->start(
      [this](const Path& path, std::string_view packet) { m_gate.receive(path, packet, m_now()); });
}

DatagramService::~DatagramService() = default;

std::unique_ptr<DatagramService::Channel> DatagramService::open(const KeyExporter& exporter, AeadId aead) {
  constexpr Epoch kFirstEpoch{1};
  for (;;) {
    std::unique_ptr<Channel> channel(new Channel(*this, ConnectionId{m_random()}, aead));
    if (!channel->renew(exporter, kFirstEpoch)) return nullptr;
    // Registered before it is added, since its destructor takes it out of both.
    Channel* p_channel = channel.get();
    const auto deliver = [p_channel](std::string_view payload) {
      p_channel->answerChallenges();
      if (!payload.empty() && p_channel->m_on_packet) p_channel->m_on_packet(payload);
    };
    if (!m_gate.add(channel->m_link, deliver)) continue;  // an id that is taken: one in 2^64
    m_channels.push_back(p_channel);
    return channel;
  }
}

void DatagramService::flush() {
  for (Channel* channel : m_channels) channel->answerChallenges();
  m_socket->flush();
}

DatagramService::Channel::Channel(DatagramService& service, ConnectionId id, AeadId aead)
    : m_service(service), m_aead(aead), m_link({SealedLink::Role::kServer, id, service.m_random, {}}) {}

DatagramService::Channel::~Channel() {
  // One that never got in must not take the session with it that has the same id.
  if (std::erase(m_service.m_channels, this) > 0) m_service.m_gate.remove(m_link.id());
}

bool DatagramService::Channel::renew(const KeyExporter& exporter, Epoch epoch) {
  try {
    return m_link.startEpoch(epoch, deriveDatagramKeys(exporter, m_aead, m_link.id(), epoch),
                             m_service.m_now());
  } catch (const KeyExportError&) {
    return false;  // a stream without encryption, or one that has just died
  }
}

void DatagramService::Channel::start(std::function<void(std::string_view)> on_packet) {
  m_on_packet = std::move(on_packet);
}

void DatagramService::Channel::send(std::string_view packet) {
  if (const auto outgoing = m_link.seal(packet, m_service.m_now())) {
    m_service.m_socket->send(outgoing->path, outgoing->packet);
  }
}

// An address has to prove itself before much is sent there.
void DatagramService::Channel::answerChallenges() {
  if (m_link.wantsToSend(m_service.m_now())) send({});
}

std::string DatagramService::Channel::peerAddress() const {
  return m_link.path() ? toString(m_link.path()->remote) : "nowhere";
}

std::uint64_t DatagramService::Channel::id() const {
  return m_link.id().value;
}

}  // namespace naiad
