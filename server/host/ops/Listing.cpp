#include "host/ops/Listing.h"

#include <asio/ip/address.hpp>
#include <system_error>
#include <utility>

#include "host/ops/NetworkReport.h"
#include "shared/net/base/Limits.h"
#include "shared/net/lan/LanMessage.h"
#include "shared/net/stream/JoinLink.h"
#include "shared/net/stream/TcpListener.h"

namespace naiad {

namespace {

LanAnswer answerOf(const HostOptions& options, const Listing::Server& server) {
  LanAnswer facts;
  facts.protocol = kProtocolVersion;
  facts.port = server.port;
  facts.asks_password = !options.password.empty();
  facts.max_players = static_cast<std::uint16_t>(options.max_players);
  facts.key = ShortKey::of(*server.key);
  facts.name = options.name;
  facts.game = server.game;
  return facts;
}

std::unique_ptr<StatusFile> openStatus(const HostOptions& options, const Listing::Server& server) {
  if (options.status_file.empty()) return nullptr;
  StatusFacts facts;
  facts.name = options.name;
  facts.game = server.game;
  facts.max_players = static_cast<std::size_t>(options.max_players);
  facts.asks_password = !options.password.empty();
  facts.link = server.link;
  return std::make_unique<StatusFile>(options.status_file, facts);
}

}  // namespace

Listing::Listing(const HostOptions& options, const Server& server, LogLine log)
    : m_log(std::move(log)), m_lan(openLan(options, server)), m_status(openStatus(options, server)) {}

// Loopback alone is found only if that is asked for: it is no network with others in it.
std::unique_ptr<LanResponder> Listing::openLan(const HostOptions& options, const Server& server) const {
  const bool automatic = options.lan == "auto";
  const bool loopback = asio::ip::make_address(options.address).is_loopback();
  if (!server.key || options.lan == "off" || (automatic && loopback)) return nullptr;
  try {
    return std::make_unique<LanResponder>(answerOf(options, server), options.address,
                                          automatic ? LanMode::kAuto : LanMode::kOn);
  } catch (const std::system_error& error) {
    const std::string wrong = std::string("cannot be found in the local network: ") + error.what();
    if (!automatic) throw ListenError("--lan on: the server " + wrong + ".", error.code());
    m_log({LogEvent::Level::kWarning, "warning: the server " + wrong});
    return nullptr;
  }
}

void Listing::start() {
  if (m_lan) m_lan->start();
}

void Listing::setPlayers(std::size_t playing) {
  if (m_lan) m_lan->setPlayers(playing);
  if (!m_status) return;
  m_status->setPlayers(playing);
  if (const std::string news = m_status->takeNews(); !news.empty()) m_log(news);
}

void Listing::stop() {
  if (m_lan) m_lan->stop();
  m_status.reset();
}

void Listing::logCounters() const {
  if (m_lan) logLan(m_lan->counters(), m_log);
}

}  // namespace naiad
