// Sealed datagrams of a session with known keys: the fuzzer writes headers and contents, which are sealed
// correctly or not at all. A packet with a wrong seal is never opened, and a packet with a right one at most
// once.
//
//   input   flags 1: 1 ChaCha20, 2 short-lived keys | steps: action 1 and its parameters
#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <vector>

#include "Target.h"
#include "shared/net/datagram/DatagramDemux.h"
#include "shared/net/datagram/Seal.h"
#include "shared/net/datagram/SealedLink.h"
#include "shared/values/LittleEndian.h"

namespace naiad::fuzz {
namespace {

using namespace std::chrono_literals;

constexpr ConnectionId kSession{0x1122334455667788};

SealKey keyFor(AeadId aead, Epoch epoch, unsigned char direction) {
  SealKey key;
  key.aead = aead;
  storeLittleEndian(epoch, reinterpret_cast<char*>(key.key.data()));
  key.iv.fill(direction);
  return key;
}
DatagramKeys keysFor(AeadId aead, Epoch epoch) {
  return {keyFor(aead, epoch, 1), keyFor(aead, epoch, 2)};
}

Path pathOf(std::uint8_t number) {
  Path path;
  path.remote.address[15] = number;
  path.remote.port = number;
  return path;
}

class Play {
 public:
  explicit Play(Script& script)
      : m_script(script),
        m_flags(script.byte()),
        m_aead((m_flags & 1) != 0 ? AeadId::kChaCha20Poly1305 : AeadId::kAes128Gcm),
        m_limits((m_flags & 2) != 0 ? SealLimits{4, 6} : SealLimits{}),
        m_client({.role = SealedLink::Role::kClient, .id = kSession, .random = {}, .limits = m_limits}),
        m_server({.role = SealedLink::Role::kServer,
                  .id = kSession,
                  .random = [this] { return ++m_challenge; },
                  .limits = m_limits}),
        m_gate({.session = {250, 20}, .claimed = {32, 12}, .prefix = {40, 8}, .strangers = {60, 10}}) {
    m_client.setServerPath(pathOf(200));
    REQUIRE(m_gate.add(m_server, [this](std::string_view payload) { m_heard.emplace(payload); }));
    REQUIRE(!m_gate.add(m_server, {}));
    newEpoch(0);
  }

  void run() {
    for (int steps = 0; steps < 200 && !m_script.atEnd(); ++steps) step();
    const DatagramDemuxCounters& gate = m_gate.counters();
    const std::uint64_t counted = gate.delivered + gate.too_short + gate.too_long + gate.bad_kind +
                                  gate.unknown_id + gate.session_flood + gate.unvalidated_session_flood +
                                  gate.prefix_flood + gate.unvalidated_flood + gate.refused;
    REQUIRE(counted == m_received);
    m_gate.remove(kSession);
    toServer(std::string(40, '\x10'), pathOf(1));
    REQUIRE(!m_heard);
  }

 private:
  void step() {
    const std::uint8_t what = m_script.byte();
    m_client.needsToSend(m_now);
    m_server.needsToSend(m_now);
    m_client.needsNewEpoch();
    switch (what % 9) {
      case 0:
        return say(m_client, pathOf(what / 9));
      case 1:
        return say(m_server, pathOf(200));
      case 2:
        return sealAnything(SealDirection::kClientToServer, pathOf(what / 9));
      case 3:
        return sealAnything(SealDirection::kServerToClient, pathOf(200));
      case 4:
        return change();
      case 5:
        return repeat(pathOf(what / 9));
      case 6:
        return sendUnsealed();
      case 7:
        m_now += std::chrono::milliseconds(m_script.byte() * std::size_t{what / 9u});
        return;
      default:
        return newEpoch(m_epoch + m_script.byte() % 20);
    }
  }

  void newEpoch(Epoch epoch) {
    const bool fresh = !m_client.epoch();
    const bool good = fresh || (epoch > m_epoch && epoch - m_epoch <= kEpochMask);
    REQUIRE(m_client.startEpoch(epoch, keysFor(m_aead, epoch), m_now) == good);
    REQUIRE(m_server.startEpoch(epoch, keysFor(m_aead, epoch), m_now) == good);
    if (good) m_epoch = epoch;
    if (good) m_sealers.clear();
  }

