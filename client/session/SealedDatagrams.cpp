#include "client/session/SealedDatagrams.h"

#include <utility>

#include "shared/net/stream/TcpListener.h"

namespace naiad {

SealedDatagrams::SealedDatagrams(std::unique_ptr<DatagramSocket> socket, const Endpoint& server,
                                 ConnectionId id, Now now, SealLimits limits)
    : m_socket(std::move(socket)),
      m_server(server),
      m_now(std::move(now)),
      m_link({SealedLink::Role::kClient, id, {}, limits}) {
  m_link.setServerPath({Endpoint{}, server});
}

bool SealedDatagrams::startEpoch(const KeyExporter& exporter, AeadId aead, Epoch epoch) {
  try {
    return m_link.startEpoch(epoch, deriveDatagramKeys(exporter, aead, m_link.id(), epoch), m_now());
  } catch (const KeyExportError&) {
    return false;
  }
}

bool SealedDatagrams::takeNewEpochDue() {
  if (!m_link.wantsNewEpoch() || m_left_epoch == m_link.epoch()) return false;
  m_left_epoch = m_link.epoch();
  return true;
}

void SealedDatagrams::start(std::function<void(std::string_view packet)> on_packet) {
  m_socket->start([this, on_packet = std::move(on_packet)](const Path& path, std::string_view packet) {
    const auto payload = m_link.open(path, packet, m_now());
    if (!payload) return;
    if (m_link.wantsToSend(m_now())) send({});  // the response to a challenge
    if (!payload->empty()) on_packet(*payload);
  });
}

void SealedDatagrams::send(std::string_view packet) {
  const auto outgoing = m_link.seal(packet, m_now(), m_socket->nextPacket());
  if (!outgoing) return;
  m_socket->send(outgoing->path, outgoing->packet);
  m_socket->flush();
}

void SealedDatagrams::reopen() {
  try {
    m_socket->reopen();
  } catch (const ListenError&) {
    // No port now; the stream goes on, and this is tried again when the next stream is made.
  }
}

}  // namespace naiad