  /// Sends a packet like the product does.
  void say(SealedLink& link, const Path& path) {
    const bool up = &link == &m_client;
    const std::string payload = m_script.bytes(m_script.byte() * std::size_t{5});
    const std::size_t most = std::min(link.maxPayload(), link.payloadBudget().value_or(link.maxPayload()));
    const auto outgoing = link.seal(std::string_view(payload).substr(0, most), m_now);
    if (!outgoing) return;
    REQUIRE(outgoing->packet.size() <= kMaxDatagram);
    send(up, std::string(outgoing->packet), path);
  }

  /// Sends a packet with any header and content, sealed with the correct key of the newest epoch.
  void sealAnything(SealDirection direction, const Path& path) {
    const bool up = direction == SealDirection::kClientToServer;
    std::array<char, kMaxDatagram + 64> packet{};
    const std::size_t prefix = writeSealedPrefix(direction, m_epoch, kSession, packet.data());
    const std::uint8_t where = m_script.byte();  // below 128: replaces one byte of the header
    if (where < 128) packet[where % prefix] = static_cast<char>(m_script.byte());
    const std::string text = m_script.bytes(m_script.byte());
    std::copy(text.begin(), text.end(), packet.begin() + static_cast<std::ptrdiff_t>(prefix) + 2);
    while (m_sealers.size() < 2) {
      const DatagramKeys keys = keysFor(m_aead, m_epoch);
      m_sealers.emplace_back(m_sealers.empty() ? keys.server : keys.client);
    }
    const std::size_t size = m_sealers[up ? 1 : 0].seal(packet.data(), prefix, text.size());
    send(up, std::string(packet.data(), size), path);
  }

  void send(bool up, std::string packet, const Path& path) {
    m_sent.push_back({up, packet});
    if (m_sent.size() > 16) m_sent.erase(m_sent.begin());
    deliver(up, packet, path);
  }

  /// Requires that a modified copy of a sent packet is rejected.
  void change() {
    if (m_sent.empty()) return;
    const Sent& sent = m_sent[m_script.below(m_sent.size())];
    std::string packet = sent.packet;
    const std::size_t bit = m_script.number<std::uint16_t>() % (packet.size() * 8);
    packet[bit / 8] = static_cast<char>(packet[bit / 8] ^ (1 << bit % 8));
    if (m_script.flag()) packet.resize(m_script.below(packet.size()));
    REQUIRE(!deliver(sent.up, packet, pathOf(1)));
  }

  void repeat(const Path& path) {
    if (m_sent.empty()) return;
    const Sent sent = m_sent[m_script.below(m_sent.size())];
    deliver(sent.up, sent.packet, path);
    REQUIRE(!deliver(sent.up, sent.packet, path));
  }

  void sendUnsealed() {
    const bool up = m_script.flag();
    const std::string bytes = m_script.bytes(m_script.byte() * std::size_t{5});
    REQUIRE(!deliver(up, bytes, pathOf(9)));
  }

  /// Returns true if the packet was opened. Requires that no packet is opened twice.
  bool deliver(bool up, const std::string& packet, const Path& path) {
    const bool came = up ? toServer(packet, path) : toClient(packet, path);
    if (came) REQUIRE(m_opened.emplace(up, packet).second);
    return came;
  }
  bool toServer(const std::string& packet, const Path& path) {
    const Exactly bytes(packet);
    ++m_received;
    m_heard.reset();
    m_gate.receive(path, bytes.view(), m_now);
    return m_heard.has_value();
  }
  bool toClient(const std::string& packet, const Path& path) {
    const Exactly bytes(packet);
    const auto payload = m_client.open(path, bytes.view(), m_now);
    if (payload) m_heard.emplace(*payload);
    return payload.has_value();
  }

  struct Sent {
    bool up;
    std::string packet;
  };

  Script& m_script;
  std::uint8_t m_flags;
  AeadId m_aead;
  SealLimits m_limits;
  std::uint64_t m_challenge = 0;
  SealedLink m_client;
  SealedLink m_server;
  DatagramDemux m_gate;
  SealedLink::Time m_now{1h};
  Epoch m_epoch = 0;
  std::vector<Sealer> m_sealers;  ///< element 0: server to client; 1: client to server
  std::vector<Sent> m_sent;
  std::set<std::pair<bool, std::string>> m_opened;
  std::optional<std::string> m_heard;
  std::uint64_t m_received = 0;
};

}  // namespace

void tryInput(Script script) {
  Play(script).run();
}

}  // namespace naiad::fuzz
